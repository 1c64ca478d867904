// What errors of pixels are estimated from (host/render/error_estimate.h), where they are asked for: sums over the
// iterations of each of ERROR_GROUPS groups, whose spread is the noise.
#ifndef ERROR_GROUPS_GLSL
#define ERROR_GROUPS_GLSL

#include "include/kernel.glsl"
#include "include/sum.glsl"

ERRORS(STORES)
ERRORS(TEXELS)

// Adds an iteration's estimate of the radiance and of the bias of its luminance, both W m^-2 sr^-1. Plain sums: their
// rounding, 2^-24 of the sum at random a term, is far below the spread of as many terms. What is not finite is dropped,
// as the update pass does.
void add_to_group(uint pixel, vec3 estimate, float bias) {
    if (!finite(estimate) || !finite(bias)) return;
    uint place = launch.error_group * pixel_count() + pixel;
    errors[place] = uintBitsToFloat(texelFetch(errors_texels, int(place))) + vec4(estimate, bias);
}

#endif
