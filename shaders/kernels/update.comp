#version 460
// One invocation a pixel: adds the iteration's estimate to the film with the radius that gathered it, then lets the
// estimator decide the next radius. Reads hits, gathered; writes film, pixels, tally and, where launch.offset is 1,
// the histograms by radius from which the next grid is planned. O(rings x sectors).
// A contribution that is not finite is dropped and counted in status.invalid.
#include "include/kernel.glsl"
#include "include/hits.glsl"
#include "include/pixels.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/sum.glsl"
#include "estimators/estimator.glsl"

FILM(STORES)
FILM(WORD_RECORDS)

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(0u)) return;
    PixelState state = pixels_at(pixel);
    vec3 estimate = hit_emission_at(pixel).emission;
    bool diffuse = gathers(hit_position_at(pixel));
    Gathered sum = gathered_at(pixel);
    if (diffuse) {
        // L = W rho / pi * sum(power) / (pi R^2 J), the radius being that before this update.
        estimate += hit_weight_at(pixel).weight * sum.flux * (params.inverse_paths / (PI * state.radius2));
    }
    if (finite(estimate)) {
        Film f = film_at(pixel);
        add(f.sum, f.low, estimate);
        film[pixel] = f;
    } else {
        atomicAdd(status.invalid, 1u);
    }
    if (state.radius2 > 0.0) {
        if (diffuse) {
            ++state.seen;
            state.photons = add_saturated(state.photons, sum.count);
        }
        update(pixel, diffuse, diffuse ? sum.count : 0u, state);
        state.radius2 = max(state.radius2, RADIUS2_MIN);
        pixels[pixel] = state;
        if (launch.offset == 1u && diffuse) {
            int bin = int(floor(log2(state.radius2))) + 48;  // 2 (log2 R + 24)
            bin = clamp(bin, 0, RADIUS_BINS - 1);
            atomicAdd(status.radius_histogram[bin], 1u);
            uint before = atomicAdd(status.photon_histogram[bin], sum.count);
            if (before + sum.count < before) atomicAdd(status.photon_histogram_high[bin], 1u);
        }
    }
}
