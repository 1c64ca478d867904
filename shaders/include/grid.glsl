// The hashed grid of photons, of up to GRID_LEVELS levels, each a table of its own. Cells of one row along x stand
// together in the table. While the box of cells fits the table the hash is the identity (dense rows); else runs of
// HASH_RUN cells along x are hashed, and whoever reads a bucket must compare the photon's own cell.
#ifndef GRID_GLSL
#define GRID_GLSL

#include "include/kernel.glsl"

GRID(VALUE)

#define HASH_RUN 8

// Radix passes that sorting by cell takes: those whose digit is not 0 for all entries.
uint sort_passes() { return (uint(findMSB(max(grid.entries - 1u, 1u))) + DIGIT_BITS) / DIGIT_BITS; }

struct GridLevel {
    uvec4 dims;
    float inverse_cell;
    uint first;
};

GridLevel grid_level(uint level) { return GridLevel(grid.dims[level], grid.inverse_cell[level], grid.first[level]); }

// The level that discs of that radius look at.
GridLevel level_for(float radius) {
    GridLevel level = grid_level(0u);
    for (uint i = 1u; i < LEVELS; ++i) {
        if (radius > grid.reach[i - 1u]) level = grid_level(i);
    }
    return level;
}

ivec3 cell_of(GridLevel level, vec3 position) { return ivec3(floor((position - grid.origin) * level.inverse_cell)); }

ivec3 clamp_cell(GridLevel level, ivec3 cell) { return clamp(cell, ivec3(0), ivec3(level.dims.xyz) - 1); }

// Entry of the cell in the table of starts.
uint cell_index(GridLevel level, ivec3 cell) {
    if (level.dims.w == 0u) {
        return level.first + (uint(cell.z) * level.dims.y + uint(cell.y)) * level.dims.x + uint(cell.x);
    }
    // Teschner et al. 2003: few instructions, and neighbours in y and z fall apart.
    uint hash = (uint(cell.x) / HASH_RUN * 73856093u) ^ (uint(cell.y) * 19349663u) ^ (uint(cell.z) * 83492791u);
    hash ^= hash >> 15u;
    return level.first + ((hash * HASH_RUN) & level.dims.w) + uint(cell.x) % HASH_RUN;
}

#endif
