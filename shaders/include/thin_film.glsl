// Reflectance of a thin film over a base (KHR_materials_iridescence). Pure functions.
// Light that goes to and fro in the film interferes with what its face reflects: the reflectance is a cosine series in
// the difference of the paths (Airy), whose terms are averaged over the spectrum of each channel (Belcour and Barla
// 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence").
#ifndef THIN_FILM_GLSL
#define THIN_FILM_GLSL

#include "include/kernel.glsl"
#include "include/fresnel.glsl"
#include "include/sampling.glsl"

// Times that light goes to and fro: those beyond matter on metals at grazing angles alone.
const int FILM_ORDERS = 4;

// How much of a term is left in each channel: the Fourier transform of the channel's sensitivity over wave numbers, of
// four Gaussians, those of Belcour and Barla for CIE XYZ, in sRGB and each channel over its sum, so that white stays
// white. difference: of the paths, micrometres.
vec3 thin_film_sensitivity(float difference) {
    const mat4x3 share = mat4x3(2.275931, -0.865289, 0.051766,   // X about 0.595 micrometres
                                -1.275526, 1.978687, -0.224252,  // Y
                                -0.414057, 0.043870, 1.163078,   // Z
                                0.413652, -0.157267, 0.009408);  // X about 0.446 micrometres
    const vec4 wave_number = vec4(1.6810, 1.7953, 2.2084, 2.2399);  // 1 / micrometre
    const vec4 variance = vec4(0.0043278, 0.0093046, 0.0066121, 0.0045282);
    // Beyond, nothing is left, and cosines of what is infinite are none.
    float phase = min(2.0 * PI * difference, 200.0);
    return share * (cos(wave_number * phase) * exp(-variance * (phase * phase)));
}

// cosine: outside, where the index is 1. index, thickness (micrometres): of the film. r0: reflectance of the bare base
// at normal incidence, which stands for its index. Faces reflect by Schlick 1994.
vec3 thin_film_reflectance(float cosine, float index, float thickness, vec3 r0) {
    float beyond = sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    float root = (index - 1.0) / (index + 1.0);
    float outer0 = root * root;
    float outer = outer0 + (1.0 - outer0) * schlick_power(cosine);
    vec3 amplitude = sqrt(min(r0, vec3(0.9999)));
    vec3 base_index = (1.0 + amplitude) / (1.0 - amplitude);
    vec3 inner0 = (base_index - index) / (base_index + index);
    // Where the base is denser, light that it reflects is half a wave behind what the outer face reflects inwards.
    vec3 behind = mix(vec3(1.0), vec3(-1.0), greaterThan(inner0, vec3(0.0)));
    inner0 *= inner0;
    vec3 inner = inner0 + (1.0 - inner0) * schlick_power(beyond);
    float through = 1.0 - outer;
    // At grazing the outer face alone reflects all.
    vec3 both = min(outer * inner, vec3(0.9999));
    vec3 returned = through * through * inner / (1.0 - both);
    vec3 sum = outer + returned;
    vec3 term = 2.0 * (returned - through);
    vec3 ratio = behind * sqrt(both);
    float difference = 2.0 * index * thickness * beyond;
    for (int order = 1; order <= FILM_ORDERS; ++order) {
        term *= ratio;
        sum += term * thin_film_sensitivity(float(order) * difference);
    }
    // Channels are no spectra: some colours lie outside.
    return clamp(sum, vec3(0.0), vec3(1.0));
}

#endif
