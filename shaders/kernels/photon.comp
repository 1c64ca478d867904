#version 460
// Light paths, `photons_per_lane` for each lane. Where DEALS, the lanes of a SIMD group (subgroup) share theirs, and a
// lane takes the next one when its own ends, so that none is idle before all are taken. Which lane traces a path
// changes nothing: its photons are found by the path. One invocation a lane. Reads the scene and the lights; writes
// photons [lanes x capacity], photon_flux, how many photons a path has stored and where (counters), paths. O(paths x
// bounces x log triangles). Fails by running out of steps (goes on next round) or of slots (counts on without storing,
// reports the number needed).
// Where DEALS it is assumed, and Vulkan 1.2 does not promise, that lanes are together again at the head of the loop,
// else two would take one path; and that a later round runs the same lanes in the same subgroup, as each keeps what the
// subgroup takes next (PathState::next). So paths are dealt where the device promises the first, and where it is seen
// to hold (host/vk/policy.cpp); else no lane hangs on another.
#include "include/kernel.glsl"
#include "include/bounds.glsl"
#include "include/bsdf.glsl"
#include "include/counters.glsl"
#include "include/frame.glsl"
#include "include/light.glsl"
#include "include/path.glsl"
#include "include/photon_flux.glsl"
#include "include/rng.glsl"
#include "include/split.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

#define HAS_RANGES (HAS_POINT_LIGHTS || HAS_SPOT_LIGHTS)  // lights may have one

PHOTONS(STORES)
PHOTON_FLUX(STORES)
PATHS(UPDATES)
COUNTERS(STORES)

// Under shading normals scattering is not symmetric: the factor |wi.ns wo.ng| / |wi.ng wo.ns| of Veach 1997, section
// 5.3, keeps photons and eye paths consistent. `before`, `after`: directions of travel.
float shading_correction(Surface surface, vec3 before, vec3 after) {
    float cos_geometric = dot(after, surface.geometric);
    float cos_shading = dot(after, surface.normal);
    if (cos_geometric * cos_shading <= 0.0) return 0.0;
    return dot(before, surface.normal) * cos_geometric / (dot(before, surface.geometric) * cos_shading);
}

// What a light still reaches (PathState::near, negative) once its photon has gone `length`.
float shorter(float near, float length) { return -max(1e-30, -near - length); }

// Takes what the photon goes off its length; false where its light does not reach so far.
bool gets_there(inout PathState state, float length) {
    if (HAS_RANGES && state.near < 0.0 && (state.flags & PATH_DIRECT) != 0u) {
        bool there = length < -state.near;
        state.near = shorter(state.near, length);
        return there;
    }
    state.near = max(0.0, state.near - length);
    return true;
}

// Begins the path of the lane at a light.
void begin_light_path(inout PathState state) {
    uint kind = emit(random_words(params.seed, launch.iteration, STREAM_PHOTON, state.path, 0u),
                     random4(params.seed, launch.iteration, STREAM_PHOTON, state.path, 1u),
                     state.origin, state.direction, state.power, state.near);
    // Of no area, so that no eye path meets it.
    bool punctual = kind == LIGHT_POINT || kind == LIGHT_SPOT || kind == LIGHT_DIRECTIONAL;
    state.flags = PATH_OUTSIDE | PATH_DIRECT;
    state.media = NO_MEDIA;
    if (punctual) state.flags |= PATH_STRAIGHT;
    vec3 entry = enter_bounds(state.origin, state.direction);
    if (HAS_RANGES && state.near < 0.0) state.near = shorter(state.near, distance(state.origin, entry));
    state.origin = entry;
    state.power0 = largest(state.power);
}

// What the photon has met.
uint layer_of(uint flags) {
    if ((flags & PATH_DIRECT) != 0u) return LAYER_DIRECT;
    return (flags & PATH_SCATTERED) != 0u ? LAYER_REST : LAYER_CAUSTIC;
}

// Stores a photon at the surface, in the lane's next slot where there is one left.
void store_photon(inout PathState state, uint slot, Surface surface) {
    if (state.stored < params.photon_capacity) {
        photons[slot + state.stored] = Photon(surface.position, pack_direction(surface.geometric));
        vec3 power = state.power;
        bool all = (state.flags & (PATH_STRAIGHT | PATH_DIRECT)) == PATH_STRAIGHT;
        // Two conditions: their disjunction is a constant that the optimiser loses.
        if (HAS_ROUGH && HAS_PUNCTUAL_LIGHTS) power = set_brings_all(power, all);
        if (HAS_SPLIT) power = set_brings_all(power, all);
        if (HAS_SPLIT) power = set_first_rough(power, (state.flags & PATH_SCATTERED) == 0u);
        // Never both: a reference has no further channels.
        if (HAS_AOVS) power = set_layer(power, layer_of(state.flags));
        photon_flux[slot + state.stored] = PhotonFlux(power, pack_direction(-state.direction));
    }
    ++state.stored;
}

// Scatters the path by one lobe; false where it ends. u: where in the lobe, and in .x or .w which.
bool scatter(inout PathState state, Bsdf bsdf, Surface surface, vec4 u) {
    // In scenes without gloss no surface needs two numbers for its direction and a third for its lobe.
    float inverse_probability;
    LobeWeights lobes = lobes_of(bsdf, surface, -state.direction);
    uint lobe = choose_lobe(lobes, HAS_GLOSS ? u.w : u.x, inverse_probability);
    bool alive = lobe != LOBE_NONE;
    vec3 before = state.direction;
    float density;
    vec3 weight = sample_lobe(lobe, bsdf, surface, u.xy, false, state.direction, density);
    state.power *= weight * inverse_probability;
    bool lit_near = (state.flags & PATH_DIRECT) != 0u && state.near > 0.0;
    if (!passes_pane(bsdf, lobe)) state.flags &= ~PATH_DIRECT;
    if (density != DELTA) state.flags &= ~PATH_STRAIGHT;
    if (HAS_AOVS && density != DELTA) state.flags |= PATH_SCATTERED;
    state.flags = split_photon(state.flags, density, lit_near);
    alive = alive && !split_ends(state.flags);
    if (HAS_SMOOTH && density != DELTA) state.power *= shading_correction(surface, before, state.direction);
    pass_boundary(state.flags, state.media, bsdf, lobe, surface);
    if (!goes_straight(bsdf, lobe)) ++state.flags;
    return alive;
}

// Russian roulette: survivors carry as much as they started with, photons of nearly equal weight. u in [0, 1).
bool survives(inout PathState state, float u) {
    float survival = min(1.0, largest(state.power) / state.power0);
    state.power *= 1.0 / survival;
    return u < survival;
}

// What the path meets at a hit: a photon is stored where any may be gathered, and the path scatters. False where it
// ends there.
bool meet(inout PathState state, uint slot, Hit hit) {
    Surface surface = surface_at(hit, state.direction);
    SurfaceMaterial material = material_at(hit, state.direction, surface);
    if (HAS_VOLUME) state.power *= transmittance(state.flags, state.media, surface, hit.t);
    vec4 u = random4(params.seed, launch.iteration, STREAM_PHOTON, state.path, dimension_of(state.met, 1u) + 1u);
    Bsdf bsdf =
        bsdf_for_path(material, surface, STREAM_PHOTON, state.path, state.flags, state.media, state.power);
    if (HAS_UNLIT && has(material, SURFACE_UNLIT)) bsdf = black();
    // What is black reflects no photon to any eye. Where a surface is partly there the photon counts in full: it tells
    // how much light arrives, and the eye path has asked for the surface.
    if (!gets_there(state, hit.t)) return false;
    bool brings = brings_light(state.flags);
    if (HAS_DIRECT) brings = (state.flags & PATH_DIRECT) == 0u || state.near > 0.0;
    if (brings && gathers_light(bsdf)) store_photon(state, slot, surface);
    bool there = true;
    if (HAS_ALPHA) {
        float coverage = coverage_of(material);
        there = u.w < coverage;
        u.w /= coverage;  // uniform again where the surface is there
    }
    bool alive = true;
    if (there) alive = scatter(state, bsdf, surface, u);
    alive = alive && (state.flags & PATH_BOUNCES) < params.max_depth && state.met < MOST_MET;
    alive = alive && largest(state.power) > 0.0;
    if (alive) alive = survives(state, u.z);
    state.origin = leave(surface, state.direction);
    return alive;
}

// The path has ended: writes down its photons.
void end_light_path(inout PathState state, uint slot) {
    counters[PATH_COUNTS + state.path] = state.stored - state.begin;
    counters[PATH_SLOTS + state.path] = slot + state.begin;
    state.path = NO_PATH;
    state.met = 0u;
}

// Where the lane has no path: takes the next one, of its own or where DEALS of its subgroup's, up to `end`; false where
// there is none left.
bool take_path(inout PathState state, bool running, uint end) {
    bool wants = running && state.path == NO_PATH;
    uint taken = state.next;
    if (DEALS != 0u) {
        uvec4 wanting = subgroupBallot(wants);
        taken += subgroupBallotExclusiveBitCount(wanting);
        state.next += subgroupBallotBitCount(wanting);
    } else {
        state.next += uint(wants);
    }
    if (wants) {
        running = taken < end;
        state.path = running ? taken : NO_PATH;
        state.begin = state.stored;
    }
    return running;
}

void main() {
    uint lane = invocation();
    if (lane >= params.photon_lanes || blocked(PASS_PHOTON | PASS_CAPACITY)) return;
    // Not gl_SubgroupSize: a kernel may run with fewer lanes than the driver says of all.
    uint sharing = DEALS != 0u ? (gl_WorkGroupSize.x + gl_NumSubgroups - 1u) / gl_NumSubgroups : 1u;
    uint share = sharing * params.photons_per_lane;
    uint sharers = DEALS != 0u ? work_group() * gl_NumSubgroups + gl_SubgroupID : lane;
    uint first = min(sharers * share, params.photons);
    uint end = min(first + share, params.photons);

    PathState state;
    if (launch.round == 0u) {
        state = PathState(vec3(0.0), NO_PATH, vec3(0.0), PATH_OUTSIDE, vec3(0.0), 0u, 0.0, 0u, first, 0.0, 0u,
                          NO_MEDIA);
    } else {
        state = paths[lane];
    }
    uint slot = lane * params.photon_capacity;
    uint rays = 0u;
    int steps = int(params.step_budget);
    // Unless WAITS, lanes whose ray is done do not wait for the longest of the SIMD group: see traverse().
    Traversal traversal = no_traversal();
    bool running = true;
    bool fresh = true;     // the lane's ray has not begun
    bool first_ray = true; // it began with the whole budget
    while (lanes(running) > 0u) {
        running = take_path(state, running, end);
        if (running && fresh) {
            if (state.met == 0u) begin_light_path(state);
            traversal = begin_traversal(state.origin, state.direction, NEAREST);
            fresh = false;
        }
        traverse(traversal, steps, WAITS == 0u, running);
        uint found = found_by(traversal);
        if (running && found == TRACE_UNFINISHED && steps <= 0) {
            if (first_ray) atomicAdd(status.stuck, 1u);
            block_after(PASS_PHOTON);
            running = false;
            traversal.node = NO_NODE;
        }
        // No `continue`: lanes are promised to be together again behind a branch, not where a loop goes on.
        if (running && found != TRACE_UNFINISHED) {
            steps -= vertex_steps();
            first_ray = false;
            fresh = true;
            ++rays;
            ++state.met;
            // A photon that is no number would make one of every disc that it falls into.
            bool valid = finite(state.power) && finite(state.direction);
            if (!valid) atomicAdd(status.invalid, 1u);
            bool alive = found == TRACE_HIT && valid;
            if (alive) alive = meet(state, slot, traversal.hit);
            if (!alive) end_light_path(state, slot);
        }
    }
    paths[lane] = state;
    if (lane == 0u) counters[PHOTON_TOTAL] = 0u;  // the scan of the counts leaves the total here
    if (state.stored > params.photon_capacity) {
        atomicMax(status.capacity, state.stored);
        atomicOr(status.blocked, PASS_CAPACITY);
    }
    count_rays(rays);
}
