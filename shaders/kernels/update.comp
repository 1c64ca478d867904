#version 460
// One invocation a pixel: adds the iteration's estimate to the film with the radius that gathered it, then lets the
// estimator decide the next radius, but where radii are the host's. Reads hits, gathered; writes film, pixels, tally or
// moments, where errors are asked for (eye_paths has a part of them) errors, and, before the grid is planned anew, the
// histograms by radius that its plan is made from. O(rings x sectors).
// Cannot fail: a contribution that is not finite is dropped and counted in status.invalid.
#include "include/kernel.glsl"
#include "include/error_groups.glsl"
#include "include/hits.glsl"
#include "include/pixels.glsl"
#include "include/radius_bins.glsl"
#include "include/sampling.glsl"
#include "include/sum.glsl"
#include "estimators/estimator.glsl"

EYE_PATHS(READS)
FILM(STORES)
FILM(WORD_RECORDS)

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(0u)) return;
    PixelState state = pixels_at(pixel);
    vec3 estimate = hit_emission_at(pixel).emission;
    bool diffuse = gathers(hit_position_at(pixel));
    Gathered sum = gathered_at(pixel);
    float bias = 0.0;
    if (diffuse) {
        // L = W rho / pi * sum(power) / (A J), A = pi R^2 or the area of the surface in it; R as before this update.
        float inverse = params.inverse_paths / (PI * state.radius2);
        estimate += hit_weight_at(pixel).weight * sum.flux * (inverse * disc_per_surface(state));
        if (HAS_ERRORS) bias = eye_paths[pixel].bias * inverse;
    }
    if (HAS_ERRORS) add_to_group(pixel, estimate, bias);
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
        if (params.keeps_radii == 0u) update(pixel, diffuse, diffuse ? sum.count : 0u, state);
        state.radius2 = max(state.radius2, RADIUS2_MIN);
        pixels[pixel] = state;
        if (launch.plans_next == 1u && diffuse) {
            int bin = radius_bin(state.radius2);
            atomicAdd(status.radius_histogram[bin], 1u);
            uint before = atomicAdd(status.photon_histogram[bin], sum.tested);
            if (before + sum.tested < before) atomicAdd(status.photon_histogram_high[bin], 1u);
        }
    }
}
