// Lobes of microfacets: the distribution GGX (Trowbridge-Reitz; Walter et al. 2007), stretched along a tangent where
// they are anisotropic, with Smith's height-correlated masking (Heitz 2014), and one facet of a lobe as it is sampled.
// Pure functions.
#ifndef GGX_GLSL
#define GGX_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/surface.glsl"

// alpha = roughness^2. A lobe narrower than the rounding of directions is a delta: its density would leave the range of
// floats.
float alpha_of(float roughness) { return roughness < 3e-4 ? 0.0 : roughness * roughness; }

// The density, 1/sr, of a direction that only a delta lobe gives.
const float DELTA = FAR;
// The width of lobes that are not made of facets: photons are gathered on all of their light.
const float WIDE = FAR;

bool is_rough(float alpha) { return HAS_ROUGH && alpha > 0.0; }

// The facets of a lobe: of width `alpha` about the normal n. With anisotropy they are of width alpha * stretch along
// the tangent t, which is perpendicular to n, and of alpha / stretch across it.
struct Facets {
    vec3 n;
    float alpha;
    vec3 t;
    float stretch;
};

// tangent: of any length and direction where the stretch is 1.
Facets facets_of(float alpha, vec3 n, float stretch, vec3 tangent) {
    Facets f = Facets(n, alpha, tangent, stretch);
    if (HAS_ANISOTROPY && stretch == 1.0) {
        vec3 s;
        tangents(n, f.t, s);
    }
    return f;
}

// Along the tangent and across it.
vec2 across_normal(Facets f, vec3 w) { return vec2(dot(f.t, w), dot(cross(f.n, f.t), w)); }

// Distribution of normals. sin^2 from products with what is perpendicular to n: 1 - cos^2 would cancel where the lobe
// is narrow.
float ggx(Facets f, vec3 h) {
    float c = dot(f.n, h);
    float sin2;
    if (HAS_ANISOTROPY) {
        vec2 s = across_normal(f, h) * vec2(1.0 / f.stretch, f.stretch);
        sin2 = dot(s, s);
    } else {
        vec3 s = cross(f.n, h);
        sin2 = dot(s, s);
    }
    float e = sin2 / f.alpha + c * c * f.alpha;
    return 1.0 / (PI * e * e);
}

// Smith's Lambda of a direction and its cosine to the normal, of either sign.
float smith_lambda(Facets f, vec3 w, float cosine) {
    float cos2 = max(cosine * cosine, 1e-12);
    float sin2;
    if (HAS_ANISOTROPY) {
        vec2 s = across_normal(f, w) * vec2(f.stretch, 1.0 / f.stretch);
        sin2 = dot(s, s);
    } else {
        sin2 = max(0.0, 1.0 - cos2);
    }
    return 0.5 * (sqrt(1.0 + f.alpha * f.alpha * sin2 / cos2) - 1.0);
}

float smith_g1(Facets f, vec3 w, float cosine) { return 1.0 / (1.0 + smith_lambda(f, w, cosine)); }

// G2 / G1(wo): what the masking of wi leaves of a direction sampled by visible normals.
float smith_masking(Facets f, vec3 wo, float wo_n, vec3 wi, float wi_n) {
    float lambda = smith_lambda(f, wo, wo_n);
    return (1.0 + lambda) / (1.0 + lambda + smith_lambda(f, wi, wi_n));
}

// A microfacet normal seen from wo, in proportion to its visible area (Dupuy and Benyoub 2023), about +z. alpha: along
// x and y.
vec3 sample_visible_normal(vec2 alpha, vec3 wo, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * wo.xy, wo.z));
    float phi = 2.0 * PI * u.x;
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    float sin_theta = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 c = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + stretched;
    return normalize(vec3(alpha * c.xy, max(c.z, 1e-7)));
}

// Density of `reflect` at a visible normal: of wi, per solid angle.
float reflection_pdf(Facets f, vec3 wo, vec3 h) {
    float cosine = dot(f.n, wo);
    return ggx(f, h) * smith_g1(f, wo, cosine) / (4.0 * cosine);
}

// The greatest it is where wo is the normal.
float reflection_peak_of(float alpha) { return 1.0 / (4.0 * PI * alpha * alpha); }

// Density of refraction at h; eta = index on the side of wo / index beyond, wi_h = |wi . h|: Walter et al. 2007,
// Eq. (17).
float refraction_pdf(Facets f, vec3 wo, float wo_n, vec3 h, float eta, float wo_h, float wi_h) {
    float d = eta * wo_h - wi_h;
    return ggx(f, h) * smith_g1(f, wo, wo_n) * wo_h / wo_n * wi_h / (d * d);
}

// ---- facets ----

// A facet that scatters, as wo sees it.
struct Facet {
    Facets of;
    vec3 h;      // the facet's normal; that of its lobe where the lobe is a delta
    float wo_n;  // cosines, at most 1
    float wo_h;
    bool rough;  // drawn by visible normals, else h is the normal of its lobe
};

Facet smooth_facet(Facets of, vec3 wo) {
    float cosine = min(1.0, dot(wo, of.n));
    return Facet(of, of.n, cosine, cosine, false);
}

// u: two numbers in [0, 1).
Facet sample_facet(Facets of, vec3 wo, vec2 u) {
    Facet facet = smooth_facet(of, wo);
    facet.rough = is_rough(of.alpha) && of.alpha != WIDE;
    if (facet.rough) {
        vec3 t = of.t;
        vec3 s;
        vec2 alpha = vec2(of.alpha);
        if (HAS_ANISOTROPY) {
            s = cross(of.n, t);
            alpha *= vec2(of.stretch, 1.0 / of.stretch);
        } else {
            tangents(of.n, t, s);
        }
        vec3 local = sample_visible_normal(alpha, vec3(dot(wo, t), dot(wo, s), dot(wo, of.n)), u);
        facet.h = normalize(local.x * t + local.y * s + local.z * of.n);
        facet.wo_h = min(1.0, dot(wo, facet.h));
    }
    return facet;
}

// Mirror direction, on the outer side of the geometric surface whatever the shading normal says.
vec3 mirror_direction(vec3 direction, vec3 normal, vec3 geometric) {
    vec3 r = reflect(direction, normal);
    return normalize(dot(r, geometric) > 0.0 ? r : reflect(direction, geometric));
}

// Turns `direction`, towards the surface, to where the facet reflects it; sets its density. Returns the masking
// G2 / G1, 0 where the direction is lost below the surface.
float reflect_at(Facet facet, Surface surface, inout vec3 direction, inout float density) {
    float masking = 1.0;
    if (facet.rough) {
        vec3 wo = -direction;
        direction = reflect(direction, facet.h);
        float wi_n = dot(direction, facet.of.n);
        bool lost = wi_n <= 0.0 || dot(direction, surface.geometric) <= 0.0;
        if (!lost) density = reflection_pdf(facet.of, wo, facet.h);
        masking = lost ? 0.0 : smith_masking(facet.of, wo, facet.wo_n, direction, wi_n);
    } else {
        direction = mirror_direction(direction, facet.of.n, surface.geometric);
    }
    return masking;
}

// ---- pairs of directions ----

// Two directions at a surface, unit, away from it, as lobes see them.
struct Pair {
    vec3 wo;
    vec3 wi;
    vec3 h;         // half vector
    float wo_n;     // cosines to the shading normal
    float wi_n;
    bool reflects;  // wi lies on the geometric side of wo
};

Pair pair_of(Surface surface, vec3 wo, vec3 wi) {
    return Pair(wo, wi, normalize(wo + wi), dot(wo, surface.normal), dot(wi, surface.normal),
                dot(wi, surface.geometric) > 0.0);
}

#endif
