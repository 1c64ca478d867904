// The histogram of the radii in force, from which the grid is planned: bin 2 (log2 R + 24), clamped. Pure functions.
#ifndef RADIUS_BINS_GLSL
#define RADIUS_BINS_GLSL

#include "include/kernel.glsl"

#define OCTAVES_BELOW_ONE 24  // of R, that have bins

int radius_bin(float radius2) {
    return clamp(int(floor(log2(radius2))) + 2 * OCTAVES_BELOW_ONE, 0, RADIUS_BINS - 1);
}

// The radius in the middle of a bin.
float bin_radius(uint bin) { return exp2((float(bin) + 0.5) * 0.5 - float(OCTAVES_BELOW_ONE)); }

#endif
