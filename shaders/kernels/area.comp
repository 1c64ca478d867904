#version 460
// How much of a pixel's disc is surface: one invocation a pixel that gathers. The density of photons is per area of the
// surface that they can land on. At the edge of a table, on a narrow board or in a corner that is a part of the disc,
// and divided by pi R^2 all of these come out dark. So random points of the disc are looked at along its normal,
// within the ball of R about the hit: a line that meets a surface which would accept photons (include/search.glsl)
// stands for 1 / cosine of area, another one for 0. With X that share, of which f is the mean, pi R^2 f is the area and
//   1 / f = 1 + (1 - X_1) + (1 - X_1)(1 - X_2) + ...,  X_i independent,
// which Russian roulette ends: an unbiased estimate of the reciprocal (of the geometric series; Booth, "Unbiased Monte
// Carlo estimation of the reciprocal of an integral", Nuclear Science and Engineering 156, 2007) that takes one line
// where all is flat, and is 1 there without noise. m lines leave out (1 - f)^(m + 1) / f of it; their number grows with
// the logarithm of the iteration, so that this vanishes, and that first discs, which are large and of which little may
// be surface, do not bring noise that lasts.
// Independent of photons and of earlier iterations: each hit has an estimate of its own, as a pixel at an edge sees
// several surfaces.
// Reads the scene, hits, pixels; writes PixelState::excess, and measures where one is unfinished. O(log triangles) a
// line. Fails by running out of steps: goes on next round, with the line begun again.
// A line may begin beyond the scene's bounds, by R at most: what it meets is as near as ever.
#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/measures.glsl"
#include "include/pixels.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/search.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

const uint MOST_MET_BY_LINE = 4u;  // surfaces that would not accept photons, before it is given up
const float MOST_SHARE = 1.9;      // of a line: the series has a sum below 2
const float BEYOND = 2e-6;         // the ball, frame units: rounding of the hit and of a line's begin
const uint FIRST_LINE_DIMENSION = 0x80000000u;  // of random numbers, one a line: beyond those of photons

// Of a disc, in that iteration.
uint most_lines(uint iteration) { return 1u + uint(findMSB(iteration + 1u)) / 3u; }

// Where photons would land as the photon pass stores them.
bool takes_photons(Hit hit, vec3 direction, inout Surface surface) {
    SurfaceMaterial material = material_at(hit, direction, surface);
    if (HAS_UNLIT && has(material, SURFACE_UNLIT)) return false;
    return gathers_light(bsdf_of(material, material.ior, surface.front));
}

// X of a line from `origin` against the normal; false where it is out of steps.
bool follow_line(vec3 origin, vec3 normal, float within, bool both_sides, inout int steps, inout uint rays,
                 out float share) {
    share = 0.0;
    for (uint met = 0u; met < MOST_MET_BY_LINE; ++met) {
        steps -= vertex_steps();
        Hit hit;
        uint found = trace(origin, -normal, Sought(within, NO_TRIANGLE, false), steps, hit);
        if (found == TRACE_UNFINISHED) return false;
        ++rays;
        if (found == TRACE_MISS) break;
        Surface surface = surface_at(hit, -normal);
        vec3 geometric = surface.geometric;
        if (agrees(geometric, normal, both_sides) && takes_photons(hit, -normal, surface)) {
            share = min(1.0 / dot(geometric, normal), MOST_SHARE);
            break;
        }
        within -= hit.t;
        origin = leave(surface, -normal);
    }
    return true;
}

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_AREA)) return;
    HitPosition hit = hit_position_at(pixel);
    if (!gathers(hit)) return;
    Measure measure = Measure(0.0, 1.0, 0u);
    if (launch.round > 0u) measure = load_measure(pixel);
    vec3 normal = unpack_direction(hit_weight_at(pixel).normal);
    float radius = sqrt(pixels_at(pixel).radius2);
    vec3 tangent, bitangent;
    tangents(normal, tangent, bitangent);
    int steps = int(params.step_budget);
    uint rays = 0u;
    uint most = most_lines(launch.iteration);
    while (measure.lines < most) {
        bool fresh = steps == int(params.step_budget);
        vec4 u = random4(params.seed, launch.iteration, STREAM_GATHER, picture_pixel(pixel),
                         FIRST_LINE_DIMENSION + measure.lines);
        vec2 place = radius * sample_disc(u.xy);
        float height = sqrt(max(0.0, radius * radius - dot(place, place))) + BEYOND;
        vec3 origin = hit.position + place.x * tangent + place.y * bitangent + height * normal;
        float share;
        if (!follow_line(origin, normal, 2.0 * height, gathers_both_sides(hit), steps, rays, share)) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_AREA);
            break;
        }
        float rest = 1.0 - share;
        bool goes_on = u.z < abs(rest);  // Russian roulette
        measure.term *= sign(rest);
        measure.excess += goes_on ? measure.term : 0.0;
        measure.lines = goes_on ? measure.lines + 1u : most;
    }
    store_measure(pixel, measure);
    pixels[pixel].excess = measure.excess;
    if (rays > 0u) count_rays(rays);
}
