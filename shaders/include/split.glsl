// The rules of split light (FEATURE_SPLIT, host/study/reference.h): photons bring caustics, and what is lit at less
// than near_lights from its lamp and seen by way of another surface; paths of the path tracer bring the rest. Elsewhere
// every rule lets all light through (near_lights is 0 there). Pure functions.
#ifndef SPLIT_GLSL
#define SPLIT_GLSL

#include "include/kernel.glsl"
#include "include/ggx.glsl"

// Eye paths: true where light that the path meets is its own to bring.
bool sees_light(uint flags) { return !HAS_SPLIT || (flags & PATH_CAUSTIC) != 0u; }

// Photons: true where one is stored.
bool brings_light(uint flags) { return !HAS_SPLIT || (flags & PATH_CAUSTIC) != 0u; }

// The flags of a photon that has followed a lobe of that density (DELTA or not). lit_near: it is the first since it
// left a lamp that is near.
uint split_photon(uint flags, float density, bool lit_near) {
    if (HAS_SPLIT) {
        if (density == DELTA) {
            flags |= PATH_CAUSTIC;
        } else if (lit_near) {
            // As a light of its own, which eye paths do not find.
            flags |= PATH_CAUSTIC | PATH_STRAIGHT;
        } else {
            flags |= PATH_SCATTERED;
        }
    }
    return flags;
}

// Photons: true where all that the path can still bring is left to others.
bool split_ends(uint flags) { return HAS_SPLIT && (flags & PATH_CAUSTIC) == 0u; }

// The path tracer: true where photons bring the light that a ray of a delta lobe meets.
bool photons_bring_met(uint flags) { return HAS_SPLIT && (flags & PATH_CAUSTIC) != 0u; }

// The path tracer: true where photons bring what an emitter, `distance` away, sends along the ray that met it.
bool photons_bring_emission(uint flags, float distance) {
    return (flags & PATH_SCATTERED) != 0u && distance < params.near_lights;
}

// The path tracer: true where photons bring what a point of the lights sends: it is lit so near, and seen by way of
// another surface.
bool photons_bring_asked(uint flags, uint triangle, float distance) {
    return (flags & PATH_STRAIGHT) == 0u && triangle != NO_TRIANGLE && distance < params.near_lights;
}

// The path tracer: the flags of a path that has followed a lobe of that density, before leave_lobe.
uint split_path(uint flags, float density) {
    bool again = density != DELTA && (flags & PATH_STRAIGHT) == 0u;
    return again ? flags | PATH_SCATTERED : flags & ~PATH_SCATTERED;
}

const float FIRST_NARROWER = 4.0;  // than the discs of other photons are those of photons at their first rough surface

// pi R^2 times the kernel of a photon at q = |offset|^2 / R^2 in [0, 1): twice the estimate of a disc of half the area
// less that of the whole, so that the bias in R^2 cancels (Richardson 1911). first: the photon has met its first
// surface that is not smooth; what comes after that is less sharp by far.
float split_weight(float q, bool first) {
    float scale = first ? FIRST_NARROWER * FIRST_NARROWER : 1.0;
    return q * scale < 0.5 ? 3.0 * scale : q * scale < 1.0 ? -scale : 0.0;
}

// The first radius of a pixel, and its last: a reference does not let its photons choose their discs.
float split_radius(float footprint) { return params.footprint_cap * footprint; }

#endif
