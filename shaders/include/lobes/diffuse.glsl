// The diffuse lobe: base / pi, times what its coats let through, F at the half vector of the pair of directions.
#ifndef LOBES_DIFFUSE_GLSL
#define LOBES_DIFFUSE_GLSL

uint diffuse_gathers(Bsdf b) { return largest(b.diffuse) > 0.0 ? HIT_DIFFUSE : HIT_NONE; }

float diffuse_width(Bsdf b) { return WIDE; }

float diffuse_stretch(Bsdf b) { return 1.0; }

float diffuse_peak(Bsdf b) { return 0.0; }  // wide

vec3 diffuse_normal(Surface surface) { return surface.normal; }

// Coats as seen from above: h is far from n at grazing angles.
float diffuse_weight(Bsdf b, Surface surface, vec3 wo) {
    return largest(b.diffuse) * below_coat(b, 1.0) * below_clearcoat(b, 1.0);
}

vec3 diffuse_sample(Bsdf b, Surface surface, Facet facet, vec2 u, bool radiance, inout vec3 direction,
                    inout float density) {
    vec3 wo = -direction;
    direction = normalize(from_frame(surface.normal, sample_cosine(u)));
    float cosine = dot(direction, surface.normal);
    density = cosine / PI;
    float wo_h = HAS_COAT || HAS_CLEARCOAT ? dot(wo, normalize(wo + direction)) : 1.0;
    return b.diffuse * below_coat(b, wo_h) * below_clearcoat(b, wo_h);
}

float diffuse_density(Bsdf b, Surface surface, Pair pair, float weight) { return weight * max(0.0, pair.wi_n) / PI; }

vec3 diffuse_evaluate(Bsdf b, Surface surface, Pair pair, uint part) {
    vec3 value = vec3(0.0);
    if (part != PART_FOLLOWED && pair.reflects && pair.wi_n > 0.0) {
        float wo_h = min(1.0, dot(pair.wo, pair.h));
        value = b.diffuse * (below_coat(b, wo_h) * below_clearcoat(b, wo_h) / PI);
    }
    return value;
}

#endif
