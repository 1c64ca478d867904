#version 460
// One invocation a lane of `photons_per_lane` light paths; the next path starts when the lane's path ends, so that a
// SIMD group stays full. Reads the scene and the lights; writes photons [lanes x capacity], photon_flux, the
// photons stored a lane (counters), paths. O(paths x bounces x log triangles). Fails by running out of steps (goes on next round) or
// of slots (counts on without storing, reports the number needed).
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/specular.glsl"
#include "include/bounds.glsl"
#include "include/light.glsl"
#include "include/counters.glsl"

layout(binding = BIND_PHOTONS, scalar) writeonly buffer PhotonBlock { Photon photons[]; };
layout(binding = BIND_PHOTON_FLUX, scalar) writeonly buffer FluxBlock { PhotonFlux photon_flux[]; };
layout(binding = BIND_PATHS, scalar) buffer PathBlock { PathState paths[]; };
layout(binding = BIND_COUNTERS, scalar) writeonly buffer CounterBlock { uint counters[]; };

#define FIRST_ROULETTE 4u  // bounce from which Russian roulette decides whether a path goes on

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Throughput of a diffuse bounce; sets the direction. Under shading normals the adjoint is not symmetric: the factor
// |wi.ns wo.ng| / |wi.ng wo.ns| of Veach 1997, section 5.3, keeps photons and eye paths consistent.
vec3 scatter_diffuse(SurfaceMaterial material, Surface surface, vec2 u, inout vec3 direction) {
    vec3 outgoing = normalize(from_frame(surface.normal, sample_cosine(u)));
    float correction = 1.0;
    if ((FEATURES & FEATURE_SMOOTH_DIFFUSE) != 0u) {
        float cos_geometric = dot(outgoing, surface.geometric);
        float cos_shading = dot(outgoing, surface.normal);
        correction = cos_geometric <= 0.0 || cos_shading <= 0.0
                         ? 0.0
                         : dot(direction, surface.normal) * cos_geometric /
                               (dot(direction, surface.geometric) * cos_shading);
    }
    direction = outgoing;
    return material.color * correction;
}

void main() {
    uint lane = invocation();
    if (lane >= params.photon_lanes || blocked(PASS_PHOTON | PASS_CAPACITY)) return;
    uint first = lane * params.photons_per_lane;
    uint count = min(params.photons_per_lane, params.photons - first);

    PathState state;
    if (launch.round == 0u) {
        state = PathState(vec3(0.0), 0u, vec3(0.0), 0u, vec3(0.0), 0u, 0.0);
    } else {
        state = paths[lane];
        if (state.path >= count) return;
    }
    uint slot = lane * params.photon_capacity;
    uint rays = 0u;
    int steps = int(params.step_budget);
    while (state.path < count) {
        --steps;
        if (steps < 0) {
            block_after(PASS_PHOTON);
            break;
        }
        uint path = first + state.path;
        if (state.bounce == 0u) {
            emit(random4(params.seed, launch.iteration, STREAM_PHOTON, path, 0u),
                 random4(params.seed, launch.iteration, STREAM_PHOTON, path, 1u),
                 state.origin, state.direction, state.power);
            state.origin = enter_bounds(state.origin, state.direction);
            state.power0 = largest(state.power);
        }
        bool fresh = steps + 1 == int(params.step_budget);
        Hit hit;
        uint found = trace(state.origin, state.direction, steps, hit);
        if (found == TRACE_UNFINISHED) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_PHOTON);
            break;
        }
        ++rays;
        ++state.bounce;
        bool alive = found == TRACE_HIT;
        if (alive) {
            Surface surface = surface_at(hit, state.direction);
            SurfaceMaterial material = material_at(surface.material);
            vec4 u = random4(params.seed, launch.iteration, STREAM_PHOTON, path, state.bounce + 1u);
            if (kind_of(material) == SURFACE_DIFFUSE) {
                alive = largest(material.color) > 0.0;  // what is black reflects no photon to any eye
                if (alive) {
                    if (state.stored < params.photon_capacity) {
                        photons[slot + state.stored] = Photon(surface.position, pack_direction(surface.geometric));
                        photon_flux[slot + state.stored] =
                            PhotonFlux(state.power, pack_direction(-state.direction));
                    }
                    ++state.stored;
                    state.power *= scatter_diffuse(material, surface, u.xy, state.direction);
                }
            } else if ((FEATURES & (FEATURE_MIRROR | FEATURE_DIELECTRIC)) != 0u) {
                state.power *= scatter_specular(material, surface, u.x, false, state.direction);
            }
            float brightest = largest(state.power);
            alive = alive && state.bounce < params.max_depth && brightest > 0.0;
            if (alive && state.bounce >= FIRST_ROULETTE) {
                // Survivors carry as much as they started with: photons of nearly equal weight.
                float survival = min(1.0, brightest / state.power0);
                alive = u.z < survival;
                state.power *= 1.0 / survival;
            }
            state.origin = leave(surface, state.direction);
        }
        if (!alive) {
            ++state.path;
            state.bounce = 0u;
        }
    }
    paths[lane] = state;
    counters[LANE_COUNTS + lane] = min(state.stored, params.photon_capacity);
    if (lane == 0u) counters[PHOTON_TOTAL] = 0u;  // the scan of the counts leaves the total here
    if (state.stored > params.photon_capacity) {
        atomicMax(status.capacity, state.stored);
        atomicOr(status.blocked, PASS_CAPACITY);
    }
    atomicAdd(status.rays, rays);
}
