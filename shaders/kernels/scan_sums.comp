#version 460
// Exclusive scan (prefix sum) of counters[scan_first .. scan_first + scan_count), step 1 of 3: sums of
// params.scan_blocks consecutive blocks, one invocation a block, without barriers. Reads the counters; writes the sums
// behind them. O(scan_count / scan_blocks); scan_count < 2^16 scan_blocks. Cannot fail.
#include "include/kernel.glsl"
#include "include/counters.glsl"
#include "include/scan.glsl"

COUNTERS(UPDATES)

void main() {
    uint block = invocation();
    if (block >= params.scan_blocks || blocked(0u)) return;
    uvec2 range = scanned_block(block);
    uint sum = 0u;
    for (uint i = range.x; i < range.y; ++i) sum += counters[i];
    counters[SCAN_SUMS + block] = sum;
}
