#version 460
// Exclusive scan of counters[offset .. offset + count), step 1 of 3: sums of params.scan_blocks consecutive blocks, one
// invocation a block, without barriers. O(count / scan_blocks); count < 2^16 scan_blocks.
#include "include/kernel.glsl"
#include "include/counters.glsl"

layout(binding = BIND_COUNTERS, scalar) buffer CounterBlock { uint counters[]; };

void main() {
    uint block = invocation();
    if (block >= params.scan_blocks || blocked(0u)) return;
    uint size = (launch.count + params.scan_blocks - 1u) / params.scan_blocks;
    uint begin = launch.offset + min(block * size, launch.count);
    uint end = launch.offset + min((block + 1u) * size, launch.count);
    uint sum = 0u;
    for (uint i = begin; i < end; ++i) sum += counters[i];
    counters[SCAN_SUMS + block] = sum;
}
