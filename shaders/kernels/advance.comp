#version 460
// One invocation: a band of the picture is complete, and with the last one the iteration. Reads the number of photons;
// writes status.band, .searches, .completed, .photons, .stored. O(1). Cannot fail.
#include "include/kernel.glsl"
#include "include/counters.glsl"

COUNTERS(READS)

void main() {
    if (blocked(0u) || invocation() != 0u) return;
    status.searches = 0u;
    status.band = launch.last_band == 1u ? 0u : launch.band + 1u;
    if (launch.last_band == 0u) return;
    status.completed = launch.iteration + 1u;
    status.photons = counters[PHOTON_TOTAL];
    status.stored += status.photons;
}
