#version 460
// One invocation: how many work groups of knn there is work for in this band. Reads how many of its pixels look for a
// radius, and the size of knn's work groups; writes status.search_groups. O(1). Cannot fail.
#include "include/kernel.glsl"

#define MOST_GROUPS 65535u  // along an axis, of every device

void main() {
    if (blocked(0u) || invocation() != 0u) return;
    uint groups = (status.searches + launch.search_group - 1u) / launch.search_group;
    uint rows = groups / MOST_GROUPS + 1u;
    status.search_groups = uvec3((groups + rows - 1u) / rows, rows, 1u);
}
