// The lobe of transmission through glass: refracted at a microfacet, or through a thin wall, which mirrors the lobe of
// reflection to the other side.
#ifndef LOBES_TRANSMISSION_GLSL
#define LOBES_TRANSMISSION_GLSL

uint transmission_gathers(Bsdf b) { return is_rough(b.alpha) && b.glass > 0.0 ? HIT_BOTH_SIDES : HIT_NONE; }

float transmission_width(Bsdf b) { return b.alpha; }

float transmission_stretch(Bsdf b) { return b.stretch; }

// A facet that turns bends what it refracts by less than what it mirrors.
float transmission_peak(Bsdf b) {
    float bend = 1.0 - b.eta;
    return reflection_peak_of(b.alpha) * (b.thin ? 1.0 : 4.0 / max(1e-6, bend * bend));
}

vec3 transmission_normal(Surface surface) { return surface.normal; }

// True of a thin wall that lets light go straight on, as if it met nothing (include/direct.glsl).
bool is_pane(Bsdf b) { return HAS_THIN && b.thin && b.glass > 0.0 && !is_rough(b.alpha); }

// What a facet of a wall lets through, at these cosines of wo to the wall's normal and to the facet's.
vec3 wall_transmittance(Bsdf b, float wo_n, float wo_h) {
    return b.transmission * below_clearcoat(b, wo_n) * facet_transmittance(b, wo_h);
}

// What goes straight on through a pane.
vec3 pane_transmittance(Bsdf b, Surface surface, vec3 wo) {
    float cosine = min(1.0, dot(surface.normal, wo));
    return wall_transmittance(b, cosine, cosine) * below_sheen(b, cosine, cosine);
}

// The facets of rough glass turn from n to wo: some transmit where n would reflect all.
float transmission_weight(Bsdf b, Surface surface, vec3 wo) {
    float transmittance = facet_transmittance(b, min(1.0, dot(surface.normal, wo)));
    if (HAS_ROUGH) transmittance = mix(transmittance, facet_transmittance(b, 1.0), b.alpha);
    return largest(b.transmission) * transmittance * below_clearcoat(b, coat_cosine(surface, wo));
}

vec3 transmission_sample(Bsdf b, Surface surface, Facet facet, vec2 u, bool radiance, inout vec3 direction,
                         inout float density) {
    vec3 wo = -direction;
    if (b.thin) {
        vec3 weight = wall_transmittance(b, facet.wo_n, facet.wo_h);
        if (facet.rough) {
            vec3 mirrored = reflect(direction, facet.h);
            float wi_n = dot(mirrored, facet.of.n);
            direction = normalize(mirrored - 2.0 * wi_n * facet.of.n);
            if (wi_n <= 0.0 || dot(direction, surface.geometric) >= 0.0) return vec3(0.0);
            density = reflection_pdf(facet.of, wo, facet.h);
            weight *= smith_masking(facet.of, wo, facet.wo_n, direction, wi_n);
        }
        return weight;
    }
    vec3 weight = b.transmission * below_clearcoat(b, facet.wo_n);
    if (b.eta == 1.0) facet = smooth_facet(facet.of, wo);  // no facet bends it
    float cosine_t;
    float transmittance = facet_transmittance(b, facet.wo_h, cosine_t);
    if (cosine_t == 0.0) return vec3(0.0);  // total internal reflection at this facet
    weight *= transmittance * (radiance ? b.eta * b.eta : 1.0);
    vec3 refracted = normalize(b.eta * direction + (b.eta * facet.wo_h - cosine_t) * facet.h);
    if (facet.rough) {
        direction = refracted;
        float wi_n = -dot(direction, facet.of.n);
        if (wi_n <= 0.0 || dot(direction, surface.geometric) >= 0.0) return vec3(0.0);
        density = refraction_pdf(facet.of, wo, facet.wo_n, facet.h, b.eta, facet.wo_h, cosine_t);
        return weight * smith_masking(facet.of, wo, facet.wo_n, direction, wi_n);
    }
    // Shading normals can bend a refracted ray back to its own side: it then goes on along the surface's far side.
    if (dot(refracted, surface.geometric) < 0.0) direction = refracted;
    return weight;
}

// The normal of the facet that sends one direction of the pair through a solid's surface to the other, on the side of
// wo.
vec3 refracting_half(Bsdf b, Surface surface, Pair pair) {
    vec3 h = normalize(b.eta * pair.wo + pair.wi);
    return dot(h, surface.normal) < 0.0 ? -h : h;
}

// The same of a thin wall, whose lobe is that of reflection on the other side.
vec3 mirroring_half(Surface surface, Pair pair) {
    vec3 mirrored = pair.wi - 2.0 * pair.wi_n * surface.normal;
    return normalize(pair.wo + mirrored);
}

bool transmission_passes(Bsdf b, Pair pair) { return is_rough(b.alpha) && !pair.reflects && pair.wi_n < 0.0; }

// The density at a facet of a solid's surface; 0 where none sends the one direction to the other.
float refracting_density(vec3 h, Bsdf b, Surface surface, Pair pair) {
    float wo_h = dot(pair.wo, h);
    float wi_h = dot(pair.wi, h);
    if (b.eta == 1.0 || wo_h <= 0.0 || wi_h >= 0.0) return 0.0;
    return refraction_pdf(base_facets(b, surface), pair.wo, pair.wo_n, h, b.eta, wo_h, -wi_h);
}

float transmission_density(Bsdf b, Surface surface, Pair pair, float weight) {
    float density = 0.0;
    if (transmission_passes(b, pair)) {
        if (b.thin) {
            density = weight * reflection_pdf(base_facets(b, surface), pair.wo, mirroring_half(surface, pair));
        } else {
            density = weight * refracting_density(refracting_half(b, surface, pair), b, surface, pair);
        }
    }
    return density;
}

vec3 transmission_evaluate(Bsdf b, Surface surface, Pair pair, uint part) {
    vec3 value = vec3(0.0);
    if (transmission_passes(b, pair) && b.glass > 0.0) {
        vec3 tint = b.transmission * below_clearcoat(b, min(1.0, pair.wo_n));
        if (b.thin) {
            vec3 h = mirroring_half(surface, pair);
            float density = reflection_pdf(base_facets(b, surface), pair.wo, h);
            float lobe = rough_lobe(part, base_facets(b, surface), density, pair, pair.wo_n, pair.wi_n);
            value = tint * (facet_transmittance(b, min(1.0, dot(pair.wo, h))) * lobe);
        } else {
            vec3 h = refracting_half(b, surface, pair);
            float density = refracting_density(h, b, surface, pair);
            if (density > 0.0) {
                // Radiance changes by the squared ratio of indices across the surface.
                Facets facets = base_facets(b, surface);
                float lobe = b.eta * b.eta * rough_lobe(part, facets, density, pair, pair.wo_n, pair.wi_n);
                value = tint * (facet_transmittance(b, min(1.0, dot(pair.wo, h))) * lobe);
            }
        }
    }
    return value;
}

#endif
