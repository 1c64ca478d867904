#version 460
// One invocation a pixel: sums the photons in its disc with the radius in force before this iteration's photons were
// looked at, and bins them for the estimator. Reads hits, pixels, grid, sorted photons and their flux, in glossy scenes
// hit_surface and the scene, and with solids in solids eye_paths; writes gathered, tally or moments, cursors, and where
// asked for aovs, of which layers wait in eye_paths between rounds, and there what errors are estimated from.
// O(photons in the cells that the disc touches). Fails by running out of steps: goes on next round.
// In glossy scenes every photon is weighed by the BSDF for its direction, made from the surface of the hit again.
// Acceptance: |y - x| < R strictly (appm looks further for its derivative), and the photon's geometric normal agrees
// with the pixel's shading normal, both on the side they were seen from; the distance is that in space, the kernel is
// 1 / (pi R^2), but for appm's.
#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/colour.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/layers.glsl"
#include "include/path.glsl"
#include "include/photon_flux.glsl"
#include "include/pixels.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/search.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "estimators/estimator.glsl"

EYE_PATHS(UPDATES)
SORTED_FLUX(RECORDS)

// By which what arrives is divided, at least: photons at grazing angles would count for any number of others.
#define LEAST_COSINE 0.01

// A pixel that gathers.
struct Receiver {
    uint pixel;
    vec3 position;
    vec3 normal;
    bool both_sides;
    float radius2;
    float inverse_radius;
    vec3 tangent;      // over R: offsets by them are those in the unit disc
    vec3 bitangent;
    float reach2;      // squared distance up to which photons are looked at
    vec3 weight;       // of what arrives, where errors are asked for
    float per_surface; // area of the disc over that of the surface in it
    // In glossy scenes the surface that the eye path ended on, as it met it.
    Surface surface;
    Bsdf bsdf;
    vec3 outgoing;
};

// Makes the surface of the hit again.
void remake_surface(inout Receiver r) {
    HitSurface record = hit_surface_at(r.pixel);
    r.outgoing = unpack_direction(record.outgoing);
    Hit hit = Hit(0.0, record.triangle, record.barycentric, instance_of_hit(r.pixel));
    r.surface = surface_at(hit, -r.outgoing);
    SurfaceMaterial material = material_at(hit, -r.outgoing, r.surface);
    uint flags = HAS_NESTED ? eye_paths[r.pixel].flags : PATH_OUTSIDE;
    uvec2 media = HAS_NESTED ? eye_paths[r.pixel].media : NO_MEDIA;
    vec3 weight = vec3(1.0);
    r.bsdf = bsdf_for_path(material, r.surface, STREAM_EYE, picture_pixel(r.pixel), flags, media, weight);
}

Receiver receiver_of(uint pixel, HitPosition hit) {
    Receiver r;
    r.pixel = pixel;
    r.position = hit.position;
    HitWeight seen = hit_weight_at(pixel);
    r.normal = unpack_direction(seen.normal);
    r.weight = seen.weight;
    r.both_sides = gathers_both_sides(hit);
    PixelState state = pixels_at(pixel);
    r.radius2 = state.radius2;
    r.per_surface = disc_per_surface(state);
    r.inverse_radius = inversesqrt(r.radius2);
    tangents(r.normal, r.tangent, r.bitangent);
    r.tangent *= r.inverse_radius;
    r.bitangent *= r.inverse_radius;
    if (HAS_GLOSS) remake_surface(r);
    return r;
}

// True where the surface is the first that is not perfectly smooth: photons there have the layers that they say.
bool is_first_seen(uint pixel) { return !HAS_ROUGH || (eye_paths[pixel].flags & PATH_STRAIGHT) != 0u; }

// Of the weighted flux's luminance what is bias, where errors are asked for: by the sums with the same kernel of half
// and of a quarter of the area. host/render/error_estimate.h says how.
float bias = 0.0;
const float INNER_BIAS = 2.0 + sqrt(2.0);

vec3 layer_flux[LAYERS] = vec3[](vec3(0.0), vec3(0.0));  // parts of the sum, where there are further channels

// Weighs an accepted photon: adds it to the sum and to what the estimator keeps.
void weigh(Receiver r, uint index, inout Gathered sum) {
    Photon photon = sorted_at(index);
    PhotonFlux flux = sorted_flux_at(index);
    vec3 offset = photon.position - r.position;
    float squared = dot(offset, offset);
    vec3 power = power_of(flux);
    vec3 towards = unpack_direction(flux.direction);
    if (HAS_SMOOTH) {
        // Photons arrive per area of the true surface, the BRDF is that of the shaded one.
        vec3 geometric = unpack_direction(photon.normal);
        float cos_shading = dot(towards, r.normal);
        power *= max(0.0, r.both_sides ? abs(cos_shading) : cos_shading) / max(LEAST_COSINE, dot(towards, geometric));
    }
    if (HAS_GLOSS) {
        power *= PI * rough_bsdf(r.bsdf, r.surface, r.outgoing, towards, brings_all(flux) ? PART_ALL : PART_GATHERED);
    }
    bool inside = squared < r.radius2;
    float q = squared * r.inverse_radius * r.inverse_radius;
    vec3 counted = inside ? power * photon_weight(q, is_first_rough(flux)) : vec3(0.0);
    add_corrected(sum.flux, sum.excess, counted);
    if (HAS_ERRORS && inside) {
        bool first = is_first_rough(flux);
        float half_area = q < 0.5 ? 2.0 * photon_weight(2.0 * q, first) : 0.0;
        float quarter = q < 0.25 ? 4.0 * photon_weight(4.0 * q, first) : 0.0;
        vec3 limit = power * (half_area - INNER_BIAS * (half_area - quarter));
        bias += luminance(r.weight * (r.per_surface * counted - limit));
    }
    if (HAS_AOVS) {
        uint layer = layer_of(flux);
        if (layer < LAYERS) layer_flux[layer] += counted;
    }
    sum.count += inside ? 1u : 0u;
    keep(r.pixel, Accepted(vec2(dot(offset, r.tangent), dot(offset, r.bitangent)), q, power, index), inside);
}

// Runs of at most 32 photons that wait to be weighed, those accepted marked in a word. The test of the distance takes
// all lanes through all photons of the cells, of which it accepts a third; weighing them apart takes each lane through
// its own alone. That is most of the work where photons are weighed by a BSDF.
#define QUEUE 16u
uvec2 queue[QUEUE + 1u];  // first photon, marks; one more, for a store of nothing when it is full

// Tests the next photons of the segment, at most 32; returns the run of them.
uvec2 mark_accepted(Receiver r, GridLevel level, inout Walk walk, inout int steps) {
    uvec2 run = uvec2(walk.first, 0u);
    // Left at its end, for software Vulkan runs the body of a loop once more where it is left at its start. There,
    // lanes that have left go through the rest of the trips with what they had: the body makes the same of it.
    uint bit = walk.first < walk.last ? 1u : 0u;
    do {
        Photon photon = sorted_at(bit != 0u ? walk.first : 0u);
        float squared;
        run.y |= accepts(level, walk, photon, r.position, r.reach2, r.normal, r.both_sides, squared) ? bit : 0u;
        walk.first += uint(bit != 0u);
        steps -= int(bit != 0u);
        bit <<= 1u;
    } while (bit != 0u && walk.first < walk.last && steps > 0);
    return run;
}

// Weighs the photons that are marked in the queue.
void weigh_queue(Receiver r, uint queued, inout Gathered sum, inout int steps) {
    uvec2 run = uvec2(0u);
    for (uint taken = 0u; run.y != 0u || taken < queued;) {
        uvec2 next = queue[taken];
        bool ended = run.y == 0u;
        run = ended ? next : run;
        taken += uint(ended);
        uint index = run.x + uint(findLSB(run.y));
        run.y &= run.y - 1u;
        weigh(r, index, sum);
        --steps;
    }
}

// Photons in a disc at the density of those in the cells about it: what the plan of the grid is to reckon with, at
// least, for the disc itself may be empty where light falls beside it.
uint per_disc(uint tested, float radius2, GridLevel level) {
    float across = 2.0 * sqrt(radius2) + 1.0 / level.inverse_cell;
    return uint(ceil(float(tested) * PI * radius2 / (across * across)));
}

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_GATHER)) return;
    Cursor cursor = Cursor(uvec3(CURSOR_START), 0u);
    Gathered sum = Gathered(vec3(0.0), 0u, vec3(0.0), 0u);
    HitPosition hit = hit_position_at(pixel);
    if (!gathers(hit)) {
        gathered[pixel] = sum;
        return;
    }
    if (launch.round > 0u) {
        cursor = cursors[pixel];
        if (cursor.cell.x == CURSOR_DONE) return;
        sum = gathered_at(pixel);
        if (HAS_AOVS) layer_flux = eye_paths[pixel].layer;
        if (HAS_ERRORS) bias = eye_paths[pixel].bias;
    }
    Receiver r = receiver_of(pixel, hit);

    begin(pixel);
    int steps = int(params.step_budget);
    r.reach2 = search_radius2(pixel, r.radius2);
    CellBox box = cell_box(level_for(sqrt(r.reach2)), r.position, sqrt(r.reach2));
    Walk walk;
    while (!walked(cursor, box) && steps > 0) {
        uint queued = 0u;
        FOR_SEGMENTS(box, cursor, walk, steps, queued < QUEUE, {
            uint tested = walk.first;
            uvec2 run = mark_accepted(r, box.level, walk, steps);
            sum.tested += walk.first - tested;
            // A store by all lanes: a branch for each would guess wrong.
            queue[queued] = run;
            queued += uint(run.y != 0u);
        })
        weigh_queue(r, queued, sum, steps);
    }
    flush(pixel);
    if (HAS_ERRORS) eye_paths[pixel].bias = bias;
    if (HAS_AOVS) {
        // As the update pass does with all; between rounds they wait with the eye path, which has ended.
        if (!walked(cursor, box)) {
            eye_paths[pixel].layer = layer_flux;
        } else if (is_first_seen(pixel)) {
            vec3 factor = hit_weight_at(pixel).weight * (params.inverse_paths * r.per_surface / (PI * r.radius2));
            for (uint i = 0u; i < LAYERS; ++i) layer_flux[i] *= factor;
            add_layers(pixel, layer_flux);
        }
    }
    if (walked(cursor, box)) {
        cursor.cell.x = CURSOR_DONE;
        sum.tested = max(sum.count, per_disc(sum.tested, r.radius2, box.level));
    } else {
        block_after(PASS_GATHER);
    }
    gathered[pixel] = sum;
    cursors[pixel] = cursor;
}
