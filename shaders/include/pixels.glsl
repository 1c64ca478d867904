// What a pixel remembers between iterations: its radius and the statistics of its estimator.
#ifndef PIXELS_GLSL
#define PIXELS_GLSL

#include "include/kernel.glsl"

PIXELS(STORES)
PIXELS(RECORDS)

// A radius is never smaller than the rounding error of a position in the scene frame.
const float RADIUS2_MIN = 1e-12;

// Photons with which a batch is full however large it is, and a tally starts again: what is added to it in an iteration
// leaves it below 2^31.
const float MOST_PHOTONS = 1073741824.0;

// About pi R^2 over the area of the surface in this iteration's disc; 1: it is not measured.
float disc_per_surface(PixelState state) { return 1.0 + state.excess; }

bool batch_is_full(PixelState state) { return float(state.total) >= min(state.batch, MOST_PHOTONS); }

#endif
