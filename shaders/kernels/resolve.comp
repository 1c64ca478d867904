#version 460
// One invocation a pixel: the mean over the completed iterations. Reads film; writes image [P] W m^-2 sr^-1. O(1).
// Cannot fail.
#include "include/kernel.glsl"

FILM(READS)
IMAGE(STORES)

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count()) return;
    image[pixel] = (film[pixel].sum + film[pixel].low) / float(max(status.completed, 1u));
}
