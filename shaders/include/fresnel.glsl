// Fresnel reflectance. Pure functions.
#ifndef FRESNEL_GLSL
#define FRESNEL_GLSL

#include "include/kernel.glsl"

// Of a smooth dielectric, unpolarised. cosine in [0, 1] on the side of incidence, eta = index on that side / index
// beyond. cosine_t: cosine beyond, 0 under total internal reflection.
float fresnel_dielectric(float cosine, float eta, out float cosine_t) {
    float cos2_t = 1.0 - eta * eta * (1.0 - cosine * cosine);
    cosine_t = sqrt(max(cos2_t, 0.0));
    float parallel = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    float perpendicular = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    // No early return: the inliner would make a loop of it, which software Vulkan runs masked.
    return cos2_t > 0.0 ? 0.5 * (parallel * parallel + perpendicular * perpendicular) : 1.0;
}

// (1 - cosine)^5 of Schlick 1994.
float schlick_power(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return (m * m) * (m * m) * m;
}

const float CLEARCOAT_R0 = 0.04;  // KHR_materials_clearcoat: of index 1.5

// Of a clearcoat of that strength.
float clearcoat_reflectance(float clearcoat, float cosine) {
    if (!HAS_CLEARCOAT) return 0.0;
    // precise: versions of Mesa rearrange it, each in its own way, and rounding differs.
    precise float fresnel = clearcoat * (CLEARCOAT_R0 + (1.0 - CLEARCOAT_R0) * schlick_power(cosine));
    return fresnel;
}

#endif
