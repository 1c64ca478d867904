#version 460
// Zeroes the table of cell counts; any number of invocations, which stride over it. Reads how many pixels look for a
// radius, and the size of knn's work groups; writes counters[0 .. grid.entries], and how many work groups of knn there
// is work for. O(entries of the table). Cannot fail.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

#define MOST_GROUPS 65535u  // along an axis, of every device

COUNTERS(UPDATES)

void main() {
    if (blocked(0u)) return;
    if (invocation() == 0u) {
        uint groups = (status.searches + launch.search_group - 1u) / launch.search_group;
        uint rows = groups / MOST_GROUPS + 1u;
        status.search_groups = uvec3((groups + rows - 1u) / rows, rows, 1u);
    }
    uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint i = invocation(); i <= grid.entries; i += stride) counters[i] = 0u;
}
