#version 460
// One invocation a pixel: the mean over the completed iterations. Reads film; writes image [P] W m^-2 sr^-1.
#include "include/kernel.glsl"

layout(binding = BIND_FILM, scalar) readonly buffer FilmBlock { Film film[]; };
layout(binding = BIND_IMAGE, scalar) writeonly buffer ImageBlock { vec3 image[]; };

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count()) return;
    image[pixel] = (film[pixel].sum + film[pixel].low) / float(max(status.completed, 1u));
}
