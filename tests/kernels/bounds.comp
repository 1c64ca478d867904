#version 460
// Where rays enter the scene's bounds.
#include "include/kernel.glsl"
#include "include/bounds.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RayInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { vec3 origins[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    origins[i] = enter_bounds(rays[i].origin, rays[i].direction);
}
