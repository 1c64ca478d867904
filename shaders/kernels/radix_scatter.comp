#version 460
// Stable radix sort, step 2 of 2: after the scan of the histogram, every invocation moves its consecutive pairs to
// their places. Reads the pairs that launch says and the scanned histogram; writes the other pairs. O(pairs / columns).
// Cannot fail.
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
    uint total = SORTED_TOTAL;
    uint size = (total + params.sort_lanes - 1u) / params.sort_lanes;
    uint begin = min(lane * size, total);
    uint end = min(begin + size, total);
    for (uint i = begin; i < end; ++i) {
        uvec2 pair = launch.reads_b == 0u ? pairs_a[i] : pairs_b[i];
        uint digit = (pair.x >> launch.digit_shift) & (digits - 1u);
        uint place = counters[RADIX_COUNTS + digit * params.sort_lanes + lane]++;
        if (launch.reads_b == 0u) {
            pairs_b[place] = pair;
        } else {
            pairs_a[place] = pair;
        }
    }
}
