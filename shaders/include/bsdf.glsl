// How a surface scatters: glTF 2.0, appendix B, and the extensions for specular, transmission, volume, ior, clearcoat.
// Pure functions. The lobes:
//   diffuse       base / pi, times what its coat lets through
//   reflection    GGX (Walter et al. 2007) with Smith's height-correlated masking (Heitz 2014), for metal, coat
//                 and glass together: they share the roughness and differ in Fresnel reflectance alone
//   transmission  through glass: refracted at a microfacet, or through a thin wall
//   clearcoat     GGX again, on top of all
// Width alpha = roughness^2. A lobe of width 0 is a delta: paths follow it and nothing is gathered on it.
// What lies below a coat is weakened by 1 - F(wo . h) with the half vector of the pair of directions, so that light
// paths and eye paths see the same surface.
#ifndef BSDF_GLSL
#define BSDF_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"

struct Bsdf {
    vec3 diffuse;           // albedo
    float alpha;            // of reflection and transmission
    vec3 r0;                // reflectance of metal and coat at normal incidence (Schlick 1994)
    float r90;              //   and at grazing incidence
    vec3 transmission;      // tint
    float glass;            // share of the surface that transmits: it reflects by the exact Fresnel equations
    float eta;              // index on the side of the ray / index beyond
    float coat0;            // largest channel of the reflectance of the coat over the diffuse base
    float coat90;
    float clearcoat;
    float clearcoat_alpha;
    bool thin;              // transmission passes straight on
};

#define LOBE_DIFFUSE 0u
#define LOBE_REFLECTION 1u
#define LOBE_TRANSMISSION 2u
#define LOBE_CLEARCOAT 3u
#define LOBE_NONE 4u

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Fresnel reflectance of a smooth dielectric, unpolarised. cosine in [0, 1] on the side of incidence,
// eta = index on that side / index beyond. cosine_t: cosine beyond, 0 under total internal reflection.
float fresnel_dielectric(float cosine, float eta, out float cosine_t) {
    float cos2_t = 1.0 - eta * eta * (1.0 - cosine * cosine);
    cosine_t = sqrt(max(cos2_t, 0.0));
    float parallel = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    float perpendicular = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    // No early return: the inliner would make a loop of it, which software Vulkan runs masked.
    return cos2_t > 0.0 ? 0.5 * (parallel * parallel + perpendicular * perpendicular) : 1.0;
}

float schlick_power(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return (m * m) * (m * m) * m;
}

const float CLEARCOAT_R0 = 0.04;

// Reflectance of the clearcoat, and what it leaves to the lobes below.
float clearcoat_fresnel(Bsdf b, float cosine) {
    if (!HAS_CLEARCOAT) return 0.0;
    // precise: versions of Mesa rearrange it, each in its own way, and rounding differs.
    precise float fresnel = b.clearcoat * (CLEARCOAT_R0 + (1.0 - CLEARCOAT_R0) * schlick_power(cosine));
    return fresnel;
}

float below_clearcoat(Bsdf b, float cosine) { return 1.0 - clearcoat_fresnel(b, cosine); }

// Reflectance of a facet of the reflection lobe.
vec3 facet_reflectance(Bsdf b, float cosine) {
    vec3 r = b.r0 + (b.r90 - b.r0) * schlick_power(cosine);
    if (HAS_TRANSMISSION) {
        float cosine_t;
        r += b.glass * fresnel_dielectric(cosine, b.eta, cosine_t);
    }
    return r;
}

// What a facet transmits, without its tint: transmission holds the share of glass.
float facet_transmittance(Bsdf b, float cosine) {
    float cosine_t;
    return 1.0 - fresnel_dielectric(cosine, b.eta, cosine_t);
}

// What the coat leaves to the diffuse base.
float below_coat(Bsdf b, float cosine) {
    if (!HAS_COAT) return 1.0;
    return 1.0 - (b.coat0 + (b.coat90 - b.coat0) * schlick_power(cosine));
}

// alpha. A lobe narrower than the rounding of directions is a delta: its density would leave the range of floats.
float lobe_width(float roughness) { return roughness < 3e-4 ? 0.0 : roughness * roughness; }

// ior: index of the material for this path's wavelength. front: the ray comes from outside.
Bsdf bsdf_of(SurfaceMaterial material, float ior, bool front) {
    Bsdf b;
    b.thin = HAS_THIN && has(material, SURFACE_THIN);
    b.glass = HAS_TRANSMISSION ? (1.0 - material.metallic) * material.transmission : 0.0;
    b.transmission = b.glass * material.color;
    float opaque = (1.0 - material.metallic) - b.glass;  // dielectric that does not transmit
    b.diffuse = opaque * material.color;
    b.alpha = lobe_width(material.roughness);
    b.eta = front || b.thin ? 1.0 / ior : ior;
    b.r0 = material.metallic * material.color;
    b.r90 = material.metallic;
    b.coat0 = b.coat90 = 0.0;
    if (HAS_COAT) {
        float root = (1.0 - ior) / (1.0 + ior);
        vec3 coat = min(root * root * material.specular_color, vec3(1.0)) * material.specular;
        b.r0 += opaque * coat;
        b.r90 += opaque * material.specular;
        b.coat0 = largest(coat);
        b.coat90 = material.specular;
    }
    b.clearcoat = material.clearcoat;
    b.clearcoat_alpha = lobe_width(material.clearcoat_roughness);
    return b;
}

// Of a surface that takes all light in.
Bsdf black() {
    return Bsdf(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, false);
}

// True where photons are gathered: on a diffuse lobe or a rough one.
bool gathers_light(Bsdf b) {
    bool any_light = largest(b.diffuse) > 0.0;
    if (HAS_ROUGH) {
        any_light = any_light || (b.alpha > 0.0 && b.glass + b.r90 > 0.0) || (b.clearcoat * b.clearcoat_alpha > 0.0);
    }
    return any_light;
}

// ---- GGX ----

// Distribution of normals. sin^2 from the cross product: 1 - cos^2 would cancel where the lobe is narrow.
float ggx(float alpha, vec3 n, vec3 h) {
    vec3 s = cross(n, h);
    float c = dot(n, h);
    float e = dot(s, s) / alpha + c * c * alpha;
    return 1.0 / (PI * e * e);
}

// Smith's Lambda of a direction with that cosine to the normal.
float smith_lambda(float alpha, float cosine) {
    float cos2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * max(0.0, 1.0 - cos2) / cos2) - 1.0);
}

float smith_g1(float alpha, float cosine) { return 1.0 / (1.0 + smith_lambda(alpha, cosine)); }

// G2 / G1(wo): what the masking of wi leaves of a direction sampled by visible normals.
float smith_masking(float alpha, float wo_n, float wi_n) {
    float lambda = smith_lambda(alpha, wo_n);
    return (1.0 + lambda) / (1.0 + lambda + smith_lambda(alpha, wi_n));
}

// A microfacet normal seen from wo, in proportion to its visible area (Dupuy and Benyoub 2023), about +z.
vec3 sample_visible_normal(float alpha, vec3 wo, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * wo.xy, wo.z));
    float phi = 2.0 * PI * u.x;
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float sin_theta = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 c = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + stretched;
    return normalize(vec3(alpha * c.xy, max(c.z, 1e-7)));
}

// Density of `reflect` at a visible normal: of wi, per solid angle.
float reflection_pdf(float alpha, vec3 n, vec3 wo, vec3 h) {
    float cosine = dot(n, wo);
    return ggx(alpha, n, h) * smith_g1(alpha, cosine) / (4.0 * cosine);
}

// The same of refraction at h; eta = index on the side of wo / index beyond, wi_h = |wi . h| (Walter et al. 2007, Eq.
// 17).
float refraction_pdf(float alpha, vec3 n, float wo_n, vec3 h, float eta, float wo_h, float wi_h) {
    float d = eta * wo_h - wi_h;
    return ggx(alpha, n, h) * smith_g1(alpha, wo_n) * wo_h / wo_n * wi_h / (d * d);
}

// ---- lobes ----

// What every lobe sends on of light along wo, about: the largest channel, coats at h = n; but over the diffuse base
// seen from above, for there h is far from n at grazing angles. Lobes are chosen in proportion. The facets of rough
// glass turn from n to wo: some transmit where n would reflect all.
vec4 lobes_of(Bsdf b, Surface surface, vec3 wo) {
    float cosine = min(1.0, dot(surface.normal, wo));
    float coat = clearcoat_fresnel(b, min(1.0, dot(surface.clearcoat_normal, wo)));
    vec4 lobes = vec4(largest(b.diffuse) * below_coat(b, 1.0) * below_clearcoat(b, 1.0), 0.0, 0.0, coat);
    if (HAS_REFLECTION) lobes.y = largest(facet_reflectance(b, cosine)) * (1.0 - coat);
    if (HAS_TRANSMISSION) {
        float transmittance = facet_transmittance(b, cosine);
        if (HAS_ROUGH) transmittance = mix(transmittance, facet_transmittance(b, 1.0), b.alpha);
        lobes.z = largest(b.transmission) * transmittance * (1.0 - coat);
    }
    return lobes;
}

// The lobe that u in [0, 1) chooses, and 1 / its probability: the last one that begins below u and is not empty.
uint choose_lobe(vec4 lobes, float u, out float inverse_probability) {
    float total = lobes.x + lobes.y + lobes.z + lobes.w;
    float at = u * total;
    uint chosen = lobes.x > 0.0 ? LOBE_DIFFUSE : LOBE_NONE;
    float share = lobes.x;
    if (lobes.y > 0.0 && at >= lobes.x) {
        chosen = LOBE_REFLECTION;
        share = lobes.y;
    }
    if (lobes.z > 0.0 && at >= lobes.x + lobes.y) {
        chosen = LOBE_TRANSMISSION;
        share = lobes.z;
    }
    if (lobes.w > 0.0 && at >= lobes.x + lobes.y + lobes.z) {
        chosen = LOBE_CLEARCOAT;
        share = lobes.w;
    }
    inverse_probability = total / share;
    return chosen;
}

// Mirror direction, on the outer side of the geometric surface whatever the shading normal says.
vec3 mirror_direction(vec3 direction, vec3 normal, vec3 geometric) {
    vec3 r = reflect(direction, normal);
    return normalize(dot(r, geometric) > 0.0 ? r : reflect(direction, geometric));
}

// Goes on by one lobe from `direction` (towards the surface): sets the direction and its density per solid angle
// (infinite for a delta lobe) and returns f cos / density, the lobe's factor of the throughput.
// radiance: true for eye paths, whose radiance changes by the squared ratio of indices across the surface
// (Veach 1997, section 5.2); false for the flux of photons.
const float DELTA = 3.0e38;

vec3 sample_lobe(uint lobe, Bsdf b, Surface surface, vec2 u, bool radiance, inout vec3 direction, out float density) {
    density = DELTA;
    vec3 wo = -direction;
    if (lobe == LOBE_DIFFUSE) {
        direction = normalize(from_frame(surface.normal, sample_cosine(u)));
        float cosine = dot(direction, surface.normal);
        density = cosine / PI;
        float wo_h = (HAS_COAT || HAS_CLEARCOAT) ? dot(wo, normalize(wo + direction)) : 1.0;
        return b.diffuse * below_coat(b, wo_h) * below_clearcoat(b, wo_h);
    }
    vec3 n = lobe == LOBE_CLEARCOAT ? surface.clearcoat_normal : surface.normal;
    float alpha = lobe == LOBE_CLEARCOAT ? b.clearcoat_alpha : b.alpha;
    vec3 h = n;
    float masking = 1.0;  // G2 / G1
    bool straight = lobe == LOBE_TRANSMISSION && !b.thin && b.eta == 1.0;  // no facet bends it
    bool rough = HAS_ROUGH && alpha > 0.0 && !straight;
    vec3 t, s;
    if (rough) {
        tangents(n, t, s);
        vec3 local = sample_visible_normal(alpha, vec3(dot(wo, t), dot(wo, s), dot(wo, n)), u);
        h = normalize(local.x * t + local.y * s + local.z * n);
    }
    float wo_h = min(1.0, dot(wo, h));
    float wo_n = min(1.0, dot(wo, n));
    if (!HAS_TRANSMISSION || lobe != LOBE_TRANSMISSION) {
        if (rough) {
            direction = reflect(direction, h);
            float wi_n = dot(direction, n);
            if (wi_n <= 0.0 || dot(direction, surface.geometric) <= 0.0) return vec3(0.0);
            density = reflection_pdf(alpha, n, wo, h);
            masking = smith_masking(alpha, wo_n, wi_n);
        } else {
            direction = mirror_direction(direction, n, surface.geometric);
        }
        if (lobe == LOBE_CLEARCOAT) return vec3(masking * clearcoat_fresnel(b, wo_h));
        return facet_reflectance(b, wo_h) * (masking * below_clearcoat(b, wo_h));
    }
    vec3 weight = b.transmission * below_clearcoat(b, wo_n);
    if (b.thin) {
        weight *= facet_transmittance(b, wo_h);
        if (rough) {
            vec3 mirrored = reflect(direction, h);
            float wi_n = dot(mirrored, n);
            direction = normalize(mirrored - 2.0 * wi_n * n);
            if (wi_n <= 0.0 || dot(direction, surface.geometric) >= 0.0) return vec3(0.0);
            density = reflection_pdf(alpha, n, wo, h);
            weight *= smith_masking(alpha, wo_n, wi_n);
        }
        return weight;
    }
    float cosine_t;
    float reflectance = fresnel_dielectric(wo_h, b.eta, cosine_t);
    if (cosine_t == 0.0) return vec3(0.0);  // total internal reflection at this facet
    weight *= (1.0 - reflectance) * (radiance ? b.eta * b.eta : 1.0);
    vec3 refracted = normalize(b.eta * direction + (b.eta * wo_h - cosine_t) * h);
    if (rough) {
        direction = refracted;
        float wi_n = -dot(direction, n);
        if (wi_n <= 0.0 || dot(direction, surface.geometric) >= 0.0) return vec3(0.0);
        density = refraction_pdf(alpha, n, wo_n, h, b.eta, wo_h, cosine_t);
        return weight * smith_masking(alpha, wo_n, wi_n);
    }
    // Shading normals can bend a refracted ray back to its own side: it then goes on along the surface's far side.
    if (dot(refracted, surface.geometric) < 0.0) direction = refracted;
    return weight;
}

// The share of a lobe of width alpha that an eye path leaves to photons when it chooses between gathering and going on:
// that of the weight below at the lobe's peak, seen along the normal, where its density is 1 / (4 pi alpha^2).
float gathered_share(float alpha) {
    float x = 4.0 * float(params.knn) * alpha * alpha;
    return x / (1.0 + x);
}

// A rough lobe is sampled in two ways: eye paths follow it, with its own density, and gather photons on it: k of them,
// which come from anywhere, as cos / pi stands for. Both are weighed by the balance heuristic (Veach and Guibas 1995),
// so that narrow lobes are left to eye paths and wide ones to photons, smoothly. This is the weight of what eye paths
// find, be it met or asked for.
float followed_weight(float density, float cosine) {
    return density == DELTA ? 1.0 : density / (density + float(params.knn) * abs(cosine) / PI);
}

// The density, 1/sr, with which a lobe of width above 0 is chosen by choose_lobe in proportion to `lobes` and then
// gives wi by sample_lobe. Less than a density in all where there are delta lobes.
float scatter_density(Bsdf b, Surface surface, vec4 lobes, vec3 wo, vec3 wi) {
    vec3 n = surface.normal;
    float wo_n = dot(wo, n);
    float wi_n = dot(wi, n);
    bool reflects = dot(wi, surface.geometric) > 0.0;
    float sum = lobes.x * max(0.0, wi_n) / PI;
    if (HAS_ROUGH) {
        if (b.alpha > 0.0 && reflects && wi_n > 0.0) {
            sum += lobes.y * reflection_pdf(b.alpha, n, wo, normalize(wo + wi));
        }
        if (HAS_CLEARCOAT && b.clearcoat_alpha > 0.0 && reflects) {
            vec3 c = surface.clearcoat_normal;
            if (dot(wi, c) > 0.0) sum += lobes.w * reflection_pdf(b.clearcoat_alpha, c, wo, normalize(wo + wi));
        }
        if (HAS_TRANSMISSION && b.alpha > 0.0 && !reflects && wi_n < 0.0) {
            if (b.thin) {
                sum += lobes.z * reflection_pdf(b.alpha, n, wo, normalize(wo + wi - 2.0 * wi_n * n));
            } else if (b.eta != 1.0) {
                vec3 h = normalize(b.eta * wo + wi);
                if (dot(h, n) < 0.0) h = -h;
                float wo_h = dot(wo, h);
                float wi_h = dot(wi, h);
                if (wo_h > 0.0 && wi_h < 0.0) sum += lobes.z * refraction_pdf(b.alpha, n, wo_n, h, b.eta, wo_h, -wi_h);
            }
        }
    }
    return sum / (lobes.x + lobes.y + lobes.z + lobes.w);
}

// Which part of the lobes a sum is of.
#define PART_ALL 0u       // photons bring all of this light
#define PART_GATHERED 1u  // photons' share of light that eye paths find too
#define PART_FOLLOWED 2u  // that of eye paths: rough lobes alone

// A rough lobe without its Fresnel term, times the weight of the part. density: of wi when it is sampled from wo by
// visible normals; f cos / density is the masking then. Cosines to the lobe's own normal, that of wi of either sign.
float rough_lobe(uint part, float alpha, float density, float wo_n, float wi_n) {
    float followed = followed_weight(density, wi_n);
    float weight = part == PART_ALL ? 1.0 : part == PART_FOLLOWED ? followed : 1.0 - followed;
    return density * smith_masking(alpha, wo_n, wi_n) * weight / abs(wi_n);
}

// Light that arrives from wi and is scattered to wo, without the cosine: all lobes of width above 0, each with the
// weight of its part.
vec3 rough_bsdf(Bsdf b, Surface surface, vec3 wo, vec3 wi, uint part) {
    vec3 n = surface.normal;
    float wo_n = dot(wo, n);
    float wi_n = dot(wi, n);
    bool reflects = dot(wi, surface.geometric) > 0.0;
    vec3 sum = vec3(0.0);
    if (reflects && wi_n > 0.0) {
        vec3 h = normalize(wo + wi);
        float wo_h = min(1.0, dot(wo, h));
        float below = below_clearcoat(b, wo_h);
        if (part != PART_FOLLOWED) sum = b.diffuse * (below_coat(b, wo_h) * below / PI);
        if (HAS_ROUGH && b.alpha > 0.0) {
            float lobe = rough_lobe(part, b.alpha, reflection_pdf(b.alpha, n, wo, h), wo_n, wi_n);
            sum += facet_reflectance(b, wo_h) * (below * lobe);
        }
    }
    bool coats = HAS_ROUGH && HAS_CLEARCOAT;
    if (coats && b.clearcoat_alpha > 0.0 && reflects) {
        vec3 c = surface.clearcoat_normal;
        float wo_c = dot(wo, c);
        float wi_c = dot(wi, c);
        if (wi_c > 0.0) {
            vec3 h = normalize(wo + wi);
            float density = reflection_pdf(b.clearcoat_alpha, c, wo, h);
            float lobe = rough_lobe(part, b.clearcoat_alpha, density, wo_c, wi_c);
            // The flux of a photon counts by the base's normal; the coat has one of its own.
            sum += vec3(clearcoat_fresnel(b, min(1.0, dot(wo, h))) * lobe * (wi_n > 0.0 ? wi_c / wi_n : 0.0));
        }
    }
    if (HAS_ROUGH && HAS_TRANSMISSION && b.alpha > 0.0 && !reflects &&
        wi_n < 0.0 && b.glass > 0.0) {
        vec3 tint = b.transmission * below_clearcoat(b, min(1.0, wo_n));
        if (b.thin) {
            vec3 mirrored = wi - 2.0 * wi_n * n;
            vec3 h = normalize(wo + mirrored);
            float lobe = rough_lobe(part, b.alpha, reflection_pdf(b.alpha, n, wo, h), wo_n, wi_n);
            sum += tint * (facet_transmittance(b, min(1.0, dot(wo, h))) * lobe);
        } else if (b.eta != 1.0) {
            vec3 h = normalize(b.eta * wo + wi);
            if (dot(h, n) < 0.0) h = -h;
            float wo_h = dot(wo, h);
            float wi_h = dot(wi, h);
            if (wo_h > 0.0 && wi_h < 0.0) {
                float density = refraction_pdf(b.alpha, n, wo_n, h, b.eta, wo_h, -wi_h);
                float lobe = b.eta * b.eta * rough_lobe(part, b.alpha, density, wo_n, wi_n);
                sum += tint * (facet_transmittance(b, min(1.0, wo_h)) * lobe);
            }
        }
    }
    return sum;
}

#endif
