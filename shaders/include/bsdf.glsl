// How a surface scatters (BSDF): glTF 2.0, appendix B, and the extensions for specular, transmission, volume, ior,
// clearcoat, anisotropy, iridescence, sheen. Pure functions. A BSDF is a sum of lobes, a row of LOBES and a file in
// include/lobes each, over which light paths, eye paths and the path tracer go. A lobe of width 0 is a delta: paths
// follow it and nothing is gathered on it.
// What lies below a coat is weakened by 1 - F(wo . h) with the half vector of the pair of directions, so that light
// paths and eye paths see the same surface; what lies below sheen by the larger of its albedos in the two directions.
#ifndef BSDF_GLSL
#define BSDF_GLSL

#include "include/kernel.glsl"
#include "include/colour.glsl"
#include "include/thin_film.glsl"
#include "include/frame.glsl"
#include "include/fresnel.glsl"
#include "include/ggx.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/sheen.glsl"
#include "include/surface.glsl"

// What a row ROW(number, NAME, name, present) of LOBES (shared/types.h) has in include/lobes/<name>.glsl:
//   uint  name_gathers(bsdf)                  HIT_NONE, or on which sides photons are gathered on it
//   float name_width(bsdf)                    alpha of its facets; 0: a delta; WIDE: it has none, and eye paths do not
//                                             follow it; light paths and the path tracer do
//   float name_stretch(bsdf)                  how much wider they are along the surface's tangent; 1: alike all around
//   float name_peak(bsdf)                     of a rough lobe seen along its normal the greatest density, 1/sr
//   vec3  name_normal(surface)                about which it lies
//   float name_weight(bsdf, surface, wo)      about what it sends on of light along wo, the largest channel: lobes are
//                                             chosen in proportion
//   vec3  name_sample(bsdf, surface, facet, u, radiance, direction, density)
//                                             see sample_lobe; facet: of its width about its normal
//   float name_density(bsdf, surface, pair, weight)
//                                             weight times the density, 1/sr, with which it gives pair.wi when sampled
//                                             from pair.wo; 0 of a delta
//   vec3  name_evaluate(bsdf, surface, pair, part)
//                                             its part (PART_*) of the BSDF: rough_lobe weighs one with facets; 0 of a
//                                             delta, and of PART_FOLLOWED where its width is WIDE
#define LOBE_NUMBER(number, NAME, name, present) const uint LOBE_##NAME = number;
LOBES(LOBE_NUMBER)
#define COUNT_LOBE(number, NAME, name, present) + 1
#define LOBE_COUNT (0 LOBES(COUNT_LOBE))
#define LOBE_NONE uint(LOBE_COUNT)

struct Bsdf {
    vec3 diffuse;           // albedo
    float alpha;            // of reflection and transmission
    float stretch;          //   and how much wider along the tangent: include/ggx.glsl
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
    float specular;         // of glass: strength and colour of what it reflects
    vec3 specular_color;
    float film;             // share of the surface with a thin film: include/thin_film.glsl
    float film_index;
    float film_thickness;   // micrometres
    float metallic;         // below the film: the share of metal, and reflectances at normal incidence
    vec3 metal0;
    vec3 dielectric0;
    Sheen sheen;
};

// Width of anisotropic facets across the tangent at least: a line has no density.
const float LEAST_ACROSS = 1e-3;

// Reflectance of the clearcoat, and what it leaves to the lobes below.
float clearcoat_fresnel(Bsdf b, float cosine) { return clearcoat_reflectance(b.clearcoat, cosine); }

float below_clearcoat(Bsdf b, float cosine) { return 1.0 - clearcoat_fresnel(b, cosine); }

// Reflectance of the film and what is below it.
vec3 below_film(Bsdf b, float cosine, vec3 r0) {
    return thin_film_reflectance(cosine, b.film_index, b.film_thickness, r0);
}

// Reflectance of a facet of glass, and the cosine beyond. KHR_materials_specular scales it at normal incidence by
// colour and strength and at grazing by strength alone, which Schlick's (1 - cos)^5 tells apart, at the cosine in the
// thinner medium from either side. Total reflection stays total: there is nowhere else to go.
vec3 glass_reflectance(Bsdf b, float cosine, out float cosine_t) {
    vec3 r = vec3(fresnel_dielectric(cosine, b.eta, cosine_t));
    if (HAS_SPECULAR_GLASS && cosine_t > 0.0 && b.eta != 1.0) {
        float grazing = schlick_power(min(cosine, cosine_t));
        // Exactly Fresnel's where the factors are 1.
        r = b.specular * clamp(b.specular_color * r + (1.0 - b.specular_color) * grazing, vec3(0.0), vec3(1.0));
    }
    // Seen from inside it is the same film, at the angle outside.
    if (HAS_IRIDESCENCE && cosine_t > 0.0) {
        r = mix(r, b.specular * below_film(b, min(cosine, cosine_t), b.dielectric0), b.film);
    }
    return r;
}

// Reflectance of a facet of the reflection lobe.
vec3 facet_reflectance(Bsdf b, float cosine) {
    vec3 r = b.r0 + (b.r90 - b.r0) * schlick_power(cosine);
    if (HAS_IRIDESCENCE) {
        vec3 filmed = b.metallic * below_film(b, cosine, b.metal0);
        if (HAS_COAT) filmed += (b.r90 - b.metallic) * below_film(b, cosine, b.dielectric0);
        r = mix(r, filmed, b.film);
    }
    if (HAS_TRANSMISSION) {
        float cosine_t;
        r += b.glass * glass_reflectance(b, cosine, cosine_t);
    }
    return r;
}

// What a facet transmits of all channels, without its tint: transmission holds the share of glass. cosine_t: beyond.
float facet_transmittance(Bsdf b, float cosine, out float cosine_t) {
    return 1.0 - largest(glass_reflectance(b, cosine, cosine_t));
}

float facet_transmittance(Bsdf b, float cosine) {
    float cosine_t;
    return facet_transmittance(b, cosine, cosine_t);
}

// What the coat leaves to the diffuse base.
float below_coat(Bsdf b, float cosine) {
    if (!HAS_COAT) return 1.0;
    if (HAS_IRIDESCENCE && b.film > 0.0) {
        vec3 coat = b.dielectric0 + (1.0 - b.dielectric0) * schlick_power(cosine);
        return 1.0 - b.coat90 * largest(mix(coat, below_film(b, cosine, b.dielectric0), b.film));
    }
    return 1.0 - (b.coat0 + (b.coat90 - b.coat0) * schlick_power(cosine));
}

// What the sheen leaves of light that a lobe scatters between directions of these cosines to the shading normal: the
// specification's albedo scaling of all that is not on top.
float below_sheen(Bsdf b, float wo_n, float wi_n) {
    if (!HAS_SHEEN) return 1.0;
    return below_sheen(b.sheen, sheen_side(b.sheen, wo_n), sheen_side(b.sheen, wi_n));
}

bool lies_below_sheen(uint lobe) { return HAS_SHEEN && lobe != LOBE_SHEEN && lobe != LOBE_CLEARCOAT; }

// The cosine by which the coat is weighed when a lobe is chosen: at h = n.
float coat_cosine(Surface surface, vec3 wo) { return min(1.0, dot(surface.clearcoat_normal, wo)); }

// ior: index of the material for this path's wavelength. front: the ray comes from outside.
Bsdf bsdf_of(SurfaceMaterial material, float ior, bool front) {
    Bsdf b;
    b.thin = HAS_THIN && has(material, SURFACE_THIN);
    b.glass = HAS_TRANSMISSION ? (1.0 - material.metallic) * material.transmission : 0.0;
    b.transmission = b.glass * material.color;
    float opaque = (1.0 - material.metallic) - b.glass;  // dielectric that does not transmit
    b.diffuse = opaque * material.color;
    b.alpha = alpha_of(material.roughness);
    b.stretch = 1.0;
    if (HAS_ANISOTROPY && material.anisotropy.z > 0.0) {
        // KHR_materials_anisotropy: wider along the tangent alone.
        float across = max(b.alpha, LEAST_ACROSS);
        float along = mix(across, 1.0, material.anisotropy.z * material.anisotropy.z);
        b.alpha = sqrt(along * across);
        b.stretch = sqrt(along / across);
    }
    b.eta = front || b.thin ? 1.0 / ior : ior;
    b.r0 = material.metallic * material.color;
    b.r90 = material.metallic;
    b.coat0 = b.coat90 = 0.0;
    float root = (1.0 - ior) / (1.0 + ior);
    b.dielectric0 = min(root * root * material.specular_color, vec3(1.0));
    if (HAS_COAT) {
        vec3 coat = b.dielectric0 * material.specular;
        b.r0 += opaque * coat;
        b.r90 += opaque * material.specular;
        b.coat0 = largest(coat);
        b.coat90 = material.specular;
    }
    b.specular = material.specular;
    b.specular_color = vec3(1.0);
    if (HAS_SPECULAR_GLASS) {
        b.specular_color = min(material.specular_color, vec3(1.0 / max(1e-30, root * root)));
    }
    if (HAS_IRIDESCENCE) {
        b.film = material.iridescence;
        b.film_index = material.film_index;
        b.film_thickness = material.film_thickness.y;
        b.metallic = material.metallic;
        b.metal0 = material.color;
    }
    b.clearcoat = material.clearcoat;
    b.clearcoat_alpha = alpha_of(material.clearcoat_roughness);
    b.sheen = HAS_SHEEN ? sheen_of(material.sheen_color, material.sheen_roughness) : no_sheen();
    return b;
}

// Of a surface that takes all light in.
Bsdf black() {
    return Bsdf(vec3(0.0), 0.0, 1.0, vec3(0.0), 0.0, vec3(0.0), 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, false, 1.0, vec3(1.0),
                0.0, 1.0, 0.0, 0.0, vec3(0.0), vec3(0.0), no_sheen());
}

// Of a boundary of a solid that light does not see: all of it goes straight on.
Bsdf clear_boundary() {
    Bsdf b = black();
    b.transmission = vec3(1.0);
    b.glass = 1.0;
    return b;
}

// The share of a rough lobe that an eye path leaves to photons when it chooses between gathering and going on, from 1
// less the weight below at the lobe's peak. That itself is best where light comes from about the peak alone; where it
// is the same from everywhere photons from beside it would be rare and count for many. The power is a measured
// middle: tests/bench/results/transport.md.
float gathered_share(float peak) { return pow(1.0 + PI * peak / float(params.knn), -0.7); }

// A rough lobe is sampled in two ways: eye paths follow it, with its own density, and gather photons on it: k of them,
// which come from anywhere, as cos / pi stands for. Both are weighed by the balance heuristic (Veach and Guibas 1995),
// so that narrow lobes are left to eye paths and wide ones to photons, smoothly. This is the weight of what eye paths
// find, be it met or asked for.
float followed_weight(float density, float cosine) {
    return density == DELTA ? 1.0 : density / (density + float(params.knn) * abs(cosine) / PI);
}

// Which part of the lobes a sum is of.
#define PART_ALL 0u       // photons bring all of this light
#define PART_GATHERED 1u  // photons' share of light that eye paths find too
#define PART_FOLLOWED 2u  // that of eye paths: rough lobes alone

// A rough lobe without its Fresnel term, times the weight of the part. density: of wi when it is sampled from wo by
// visible normals; f cos / density is the masking then. Cosines to the lobe's own normal, that of wi of either sign.
float rough_lobe(uint part, Facets facets, float density, Pair pair, float wo_n, float wi_n) {
    float followed = followed_weight(density, wi_n);
    float weight = part == PART_ALL ? 1.0 : part == PART_FOLLOWED ? followed : 1.0 - followed;
    return density * smith_masking(facets, pair.wo, wo_n, pair.wi, wi_n) * weight / abs(wi_n);
}

// The facets of reflection and transmission.
Facets base_facets(Bsdf b, Surface surface) {
    return facets_of(b.alpha, surface.normal, b.stretch, surface.tangent);
}

#include "include/lobes/diffuse.glsl"
#include "include/lobes/reflection.glsl"
#include "include/lobes/transmission.glsl"
#include "include/lobes/clearcoat.glsl"
#include "include/lobes/sheen.glsl"

// ---- over all lobes ----

// A number of each lobe.
struct LobeWeights {
    float of[LOBE_COUNT];
};

float total(LobeWeights lobes) {
    float sum = 0.0;
#define ADD_WEIGHT(number, NAME, name, present) sum += lobes.of[number];
    LOBES(ADD_WEIGHT)
    return sum;
}

// On which sides photons are gathered: HIT_NONE where no lobe is diffuse or rough.
uint gathering_sides(Bsdf b) {
    uint sides = HIT_NONE;
#define ADD_SIDES(number, NAME, name, present) if (present) sides |= name##_gathers(b);
    LOBES(ADD_SIDES)
    return sides;
}

bool gathers_light(Bsdf b) { return gathering_sides(b) != HIT_NONE; }

float width_of(uint lobe, Bsdf b) {
    float width = 0.0;
#define SELECT_WIDTH(number, NAME, name, present) if (present) width = lobe == number ? name##_width(b) : width;
    LOBES(SELECT_WIDTH)
    return width;
}

float stretch_of(uint lobe, Bsdf b) {
    float stretch = 1.0;
#define SELECT_STRETCH(number, NAME, name, present) if (present) stretch = lobe == number ? name##_stretch(b) : stretch;
    LOBES(SELECT_STRETCH)
    return stretch;
}

vec3 normal_of(uint lobe, Surface surface) {
    vec3 n = surface.normal;
#define SELECT_NORMAL(number, NAME, name, present) if (present) n = lobe == number ? name##_normal(surface) : n;
    LOBES(SELECT_NORMAL)
    return n;
}

// The weights with which lobes are chosen for a path that comes from wo.
LobeWeights lobes_of(Bsdf b, Surface surface, vec3 wo) {
    LobeWeights lobes;
#define WEIGH(number, NAME, name, present) lobes.of[number] = present ? name##_weight(b, surface, wo) : 0.0;
    LOBES(WEIGH)
    float cosine = dot(wo, surface.normal);
    float below = below_sheen(b, cosine, cosine);
#define WEIGH_BELOW(number, NAME, name, present) if (lies_below_sheen(number)) lobes.of[number] *= below;
    LOBES(WEIGH_BELOW)
    return lobes;
}

// Their square roots: strong lobes stay before weak ones, by less.
LobeWeights evened(LobeWeights lobes) {
#define EVEN(number, NAME, name, present) lobes.of[number] = sqrt(lobes.of[number]);
    LOBES(EVEN)
    return lobes;
}

// Eye paths gather photons on rough lobes too: their gathered_share goes to the entry of the diffuse lobe, which stands
// for all that is gathered. Returns what is left of the rough lobes, to be followed.
LobeWeights share_with_photons(Bsdf b, inout LobeWeights lobes) {
    LobeWeights rough;
    float shares = 0.0;
#define SHARE(number, NAME, name, present)                                                              \
    {                                                                                                   \
        float width = present ? name##_width(b) : 0.0;                                                  \
        bool both = is_rough(width) && width != WIDE;                                                   \
        float left = width == WIDE ? 1.0 : both ? gathered_share(name##_peak(b)) : 0.0;                 \
        float share = lobes.of[number] * left;                                                          \
        rough.of[number] = both ? lobes.of[number] - share : 0.0;                                       \
        if (number != LOBE_DIFFUSE) {                                                                   \
            shares += share;                                                                            \
            lobes.of[number] -= share;                                                                  \
        }                                                                                               \
    }
    LOBES(SHARE)
    lobes.of[LOBE_DIFFUSE] += shares;
    return rough;
}

// The lobe that u in [0, 1) chooses, and 1 / its probability: the last one that begins below u and is not empty.
uint choose_lobe(LobeWeights lobes, float u, out float inverse_probability) {
    float sum = total(lobes);
    float at = u * sum;
    uint chosen = LOBE_NONE;
    float share = 0.0;
    float before = 0.0;
#define CHOOSE(number, NAME, name, present)           \
    if (lobes.of[number] > 0.0 && (number == 0u || at >= before)) { \
        chosen = number;                              \
        share = lobes.of[number];                     \
    }                                                 \
    before += lobes.of[number];
    LOBES(CHOOSE)
    inverse_probability = sum / share;
    return chosen;
}

// Goes on by one lobe from `direction` (towards the surface): sets the direction and its density per solid angle
// (DELTA for a delta lobe) and returns f cos / density, the lobe's factor of the throughput.
// radiance: true for eye paths, whose radiance changes by the squared ratio of indices across the surface
// (Veach 1997, section 5.2); false for the flux of photons.
vec3 sample_lobe(uint lobe, Bsdf b, Surface surface, vec2 u, bool radiance, inout vec3 direction, out float density) {
    density = DELTA;
    vec3 factor = vec3(0.0);
    float wo_n = dot(direction, surface.normal);
    // Once for all lobes: software Vulkan runs every branch for every lane.
    Facets facets = facets_of(width_of(lobe, b), normal_of(lobe, surface), stretch_of(lobe, b), surface.tangent);
    Facet facet = sample_facet(facets, -direction, u);
#define SAMPLE(number, NAME, name, present) \
    if (present && lobe == number) factor = name##_sample(b, surface, facet, u, radiance, direction, density);
    LOBES(SAMPLE)
    if (HAS_SHEEN) {
        float below = below_sheen(b, wo_n, dot(direction, surface.normal));
        factor *= lies_below_sheen(lobe) ? below : 1.0;
    }
    return factor;
}

// The density, 1/sr (BSDF sampling's pdf), with which a lobe of width above 0 is chosen by choose_lobe in proportion to
// `lobes` and then gives wi by sample_lobe. Less than a density in all where there are delta lobes.
float scatter_density(Bsdf b, Surface surface, LobeWeights lobes, vec3 wo, vec3 wi) {
    Pair pair = pair_of(surface, wo, wi);
    float sum = 0.0;
#define ADD_DENSITY(number, NAME, name, present) \
    if (present) sum += name##_density(b, surface, pair, lobes.of[number]);
    LOBES(ADD_DENSITY)
    return sum / total(lobes);
}

// Light that arrives from wi and is scattered to wo, without the cosine: all lobes of width above 0, each with the
// weight of its part.
vec3 rough_bsdf(Bsdf b, Surface surface, vec3 wo, vec3 wi, uint part) {
    Pair pair = pair_of(surface, wo, wi);
    float below = below_sheen(b, pair.wo_n, pair.wi_n);
    vec3 sum = vec3(0.0);
#define ADD_VALUE(number, NAME, name, present) \
    if (present) sum += (lies_below_sheen(number) ? below : 1.0) * name##_evaluate(b, surface, pair, part);
    LOBES(ADD_VALUE)
    return sum;
}

#endif
