#version 460
// Surfaces that rays meet, and where rays that leave them start. launch.argument: steps that a ray may take.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RayInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { SurfaceOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    int steps = int(launch.argument);
    vec3 direction = rays[i].direction;
    Hit hit;
    uint found = trace(rays[i].origin, direction, NEAREST, steps, hit);
    SurfaceOutput result;
    result.found = found;
    if (found == TRACE_HIT) {
        Surface s = surface_at(hit, direction);
        result = SurfaceOutput(found, hit.triangle, s.position, s.geometric, s.normal, s.error, s.front ? 1u : 0u,
                               s.material, leave(s, -direction), leave(s, direction), hit.instance);
    }
    outputs[i] = result;
}
