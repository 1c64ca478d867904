// The lobe of the clearcoat: GGX on top of all, about a normal of its own.
#ifndef LOBES_CLEARCOAT_GLSL
#define LOBES_CLEARCOAT_GLSL

uint clearcoat_gathers(Bsdf b) {
    return HAS_ROUGH && b.clearcoat * b.clearcoat_alpha > 0.0 ? HIT_DIFFUSE : HIT_NONE;
}

float clearcoat_width(Bsdf b) { return b.clearcoat_alpha; }

float clearcoat_stretch(Bsdf b) { return 1.0; }

float clearcoat_peak(Bsdf b) { return reflection_peak_of(b.clearcoat_alpha); }

Facets clearcoat_facets(Bsdf b, Surface surface) {
    return facets_of(b.clearcoat_alpha, surface.clearcoat_normal, 1.0, surface.tangent);
}

vec3 clearcoat_normal(Surface surface) { return surface.clearcoat_normal; }

float clearcoat_weight(Bsdf b, Surface surface, vec3 wo) { return clearcoat_fresnel(b, coat_cosine(surface, wo)); }

vec3 clearcoat_sample(Bsdf b, Surface surface, Facet facet, vec2 u, bool radiance, inout vec3 direction,
                      inout float density) {
    float masking = reflect_at(facet, surface, direction, density);
    return vec3(masking * clearcoat_fresnel(b, facet.wo_h));
}

float clearcoat_density(Bsdf b, Surface surface, Pair pair, float weight) {
    float density = 0.0;
    if (is_rough(b.clearcoat_alpha) && pair.reflects && dot(pair.wi, surface.clearcoat_normal) > 0.0) {
        density = weight * reflection_pdf(clearcoat_facets(b, surface), pair.wo, pair.h);
    }
    return density;
}

vec3 clearcoat_evaluate(Bsdf b, Surface surface, Pair pair, uint part) {
    float density = clearcoat_density(b, surface, pair, 1.0);
    vec3 value = vec3(0.0);
    if (density != 0.0) {
        float wo_c = dot(pair.wo, surface.clearcoat_normal);
        float wi_c = dot(pair.wi, surface.clearcoat_normal);
        float lobe = rough_lobe(part, clearcoat_facets(b, surface), density, pair, wo_c, wi_c);
        // The flux of a photon counts by the base's normal; the coat has one of its own.
        float turn = pair.wi_n > 0.0 ? wi_c / pair.wi_n : 0.0;
        value = vec3(clearcoat_fresnel(b, min(1.0, dot(pair.wo, pair.h))) * lobe * turn);
    }
    return value;
}

#endif
