#version 460
// Angles of vectors of the plane.
#include "include/kernel.glsl"
#include "include/sampling.glsl"
#include "include/angle.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { vec2 inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { float outputs[]; };

void main() {
    uint i = invocation();
    if (i < launch.items) outputs[i] = angle_of(inputs[i].y, inputs[i].x);
}
