// The hashed grid of photons. Cells of one row along x stand together in the table. While the box of cells fits the
// table the hash is the identity (dense rows); else runs of HASH_RUN cells along x are hashed, and whoever reads a
// bucket must compare the photon's own cell.
layout(binding = BIND_GRID, scalar) buffer GridBlock { Grid grid; };

#define HASH_RUN 8

// Radix passes that sorting by cell takes: those whose digit is not 0 for all entries.
uint sort_passes() { return (uint(findMSB(max(grid.entries - 1u, 1u))) + DIGIT_BITS) / DIGIT_BITS; }

ivec3 cell_of(vec3 position) { return ivec3(floor((position - grid.origin) * grid.inverse_cell)); }

ivec3 clamp_cell(ivec3 cell) { return clamp(cell, ivec3(0), ivec3(grid.dims.xyz) - 1); }

// Entry of the cell in the table of starts.
uint cell_index(ivec3 cell) {
    if (grid.dims.w == 0u) return (uint(cell.z) * grid.dims.y + uint(cell.y)) * grid.dims.x + uint(cell.x);
    // Teschner et al. 2003: few instructions, and neighbours in y and z fall apart.
    uint hash = (uint(cell.x) / HASH_RUN * 73856093u) ^ (uint(cell.y) * 19349663u) ^ (uint(cell.z) * 83492791u);
    hash ^= hash >> 15u;
    return ((hash * HASH_RUN) & grid.dims.w) + uint(cell.x) % HASH_RUN;
}
