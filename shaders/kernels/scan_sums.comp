#version 460
// Exclusive scan of counters[offset .. offset + length), step 1 of 3: sums of SCAN_BLOCKS consecutive blocks, one
// invocation a block, without barriers. O(length / SCAN_BLOCKS). length < 2^16 x SCAN_BLOCKS.
#include "include/kernel.glsl"
#include "include/counters.glsl"

layout(binding = BIND_COUNTERS, scalar) buffer CounterBlock { uint counters[]; };

void main() {
    uint block = invocation();
    if (block >= SCAN_BLOCKS || blocked(0u)) return;
    uint size = (launch.count + SCAN_BLOCKS - 1u) / SCAN_BLOCKS;
    uint begin = launch.offset + min(block * size, launch.count);
    uint end = launch.offset + min((block + 1u) * size, launch.count);
    uint sum = 0u;
    for (uint i = begin; i < end; ++i) sum += counters[i];
    counters[SCAN_SUMS + block] = sum;
}
