// The lobe of reflection: GGX for metal, coat and glass together, which share the roughness and differ in Fresnel
// reflectance alone.
#ifndef LOBES_REFLECTION_GLSL
#define LOBES_REFLECTION_GLSL

uint reflection_gathers(Bsdf b) { return is_rough(b.alpha) && b.glass + b.r90 > 0.0 ? HIT_DIFFUSE : HIT_NONE; }

float reflection_width(Bsdf b) { return b.alpha; }

float reflection_stretch(Bsdf b) { return b.stretch; }

float reflection_peak(Bsdf b) { return reflection_peak_of(b.alpha); }

vec3 reflection_normal(Surface surface) { return surface.normal; }

float reflection_weight(Bsdf b, Surface surface, vec3 wo) {
    float cosine = min(1.0, dot(surface.normal, wo));
    return largest(facet_reflectance(b, cosine)) * below_clearcoat(b, coat_cosine(surface, wo));
}

vec3 reflection_sample(Bsdf b, Surface surface, Facet facet, vec2 u, bool radiance, inout vec3 direction,
                       inout float density) {
    float masking = reflect_at(facet, surface, direction, density);
    return facet_reflectance(b, facet.wo_h) * (masking * below_clearcoat(b, facet.wo_h));
}

float reflection_density(Bsdf b, Surface surface, Pair pair, float weight) {
    float density = 0.0;
    if (is_rough(b.alpha) && pair.reflects && pair.wi_n > 0.0) {
        density = weight * reflection_pdf(base_facets(b, surface), pair.wo, pair.h);
    }
    return density;
}

vec3 reflection_evaluate(Bsdf b, Surface surface, Pair pair, uint part) {
    float density = reflection_density(b, surface, pair, 1.0);
    vec3 value = vec3(0.0);
    if (density != 0.0) {
        float wo_h = min(1.0, dot(pair.wo, pair.h));
        float lobe = rough_lobe(part, base_facets(b, surface), density, pair, pair.wo_n, pair.wi_n);
        value = facet_reflectance(b, wo_h) * (below_clearcoat(b, wo_h) * lobe);
    }
    return value;
}

#endif
