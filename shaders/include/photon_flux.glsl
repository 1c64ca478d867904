// What a stored photon carries beside its power, in the sign bits of that: power is not negative. Pure functions.
#ifndef PHOTON_FLUX_GLSL
#define PHOTON_FLUX_GLSL

#include "include/kernel.glsl"

#define SIGN_BIT 0x80000000u

float with_sign(float x, bool negative) {
    return uintBitsToFloat(floatBitsToUint(x) | (negative ? SIGN_BIT : 0u));
}

bool has_sign(float x) { return (floatBitsToUint(x) & SIGN_BIT) != 0u; }

vec3 power_of(PhotonFlux flux) { return abs(flux.power); }

// It comes straight from a punctual light by way of mirrors and smooth glass alone, and at least one: no eye path finds
// its light.
bool brings_all(PhotonFlux flux) { return has_sign(flux.power.r); }
vec3 set_brings_all(vec3 power, bool all) { return vec3(with_sign(power.r, all), power.gb); }

// Where light is split: this is the first surface it meets that is not smooth.
bool is_first_rough(PhotonFlux flux) { return has_sign(flux.power.g); }
vec3 set_first_rough(vec3 power, bool first) { return vec3(power.r, with_sign(power.g, first), power.b); }

// Where there are further channels: its layer, LAYER_*.
uint layer_of(PhotonFlux flux) {
    return has_sign(flux.power.g) ? LAYER_CAUSTIC : has_sign(flux.power.b) ? LAYER_DIRECT : LAYER_REST;
}
vec3 set_layer(vec3 power, uint layer) {
    return vec3(power.r, with_sign(power.g, layer == LAYER_CAUSTIC), with_sign(power.b, layer == LAYER_DIRECT));
}

#endif
