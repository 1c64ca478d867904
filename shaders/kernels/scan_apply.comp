#version 460
// Exclusive scan, step 3 of 3: every block scans itself from the sum of the blocks before it. One invocation a block.
#include "include/kernel.glsl"
#include "include/counters.glsl"

layout(binding = BIND_COUNTERS, scalar) buffer CounterBlock { uint counters[]; };

void main() {
    uint block = invocation();
    if (block >= params.scan_blocks || blocked(0u)) return;
    uint size = (launch.count + params.scan_blocks - 1u) / params.scan_blocks;
    uint begin = launch.offset + min(block * size, launch.count);
    uint end = launch.offset + min((block + 1u) * size, launch.count);
    uint running = counters[SCAN_SUMS + block];
    for (uint i = begin; i < end; ++i) {
        uint value = counters[i];
        counters[i] = running;
        running += value;
    }
}
