#version 460
// One invocation a lane of `photons_per_lane` paths: makes their photons compact in the order of paths and bounces, and
// counts them by cell, for level launch.level of the grid. Reads photons, the slots of the paths and the scanned
// counts; writes pairs_a (cell, slot) and counters[cell]. O(photons of the lane). Cannot fail.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

PHOTONS(RECORDS)
COUNTERS(TEXELS)
PAIRS_A(STORES)
COUNTERS(UPDATES)

uint count_at(uint word) { return texelFetch(counters_texels, int(word)).x; }

void main() {
    uint path = invocation() * params.photons_per_lane;
    if (path >= params.photons || launch.level >= grid.levels || blocked(0u)) return;
    GridLevel level = grid_level(launch.level);
    uint first_pair = launch.level * count_at(PHOTON_TOTAL);
    uint end = count_at(PATH_COUNTS + min(path + params.photons_per_lane, params.photons));
    uint i = count_at(PATH_COUNTS + path);
    uint path_end = i;  // of the path before
    uint slot = 0u;
    while (i < end) {
        // Loads of texels are made by all lanes alike.
        uint next_slot = count_at(PATH_SLOTS + path);
        uint next_end = count_at(PATH_COUNTS + path + 1u);
        bool ended = i == path_end;
        slot = ended ? next_slot : slot;
        path_end = ended ? next_end : path_end;
        path += uint(ended);
        if (i < path_end) {
            vec3 position = photons_at(slot).position;
            uint cell = cell_index(level, clamp_cell(level, cell_of(level, position)));
            pairs_a[first_pair + i] = uvec2(cell, slot);
            atomicAdd(counters[cell], 1u);
            ++i;
            ++slot;
        }
    }
}
