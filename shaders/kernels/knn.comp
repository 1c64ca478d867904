#version 460
// Starting radii: one invocation a pixel that sees a diffuse surface and has no seeded radius yet, in any order. Its
// squared radius becomes the squared distance of the k-th nearest accepted photon of this iteration; strict < in the
// gather then leaves k - 1 inside, which makes (k - 1) / (pi R^2) unbiased. With fewer than k photons within the
// largest radius it keeps that one and tries again next iteration: the estimate truncated there is unbiased too.
// Reads searches, hits, grid, sorted photons; writes pixels, tally or moments, nearest, cursors and, of a search that
// goes on next round, search_states.
// O(photons in the cells met + k per replacement). Fails by running out of steps: goes on next round.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/pixels.glsl"
#include "include/search.glsl"
#include "include/split.glsl"
#include "estimators/estimator.glsl"

SEARCHES(READS)
NEAREST(UPDATES)
SEARCH_STATES(UPDATES)

SearchState new_search(float radius) { return SearchState(-1.0, 0u, radius, 0u); }

// Keeps the k smallest squared distances; returns the loop trips it took.
int keep(inout SearchState search, float squared, uint pixel) {
    uint place = search.kept < params.knn ? search.kept : search.largest_index;
    if (search.kept == params.knn && squared >= search.largest) return 0;
    nearest[place * pixel_count() + pixel] = squared;
    if (search.kept < params.knn) ++search.kept;
    if (search.kept < params.knn) return 0;
    search.largest = -1.0;
    for (uint i = 0u; i < params.knn; ++i) {
        float value = nearest[i * pixel_count() + pixel];
        if (value > search.largest) {
            search.largest = value;
            search.largest_index = i;
        }
    }
    return int(params.knn);
}

void main() {
    if (invocation() >= min(status.searches, pixel_count()) || blocked(PASS_KNN)) return;
    uint pixel = searches[invocation()];

    // The largest radius: bounded by the pixel's footprint, but not below a disc of k photons at mean density.
    float cap = sqrt(pixels_at(pixel).radius2);
    SearchState search;
    Cursor cursor = Cursor(uvec3(CURSOR_START), 0u);
    if (launch.round == 0u) {
        bool first = cap == 0.0;
        if (first) {
            float footprint = hit_emission_at(pixel).footprint;
            cap = min(params.radius_cap, max(params.radius_floor, params.footprint_cap * footprint));
            if (HAS_SPLIT) {
                cap = split_radius(footprint);
                pixels[pixel].seeded = 1u;
            }
            pixels[pixel].radius2 = cap * cap;
        }
        if (HAS_SPLIT) return;
        // A pixel that failed before will hardly find k photons nearby: it looks through its whole disc at once.
        search = new_search(first ? min(cap, grid.cell[0]) : cap);
    } else {
        cursor = cursors[pixel];
        if (cursor.cell.x == CURSOR_DONE) return;
        search = search_states[pixel];
    }

    HitPosition hit = hit_position_at(pixel);
    vec3 position = hit.position;
    vec3 normal = unpack_direction(hit_weight_at(pixel).normal);
    bool both_sides = gathers_both_sides(hit);
    int steps = int(params.step_budget);
    CellBox box;
    Walk walk;
    // Out of steps at its head as well as by the break: of a loop with one exit, a break that lanes take on different
    // trips, Mesa 22.3.6 leaves every lane with the values of the last trip, its own or not.
    while (steps > 0) {
        box = cell_box(level_for(search.radius), position, search.radius);
        float reach2 = search.radius * search.radius;
        FOR_SEGMENTS(box, cursor, walk, steps, true, {
            for (; walk.first < walk.last && steps > 0; ++walk.first, --steps) {
                Photon photon = sorted_at(walk.first);
                float squared;
                if (accepts(box.level, walk, photon, position, reach2, normal, both_sides, squared)) {
                    steps -= keep(search, squared, pixel);
                }
            }
        })
        if (!walked(cursor, box) || search.kept == params.knn || search.radius >= cap) break;
        search = new_search(min(cap, 2.0 * search.radius));
        cursor = Cursor(uvec3(CURSOR_START), 0u);
    }
    if (!walked(cursor, box)) {
        block_after(PASS_KNN);
        cursors[pixel] = cursor;
        search_states[pixel] = search;
        return;
    }
    if (search.kept == params.knn) {
        // What was counted with the largest radius says nothing about this one. Of what this invocation has stored
        // above, which texels need not show, nothing is used.
        PixelState state = pixels_at(pixel);
        state.radius2 = max(search.largest, RADIUS2_MIN);
        state.radius2_low = 0.0;
        state.seeded = 1u;
        state.total = 0u;
        state.count = 0.0;
        state.count_low = 0.0;
        clear_statistics(pixel);
        pixels[pixel] = state;
    }
    cursors[pixel].cell.x = CURSOR_DONE;
}
