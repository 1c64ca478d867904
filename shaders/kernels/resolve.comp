#version 460
// One invocation a pixel: the mean over the completed iterations, 0 where noise has left it below (picture_of of
// host/render/sums.h). Reads film; writes image [P] W m^-2 sr^-1. O(1). Cannot fail.
#include "include/kernel.glsl"

FILM(READS)
IMAGE(STORES)

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count()) return;
    vec3 mean = (film[pixel].sum + film[pixel].low) / float(max(status.completed, 1u));
    image[pixel] = mix(mean, vec3(0.0), lessThan(mean, vec3(0.0)));  // not max: what is no number shall show
}
