#version 460
// Starts of light paths.
#include "include/kernel.glsl"
#include "include/sampling.glsl"
#include "include/frame.glsl"
#include "include/light.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { EmitInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { EmitOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.count) return;
    EmitOutput start;
    emit(inputs[i].u, inputs[i].v, start.origin, start.direction, start.power);
    outputs[i] = start;
}
