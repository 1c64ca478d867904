#version 460
// One invocation: chooses the levels of the grid from the radii in force. The cost it minimises is that of the gather,
// in loop trips: segments of rows visited, and photons in the cells visited at the density about discs of that radius;
// of the tables, and of what a level more costs to build. Reads the histograms of radii and of photons in
// discs; writes grid and clears the histograms. O(levels^2 x bins^2): at most 20,000 loop trips for radii over 10^6 and
// 50,000 if every bin were in use, of the 65,535 that software Vulkan runs. Fails where there is no room for so many
// levels: begins again when there is.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/radius_bins.glsl"
#include "include/sampling.glsl"

#define SEGMENT_COST 2.0   // loop trips that a segment of a row costs, measured
#define HASH_PENALTY 1.5   // comparing cells, shorter runs
#define ENTRY_COST 1.0     // loop trips of the gather that clearing, counting and scanning an entry of the table costs
#define PHOTON_COST 15.0   // that sorting a photon into a level costs
#define CELL_PER_RADIUS 1.2  // at which a disc costs least, about

// Cells of the levels, from the finest on.
struct Plan {
    float cell[GRID_LEVELS];
    uint levels;
};

uint lowest_bin, highest_bin;  // of those with pixels
float pixels_of[RADIUS_BINS];
float density_of[RADIUS_BINS];  // photons an area

// So that cells can be counted along an axis.
float least_cell() {
    vec3 extent = params.bounds_high - params.bounds_low;
    return max(extent.x, max(extent.y, extent.z)) / 1048576.0;
}

vec3 dims_of(float cell) { return floor((params.bounds_high - params.bounds_low) / cell) + 1.0; }

// Entries of the table that each of so many levels can have, a power of two.
uint capacity_of(uint levels) { return params.cells >> uint(findMSB(2u * levels - 1u)); }

bool dense(float cell, uint levels) {
    vec3 dims = dims_of(cell);
    return dims.x * dims.y * dims.z <= float(capacity_of(levels));
}

uint entries_of(float cell, uint levels) {
    uvec3 dims = uvec3(dims_of(cell));
    return dense(cell, levels) ? dims.x * dims.y * dims.z : capacity_of(levels);
}

// The largest radius that looks at cells of that size where the next larger ones are of that.
float reach_of(float cell, float next) { return sqrt(cell * next) / CELL_PER_RADIUS; }

float gather_cost(uint bin, float cell, uint levels) {
    float reach = 2.0 * bin_radius(bin);
    float across = reach / cell + 1.0;
    float cost = SEGMENT_COST * across * across + density_of[bin] * (reach + cell) * (reach + cell);
    return pixels_of[bin] * cost * (dense(cell, levels) ? 1.0 : HASH_PENALTY);
}

float cost_of(Plan plan) {
    float cost = PHOTON_COST * float(plan.levels - 1u) * float(status.photons);
    for (uint level = 0u; level < plan.levels; ++level) {
        cost += ENTRY_COST * float(entries_of(plan.cell[level], plan.levels));
    }
    uint level = 0u;
    for (uint bin = lowest_bin; bin <= highest_bin; ++bin) {
        while (level + 1u < plan.levels && bin_radius(bin) > reach_of(plan.cell[level], plan.cell[level + 1u])) ++level;
        cost += gather_cost(bin, plan.cell[level], plan.levels);
    }
    return cost;
}

// Exchanges the cell of one level for the best between its neighbours'; returns the cost of the plan.
float choose_cell(inout Plan plan, uint level) {
    float best = cost_of(plan);
    Plan trial = plan;
    for (uint bin = lowest_bin; bin <= highest_bin + 4u; ++bin) {
        float cell = max(bin_radius(bin), least_cell());
        if (level > 0u && cell <= plan.cell[level - 1u]) continue;
        if (level + 1u < plan.levels && cell >= plan.cell[level + 1u]) break;
        trial.cell[level] = cell;
        float cost = cost_of(trial);
        if (cost < best) {
            best = cost;
            plan.cell[level] = cell;
        }
    }
    return best;
}

// The plan with one level more, each of its levels chosen in turn.
float add_level(inout Plan plan) {
    for (uint level = plan.levels; level > 0u; --level) plan.cell[level] = plan.cell[level - 1u];
    plan.cell[0] *= 0.5;
    ++plan.levels;
    float cost = 0.0;
    for (uint level = 0u; level < plan.levels; ++level) cost = choose_cell(plan, level);
    return cost;
}

Plan best_plan() {
    Plan plan;
    plan.levels = 1u;
    plan.cell[0] = bin_radius(lowest_bin);
    float cost = choose_cell(plan, 0u);
    while (plan.levels < params.most_levels) {
        Plan finer = plan;
        float cost_of_finer = add_level(finer);
        if (cost_of_finer >= cost) break;
        plan = finer;
        cost = cost_of_finer;
    }
    return plan;
}

bool read_histograms() {
    lowest_bin = RADIUS_BINS;
    for (uint bin = 0u; bin < RADIUS_BINS; ++bin) {
        float pixels = float(status.radius_histogram[bin]);
        float photons = float(status.photon_histogram_high[bin]) * 4294967296.0 + float(status.photon_histogram[bin]);
        float radius = bin_radius(bin);
        pixels_of[bin] = pixels;
        density_of[bin] = pixels > 0.0 ? photons / (pixels * PI * radius * radius) : 0.0;
        if (pixels > 0.0) {
            lowest_bin = min(lowest_bin, bin);
            highest_bin = bin;
        }
    }
    return lowest_bin < RADIUS_BINS;
}

void main() {
    if (blocked(PASS_LEVELS) || invocation() != 0u) return;
    Plan plan;
    plan.levels = 1u;
    plan.cell[0] = params.radius_floor;
    if (launch.iteration > 0u) {
        if (read_histograms()) plan = best_plan();
        status.levels = plan.levels;
        if (plan.levels > params.grid_levels) {
            status.blocked |= PASS_LEVELS;
            return;
        }
        for (uint bin = 0u; bin < RADIUS_BINS; ++bin) {
            status.radius_histogram[bin] = status.photon_histogram[bin] = status.photon_histogram_high[bin] = 0u;
        }
    }
    grid.origin = params.bounds_low;
    grid.levels = plan.levels;
    grid.entries = 0u;
    for (uint level = 0u; level < GRID_LEVELS; ++level) {
        bool used = level < plan.levels;
        float cell = max(used ? plan.cell[level] : 0.0, least_cell());
        grid.cell[level] = cell;
        grid.inverse_cell[level] = 1.0 / cell;
        grid.reach[level] = level + 1u < plan.levels ? reach_of(cell, plan.cell[level + 1u]) : LARGEST_FLOAT;
        grid.dims[level] = uvec4(uvec3(dims_of(cell)), dense(cell, plan.levels) ? 0u : capacity_of(plan.levels) - 1u);
        grid.first[level] = grid.entries;
        if (used) grid.entries += entries_of(cell, plan.levels);
    }
}
