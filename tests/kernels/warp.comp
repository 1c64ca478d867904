#version 460
// Every map from the unit square.
#include "include/kernel.glsl"
#include "include/sampling.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { WarpInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { WarpOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    vec2 u = inputs[i].u;
    outputs[i] = WarpOutput(sample_cosine(u), sample_triangle(u), sample_disc(u), sample_azimuth(1.0 - 2.0 * u.x, u.y),
                            1.0 - sample_spot_versine(1.0 - inputs[i].inner, 1.0 - inputs[i].outer, u.x));
}
