// The angle of (x, y) to the x axis in (-pi, pi], to 4e-7; of (0, 0): 0. atan of the language differs from driver to
// driver (Mesa 22.3.6 and 25.0.7: by up to 5e-7). This one is made of operations that Vulkan rounds exactly, but for
// the quotient. atan(t) / t in t^2: Chebyshev series on [0, 1], to 1.6e-7.
#ifndef ANGLE_GLSL
#define ANGLE_GLSL

#include "include/sampling.glsl"

float angle_of(float y, float x) {
    float a = abs(x);
    float b = abs(y);
    float t = min(a, b) / max(max(a, b), 1e-30);
    precise float s = t * t;
    precise float p = -0.00466877315 * s + 0.0241661891;
    p = p * s - 0.0593671016;
    p = p * s + 0.0990609676;
    p = p * s - 0.140165851;
    p = p * s + 0.199692354;
    p = p * s - 0.333319604;
    p = p * s + 0.999999881;
    precise float angle = p * t;
    if (b > a) angle = PI / 2.0 - angle;
    if (x < 0.0) angle = PI - angle;
    return y < 0.0 ? -angle : angle;
}

#endif
