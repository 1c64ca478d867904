#version 460
// Exclusive scan (prefix sum), step 2 of 3: one work group scans the block sums in place. Any work group size that
// divides params.scan_blocks. O(params.scan_blocks / size + size). Cannot fail.
#include "include/kernel.glsl"
#include "include/counters.glsl"

COUNTERS(UPDATES)

shared uint totals[gl_WorkGroupSize.x];

void main() {
    bool idle = blocked(0u);  // the same for the whole work group
    uint lane = gl_LocalInvocationIndex;
    uint size = params.scan_blocks / gl_WorkGroupSize.x;
    uint first = SCAN_SUMS + lane * size;
    uint sum = 0u;
    for (uint i = 0u; i < size; ++i) sum += counters[first + i];
    totals[lane] = sum;
    barrier();
    if (idle) return;
    uint running = 0u;
    for (uint i = 0u; i < lane; ++i) running += totals[i];
    for (uint i = 0u; i < size; ++i) {
        uint value = counters[first + i];
        counters[first + i] = running;
        running += value;
    }
}
