#version 460
// One invocation: chooses the cell of the grid from the radii in force. Reads the histogram of radii, the number of
// photons; writes grid and clears the histogram. O(bins^2). The cost it minimises is that of the gather, in loop
// trips: segments of rows visited, and photons in the cells visited at the mean density of photons on the surfaces; and
// the table itself.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

layout(binding = BIND_COUNTERS, scalar) readonly buffer CounterBlock { uint counters[]; };

#define SEGMENT_COST 2.0   // loop trips that a segment of a row costs, measured
#define HASH_PENALTY 1.5   // comparing cells, shorter runs
#define ENTRY_COST 1.0     // loop trips of the gather that clearing, counting and scanning an entry of the table costs

float bin_radius(uint bin) { return exp2((float(bin) + 0.5) * 0.5 - 24.0); }

vec3 dims_of(float cell) { return floor((params.bounds_high - params.bounds_low) / cell) + 1.0; }

bool dense(float cell) {
    vec3 dims = dims_of(cell);
    return dims.x * dims.y * dims.z <= float(params.cells);
}

uint entries_of(float cell) {
    uvec3 dims = uvec3(dims_of(cell));
    return dense(cell) ? dims.x * dims.y * dims.z : params.cells;
}

void main() {
    if (blocked(0u) || invocation() != 0u) return;
    float cell = params.radius_floor;
    if (launch.iteration > 0u) {
        float density = float(counters[PHOTON_TOTAL]) / params.scene_area;
        float best = 3.4e38;
        for (uint candidate = 0u; candidate < RADIUS_BINS; ++candidate) {
            float side = bin_radius(candidate);
            float cost = 0.0;
            for (uint bin = 0u; bin < RADIUS_BINS; ++bin) {
                float pixels = float(status.radius_histogram[bin]);
                float reach = 2.0 * bin_radius(bin);
                float across = reach / side + 1.0;
                cost += pixels * (SEGMENT_COST * across * across + density * (reach + side) * (reach + side));
            }
            if (!dense(side)) cost *= HASH_PENALTY;
            cost += ENTRY_COST * float(entries_of(side));
            if (cost < best) {
                best = cost;
                cell = side;
            }
        }
        for (uint bin = 0u; bin < RADIUS_BINS; ++bin) status.radius_histogram[bin] = 0u;
    }
    vec3 extent = params.bounds_high - params.bounds_low;
    cell = max(cell, max(extent.x, max(extent.y, extent.z)) / 1048576.0);
    grid.origin = params.bounds_low;
    grid.cell = cell;
    grid.inverse_cell = 1.0 / cell;
    grid.dims = uvec4(uvec3(dims_of(cell)), dense(cell) ? 0u : params.cells - 1u);
    grid.entries = entries_of(cell);
}
