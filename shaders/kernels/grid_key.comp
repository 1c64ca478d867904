#version 460
// One invocation a photon lane: makes its photons compact in the order of paths and bounces, and counts them by cell.
// Reads photons and the scanned lane counts; writes pairs_a (cell, slot) and counters[cell]. O(photons of the lane).
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

layout(binding = BIND_PHOTONS, scalar) readonly buffer PhotonBlock { Photon photons[]; };
layout(binding = BIND_PAIRS_A, scalar) writeonly buffer PairBlock { uvec2 pairs[]; };
layout(binding = BIND_COUNTERS, scalar) buffer CounterBlock { uint counters[]; };

void main() {
    uint lane = invocation();
    if (lane >= params.photon_lanes || blocked(0u)) return;
    uint slot = lane * params.photon_capacity;
    uint end = counters[LANE_COUNTS + lane + 1u];
    for (uint i = counters[LANE_COUNTS + lane]; i < end; ++i, ++slot) {
        uint cell = cell_index(clamp_cell(cell_of(photons[slot].position)));
        pairs[i] = uvec2(cell, slot);
        atomicAdd(counters[cell], 1u);
    }
}
