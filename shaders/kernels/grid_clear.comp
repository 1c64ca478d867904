#version 460
// Zeroes the table of cell counts. Writes counters[0 .. grid.entries]; each invocation strides over it.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

layout(binding = BIND_COUNTERS, scalar) buffer CounterBlock { uint counters[]; };

void main() {
    if (blocked(0u)) return;
    uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint i = invocation(); i <= grid.entries; i += stride) counters[i] = 0u;
}
