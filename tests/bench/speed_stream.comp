#version 460
// Nearest hits of rays, launch.round of them a lane: a lane takes its next ray as soon as it is done with one, as
// shaders/kernels/photon.comp does. launch.offset: steps that a lane may take for each of its rays, on average.
#include "include/kernel.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "../kernels/probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RayInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { RayOutput outputs[]; };

void main() {
    uint ray = invocation() * launch.round;
    uint last = min(ray + launch.round, launch.count);
    int steps = int(launch.offset);
    Traversal traversal = no_traversal();
    bool running = ray < last;
    bool fresh = true;
    while (subgroupAny(running)) {
        if (running && fresh) {
            traversal = begin_traversal(rays[ray].origin, rays[ray].direction);
            fresh = false;
        }
        traverse(traversal, steps, true, running);
        uint found = found_by(traversal);
        if (!running || (found == TRACE_UNFINISHED && steps > 0)) continue;
        outputs[ray] = RayOutput(found, traversal.hit.t, traversal.hit.triangle, traversal.hit.barycentric, steps);
        --steps;
        fresh = true;
        ++ray;
        running = ray < last;
        if (steps <= 0) running = false;
        if (!running) traversal.node = NO_NODE;
    }
}
