#version 460
// Zeroes the table of cell counts; any number of invocations, which stride over it. Writes
// counters[0 .. grid.entries]. O(entries of the table). Cannot fail.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

COUNTERS(UPDATES)

void main() {
    if (blocked(0u)) return;
    uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint i = invocation(); i <= grid.entries; i += stride) counters[i] = 0u;
}
