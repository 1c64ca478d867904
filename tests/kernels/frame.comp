#version 460
// Packing and tangent frames of every unit vector.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { vec3 directions[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { FrameSample samples[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    vec3 n = directions[i];
    uint word = pack_direction(n);
    vec3 t, b;
    tangents(n, t, b);
    samples[i] = FrameSample(word, unpack_direction(word), t, b, from_frame(n, vec3(0.6, 0.0, 0.8)));
}
