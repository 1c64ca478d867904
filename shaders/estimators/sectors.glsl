// The unified domain of Lin et al. 2020: the unit disc cut into n_a rings of equal area and n_s sectors. FOLDED:
// opposite sectors are one cell, as the estimator's row says.
#ifndef SECTORS_GLSL
#define SECTORS_GLSL

#include "include/kernel.glsl"

const uint RING_CELLS = FOLDED ? SECTORS / 2u : SECTORS;
const uint DISC_CELLS = RINGS * RING_CELLS;

// Bin of a photon at v, q = |offset|^2 / R^2 in [0, 1). Half-plane tests instead of an arc tangent: the same on every
// driver. n_s is even: the lower half plane is the upper one turned by n_s / 2 sectors.
uint cell_bin(vec2 v, float q) {
    uint ring = min(RINGS - 1u, uint(q * float(RINGS)));
    bool lower = v.y < 0.0 || (v.y == 0.0 && v.x < 0.0);
    if (lower) v = -v;
    uint sector = lower && !FOLDED ? SECTORS / 2u : 0u;
    for (uint s = 1u; s < SECTORS / 2u; ++s) {
        vec2 edge = params.sector_edge[s];
        sector += edge.x * v.y - edge.y * v.x >= 0.0 ? 1u : 0u;
    }
    return ring * RING_CELLS + sector;
}

#endif
