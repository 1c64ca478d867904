#version 460
// One invocation: the iteration is complete. Reads the number of photons; writes status.completed, .searches, .photons,
// .stored. O(1). Cannot fail.
#include "include/kernel.glsl"
#include "include/counters.glsl"

COUNTERS(READS)

void main() {
    if (blocked(0u) || invocation() != 0u) return;
    status.completed = launch.iteration + 1u;
    status.searches = 0u;
    status.photons = counters[PHOTON_TOTAL];
    status.stored += status.photons;
}
