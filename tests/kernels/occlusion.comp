#version 460
// Whether there is anything along rays, up to a distance and but for a triangle. launch.argument: steps that a ray may
// take.
#include "include/kernel.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { OcclusionInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { uint found[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    int steps = int(launch.argument);
    Hit hit;
    found[i] = trace(rays[i].origin, rays[i].direction, Sought(rays[i].within, rays[i].but, true), steps, hit);
}
