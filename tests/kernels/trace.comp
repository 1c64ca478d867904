#version 460
// Nearest hits of rays. launch.argument: steps that a ray may take.
#include "include/kernel.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RayInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { RayOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    int steps = int(launch.argument);
    Hit hit;
    uint found = trace(rays[i].origin, rays[i].direction, NEAREST, steps, hit);
    outputs[i] = RayOutput(found, hit.t, hit.triangle, hit.barycentric, int(launch.argument) - steps,
                           hit.instance);
}
