#version 460
// Stable radix sort of the photon pairs by cell, one digit a pass, step 1 of 2: every invocation counts the digits of
// its consecutive pairs into its own column of the histogram [digits x columns]. No atomics, no barriers: the order
// never depends on scheduling. Reads the pairs and the digit that launch says.
// Stable because columns are in order of the pairs and a column keeps their order. Writes the histogram in counters.
// O(pairs / columns + digits). Cannot fail.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

PAIRS_A(UPDATES)
PAIRS_B(UPDATES)
COUNTERS(UPDATES)

void main() {
    uint lane = invocation();
    if (lane >= params.sort_lanes || launch.digit_shift >= sort_passes() * DIGIT_BITS || blocked(0u)) return;
    const uint digits = 1u << DIGIT_BITS;
    for (uint digit = 0u; digit < digits; ++digit) counters[RADIX_COUNTS + digit * params.sort_lanes + lane] = 0u;
    uint total = SORTED_TOTAL;
    uint size = (total + params.sort_lanes - 1u) / params.sort_lanes;
    uint begin = min(lane * size, total);
    uint end = min(begin + size, total);
    for (uint i = begin; i < end; ++i) {
        uint cell = launch.reads_b == 0u ? pairs_a[i].x : pairs_b[i].x;
        uint digit = (cell >> launch.digit_shift) & (digits - 1u);
        ++counters[RADIX_COUNTS + digit * params.sort_lanes + lane];
    }
}
