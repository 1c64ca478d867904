#version 460
// Starts of light paths.
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/frame.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/environment.glsl"
#include "include/light.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { EmitInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { EmitOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    EmitOutput start;
    float near;
    start.kind = emit(inputs[i].bits, inputs[i].v, start.origin, start.direction, start.power, near);
    start.radiance = vec3(0.0);
    if (HAS_ENVIRONMENT) start.radiance = environment_radiance(-start.direction);
    outputs[i] = start;
}
