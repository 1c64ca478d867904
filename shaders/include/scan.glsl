// What a scan goes over: counters[launch.offset .. + launch.count), cut into params.scan_blocks consecutive blocks. Of
// the table of cell starts, which stands at 0, only the entries in use.
#ifndef SCAN_GLSL
#define SCAN_GLSL

#include "include/kernel.glsl"
#include "include/grid.glsl"

uvec2 scanned_block(uint block) {
    uint count = launch.offset == 0u ? min(launch.count, grid.entries + 1u) : launch.count;
    uint size = (count + params.scan_blocks - 1u) / params.scan_blocks;
    return launch.offset + min(uvec2(block * size, (block + 1u) * size), uvec2(count));
}

#endif
