#version 460
// Copies the photons into the order of their cells, so that a row of cells is one run of memory. Reads photons and the
// sorted pairs; writes sorted, sorted_flux. Any number of invocations, which stride over the photons. O(photons x
// levels). Cannot fail.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

PAIRS_A(READS)
PAIRS_B(READS)
PHOTONS(RECORDS)
PHOTON_FLUX(RECORDS)
SORTED(STORES)
SORTED_FLUX(STORES)
COUNTERS(READS)

void main() {
    if (blocked(0u)) return;
    bool in_a = sort_passes() % 2u == 0u;
    uint total = SORTED_TOTAL;
    uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint i = invocation(); i < total; i += stride) {
        uint slot = in_a ? pairs_a[i].y : pairs_b[i].y;
        sorted[i] = photons_at(slot);
        sorted_flux[i] = photon_flux_at(slot);
    }
}
