// What a scan (prefix sum) goes over: counters[launch.scan_first .. + launch.scan_count), cut into params.scan_blocks
// consecutive blocks. Of the table of cell starts only the entries in use.
#ifndef SCAN_GLSL
#define SCAN_GLSL

#include "include/kernel.glsl"
#include "include/grid.glsl"

uvec2 scanned_block(uint block) {
    uint count = launch.scan_first == COUNTERS_OF_CELLS ? min(launch.scan_count, grid.entries + 1u) : launch.scan_count;
    uint size = (count + params.scan_blocks - 1u) / params.scan_blocks;
    return launch.scan_first + min(uvec2(block * size, (block + 1u) * size), uvec2(count));
}

#endif
