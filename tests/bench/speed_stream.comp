#version 460
// Nearest hits of rays. The lanes of a SIMD group share launch.round rays for each of them, and one takes the next ray
// as soon as it is done with its own, as shaders/kernels/photon.comp does. launch.argument: steps that a lane
// may take in all.
#include "include/kernel.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "../kernels/probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RayInput rays[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { RayOutput outputs[]; };

void main() {
    uint share = gl_SubgroupSize * launch.round;
    uint next = min((gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID) * share, launch.items);
    uint end = min(next + share, launch.items);
    int steps = int(launch.argument);
    Traversal traversal = no_traversal();
    uint ray = 0u;
    bool running = true;
    bool wants = true;
    while (lanes(running) > 0u) {
        uvec4 wanting = subgroupBallot(running && wants);
        if (running && wants) {
            ray = next + subgroupBallotExclusiveBitCount(wanting);
            running = ray < end;
            wants = false;
            if (running) traversal = begin_traversal(rays[ray].origin, rays[ray].direction, NEAREST);
        }
        next += subgroupBallotBitCount(wanting);
        traverse(traversal, steps, true, running);
        uint found = found_by(traversal);
        if (running && (found != TRACE_UNFINISHED || steps <= 0)) {
            outputs[ray] = RayOutput(found, traversal.hit.t, traversal.hit.triangle, traversal.hit.barycentric, steps,
                                          traversal.hit.instance);
            running = steps > 0;
            wants = true;
            traversal.node = NO_NODE;
            --steps;
        }
    }
}
