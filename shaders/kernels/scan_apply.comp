#version 460
// Exclusive scan (prefix sum), step 3 of 3: every block scans itself from the sum of the blocks before it. One
// invocation a block. Reads the scanned sums of blocks; writes the counters in place. O(count / scan_blocks). Cannot
// fail.
#include "include/kernel.glsl"
#include "include/counters.glsl"
#include "include/scan.glsl"

COUNTERS(UPDATES)

void main() {
    uint block = invocation();
    if (block >= params.scan_blocks || blocked(0u)) return;
    uvec2 range = scanned_block(block);
    uint running = counters[SCAN_SUMS + block];
    for (uint i = range.x; i < range.y; ++i) {
        uint value = counters[i];
        counters[i] = running;
        running += value;
    }
}
