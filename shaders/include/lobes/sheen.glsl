// The lobe of sheen: fibres on top of base and coat, below the clearcoat.
#ifndef LOBES_SHEEN_GLSL
#define LOBES_SHEEN_GLSL

uint sheen_gathers(Bsdf b) { return b.sheen.most > 0.0 ? HIT_DIFFUSE : HIT_NONE; }

float sheen_width(Bsdf b) { return WIDE; }

float sheen_stretch(Bsdf b) { return 1.0; }

float sheen_peak(Bsdf b) { return 0.0; }  // wide

vec3 sheen_normal(Surface surface) { return surface.normal; }

// The clearcoat as seen from above: h is far from n at grazing angles.
float sheen_weight(Bsdf b, Surface surface, vec3 wo) {
    return b.sheen.most * sheen_side(b.sheen, dot(wo, surface.normal)).albedo * below_clearcoat(b, 1.0);
}

vec3 sheen_between(Bsdf b, Surface surface, Pair pair) {
    vec3 s = cross(surface.normal, pair.h);
    vec3 value = sheen_value(b.sheen, sheen_side(b.sheen, pair.wo_n), sheen_side(b.sheen, pair.wi_n), dot(s, s));
    return value * below_clearcoat(b, min(1.0, dot(pair.wo, pair.h)));
}

// Alike in all directions: most of its light goes to grazing ones, and a density in proportion to the cosine would meet
// it seldom.
vec3 sheen_sample(Bsdf b, Surface surface, Facet facet, vec2 u, bool radiance, inout vec3 direction,
                  inout float density) {
    vec3 wo = -direction;
    direction = normalize(from_frame(surface.normal, sample_azimuth(u.x, u.y)));
    density = 0.5 / PI;
    Pair pair = pair_of(surface, wo, direction);
    return pair.reflects ? sheen_between(b, surface, pair) * (max(0.0, pair.wi_n) / density) : vec3(0.0);
}

float sheen_density(Bsdf b, Surface surface, Pair pair, float weight) {
    return pair.wi_n > 0.0 ? weight * 0.5 / PI : 0.0;
}

vec3 sheen_evaluate(Bsdf b, Surface surface, Pair pair, uint part) {
    vec3 value = vec3(0.0);
    if (part != PART_FOLLOWED && pair.reflects && pair.wi_n > 0.0) value = sheen_between(b, surface, pair);
    return value;
}

#endif
