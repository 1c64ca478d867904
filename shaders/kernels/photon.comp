#version 460
// The lanes of a SIMD group share light paths, `photons_per_lane` for each of them: a lane takes the next one when its
// own ends, so that none is idle before all are taken. Which lane traces a path changes nothing: its photons are found
// by the path. Reads the scene and the lights; writes photons [lanes x capacity], photon_flux, how many photons a path
// has stored and where (counters), paths. O(paths x bounces x log triangles). Fails by running out of steps (goes on
// next round) or of slots (counts on without storing, reports the number needed).
#include "include/kernel.glsl"
#include "include/bounds.glsl"
#include "include/bsdf.glsl"
#include "include/counters.glsl"
#include "include/frame.glsl"
#include "include/light.glsl"
#include "include/path.glsl"
#include "include/rng.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

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

void main() {
    uint lane = invocation();
    if (lane >= params.photon_lanes || blocked(PASS_PHOTON | PASS_CAPACITY)) return;
    uint share = gl_SubgroupSize * params.photons_per_lane;
    uint first = min((work_group() * gl_NumSubgroups + gl_SubgroupID) * share, params.photons);
    uint end = min(first + share, params.photons);

    PathState state;
    if (launch.round == 0u) {
        state = PathState(vec3(0.0), NO_PATH, vec3(0.0), PATH_OUTSIDE, vec3(0.0), 0u, 0.0, 0u, first);
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
        bool wants = running && state.path == NO_PATH;
        uvec4 wanting = subgroupBallot(wants);
        uint taken = state.next + subgroupBallotExclusiveBitCount(wanting);
        state.next += subgroupBallotBitCount(wanting);
        if (wants) {
            running = taken < end;
            state.path = running ? taken : NO_PATH;
            state.begin = state.stored;
        }
        uint path = state.path;
        if (running && fresh) {
            if ((state.memory & PATH_BOUNCES) == 0u) {
                uint kind = emit(random_words(params.seed, launch.iteration, STREAM_PHOTON, path, 0u),
                                 random4(params.seed, launch.iteration, STREAM_PHOTON, path, 1u),
                                 state.origin, state.direction, state.power);
                // Of no area, so that no eye path meets it.
                bool punctual = kind == LIGHT_POINT || kind == LIGHT_SPOT || kind == LIGHT_DIRECTIONAL;
                state.memory = PATH_OUTSIDE;
                if (punctual) state.memory |= PATH_STRAIGHT;
                if (kind != LIGHT_ENVIRONMENT) state.memory |= PATH_DIRECT;
                state.origin = enter_bounds(state.origin, state.direction);
                state.power0 = largest(state.power);
            }
            traversal = begin_traversal(state.origin, state.direction);
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
        if (!running || found == TRACE_UNFINISHED) continue;
        --steps;
        first_ray = false;
        fresh = true;
        Hit hit = traversal.hit;
        ++rays;
        ++state.memory;
        uint bounces = state.memory & PATH_BOUNCES;
        // A photon that is no number would make one of every disc that it falls into.
        bool valid = finite(state.power) && finite(state.direction);
        if (!valid) atomicAdd(status.invalid, 1u);
        bool alive = found == TRACE_HIT && valid;
        if (alive) {
            Surface surface = surface_at(hit, state.direction);
            SurfaceMaterial material = material_at(hit, state.direction, surface);
            if (HAS_VOLUME) state.power *= transmittance(state.memory, surface, hit.t);
            vec4 u = random4(params.seed, launch.iteration, STREAM_PHOTON, path, bounces + 1u);
            float ior = index_for_path(material, STREAM_PHOTON, path, state.memory, state.power);
            Bsdf bsdf = bsdf_of(material, ior, surface.front);
            if (HAS_UNLIT && has(material, SURFACE_UNLIT)) bsdf = black();
            // What is black reflects no photon to any eye. Where a surface is partly there the photon counts in full:
            // it tells how much light arrives, and the eye path has asked for the surface.
            // Where light is split, the rest is left to paths.
            bool counts = !HAS_SPLIT || (state.memory & PATH_CAUSTIC) != 0u;
            if (counts && gathers_light(bsdf)) {
                if (state.stored < params.photon_capacity) {
                    photons[slot + state.stored] = Photon(surface.position, pack_direction(surface.geometric));
                    vec3 power = state.power;
                    // Two conditions: their disjunction is a constant that the optimiser loses.
                    bool all = (state.memory & (PATH_STRAIGHT | PATH_DIRECT)) == PATH_STRAIGHT;
                    uint red = floatBitsToUint(power.r) | (all ? 0x80000000u : 0u);
                    bool asked_for = HAS_ROUGH && HAS_PUNCTUAL_LIGHTS;
                    if (asked_for) power.r = uintBitsToFloat(red);
                    if (HAS_SPLIT) power.r = uintBitsToFloat(red);
                    if (HAS_SPLIT && (state.memory & PATH_SCATTERED) == 0u) {
                        power.g = uintBitsToFloat(floatBitsToUint(power.g) | 0x80000000u);
                    }
                    photon_flux[slot + state.stored] = PhotonFlux(power, pack_direction(-state.direction));
                }
                ++state.stored;
            }
            bool there = true;
            if (HAS_ALPHA) {
                float coverage = coverage_of(material);
                there = u.w < coverage;
                u.w /= coverage;  // uniform again where the surface is there
            }
            if (there) {
                // In scenes without gloss no surface needs two numbers for its direction and a third for its lobe.
                float inverse_probability;
                LobeWeights lobes = lobes_of(bsdf, surface, -state.direction);
                uint lobe = choose_lobe(lobes, HAS_GLOSS ? u.w : u.x, inverse_probability);
                alive = lobe != LOBE_NONE;
                vec3 before = state.direction;
                float density;
                vec3 weight = sample_lobe(lobe, bsdf, surface, u.xy, false, state.direction, density);
                state.power *= weight * inverse_probability;
                bool near = (state.memory & (PATH_STRAIGHT | PATH_DIRECT)) == PATH_DIRECT && hit.t < params.near_lights;
                state.memory &= ~PATH_DIRECT;
                if (density != DELTA) state.memory &= ~PATH_STRAIGHT;
                if (HAS_SPLIT) {
                    if (density == DELTA) {
                        state.memory |= PATH_CAUSTIC;
                    } else if (near) {
                        // As a light of its own, which eye paths do not find.
                        state.memory |= PATH_CAUSTIC | PATH_STRAIGHT;
                    } else {
                        state.memory |= PATH_SCATTERED;
                    }
                    alive = alive && (state.memory & PATH_CAUSTIC) != 0u;
                }
                if (HAS_SMOOTH && density != DELTA) {
                    state.power *= shading_correction(surface, before, state.direction);
                }
                state.memory = pass_boundary(state.memory, bsdf, lobe, surface);
            }
            float brightest = largest(state.power);
            alive = alive && bounces < params.max_depth && brightest > 0.0;
            if (alive) {
                // Survivors carry as much as they started with: photons of nearly equal weight.
                float survival = min(1.0, brightest / state.power0);
                alive = u.z < survival;
                state.power *= 1.0 / survival;
            }
            state.origin = leave(surface, state.direction);
        }
        if (!alive) {
            counters[PATH_COUNTS + path] = state.stored - state.begin;
            counters[PATH_SLOTS + path] = slot + state.begin;
            state.path = NO_PATH;
            state.memory = PATH_OUTSIDE;
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
