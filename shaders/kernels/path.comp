#version 460
// The path tracer: one invocation a pixel, launch.paths paths of it one after the other, so that a SIMD group
// (subgroup) stays full. Unbiased: every vertex with a lobe of width above 0 asks for one point of each group of
// lights (next-event estimation), and what the next ray meets counts too (BSDF sampling); both are weighed by the power
// heuristic (multiple importance sampling; Veach 1997, section 9.2.4), punctual lights are asked for alone. Russian
// roulette ends paths that bring little. A ray to a light is stopped by glass. Where light is split (FEATURE_SPLIT)
// what photons bring is left out; else light of punctual lights by way of delta lobes is missing, which no path finds.
// Reads the scene and the lights; writes image [P], the mean of the launch's paths, and traces. O(paths x bounces x log
// triangles). Fails by running out of steps: goes on next round.
#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/camera.glsl"
#include "include/environment.glsl"
#include "include/light.glsl"
#include "include/light_ray.glsl"
#include "include/path.glsl"
#include "include/rng.glsl"
#include "include/split.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

TRACES(UPDATES)
IMAGE(STORES)

#define FIRST_ROULETTE 4u      // bounce from which Russian roulette decides whether a path goes on
#define FIRST_DIMENSION 16u    // of random numbers, beyond the stratified ones; three a bounce
#define GROUP_DIMENSIONS 4096u //   of a group of lights, beyond them

TraceState new_path(uint done, vec3 sum) {
    return TraceState(vec3(0.0), flags_at_eye(), vec3(0.0), DELTA, vec3(1.0), 0.0, vec3(0.0), done, sum, 0u,
                      no_light_rays(), 0u, media_at_eye());
}

float power_heuristic(float density, float other) {
    return density * density / (density * density + other * other);
}

// The weight of light that a ray of the path meets, where it is drawn with `light_density` too.
float met_weight(TraceState state, float light_density) {
    if (state.density != DELTA) return power_heuristic(state.density, light_density);
    return photons_bring_met(state.flags) ? 0.0 : 1.0;
}

// What an emitter sends along the ray that met it, weighed.
vec3 met_emission(TraceState state, uint triangle, Surface surface, SurfaceMaterial material) {
    bool double_sided = has(material, SURFACE_DOUBLE_SIDED);
    if (material.emission == vec3(0.0) || !(surface.front || double_sided)) return vec3(0.0);
    if (photons_bring_emission(state.flags, state.distance)) return vec3(0.0);
    return met_radiance(material, surface, state.direction) *
           met_weight(state, met_density(triangle, material, surface, state.direction, state.distance).density);
}

// Asks for a point of the lights of each group, weighed against meeting it. dimension: of the bounce.
void ask_for_light(inout TraceState state, Bsdf bsdf, Surface surface, LobeWeights lobes, uint pixel, uint path,
                   uint dimension) {
    vec3 wo = -state.direction;
    for (uint g = 0u; g < GROUPS; ++g) {
        AskedGroup group = params.asked[g];
        if (group.count == 0u) continue;
        uint own = dimension + g * GROUP_DIMENSIONS;
        uvec4 bits = random_words(params.seed, path, STREAM_PATH, pixel, own);
        vec4 v = random4(params.seed, path, STREAM_PATH, pixel, own + 2u);
        LightSample light = sample_light(group, bits.zw, v.xy, surface.position);
        if (photons_bring_asked(state.flags, light.triangle, light.distance)) continue;
        vec3 factor = light.radiance * rough_bsdf(bsdf, surface, wo, light.direction, PART_ALL);
        factor *= abs(dot(light.direction, surface.normal));
        if (light.density > 0.0) {
            factor *= power_heuristic(light.density, scatter_density(bsdf, surface, lobes, wo, light.direction));
        }
        factor *= transmittance_to(light, state.flags, state.media, bsdf, surface);
        state.light_rays.of[g] = ray_to(light, state.throughput * factor, LAYER_REST, surface);
    }
}

// Scatters the path: sets its direction, its density and its throughput; false where it ends.
bool scatter(inout TraceState state, Bsdf bsdf, Surface surface, LobeWeights lobes, vec4 u) {
    float inverse_probability;
    uint lobe = choose_lobe(lobes, u.w, inverse_probability);
    if (lobe == LOBE_NONE) return false;
    vec3 wo = -state.direction;
    vec3 weight = inverse_probability * sample_lobe(lobe, bsdf, surface, u.xy, true, state.direction, state.density);
    if (state.density != DELTA && weight != vec3(0.0)) {
        // The direction stands for all lobes that could have given it.
        state.density = scatter_density(bsdf, surface, lobes, wo, state.direction);
        weight = rough_bsdf(bsdf, surface, wo, state.direction, PART_ALL) *
                 (abs(dot(state.direction, surface.normal)) / state.density);
    }
    state.throughput *= weight;
    state.flags = leave_lobe(split_path(state.flags, state.density), state.density);
    pass_boundary(state.flags, state.media, bsdf, lobe, surface);
    if (!goes_straight(bsdf, lobe)) ++state.flags;
    return any(greaterThan(state.throughput, vec3(0.0)));
}

// A ray of the path that leaves the scene.
void meet_nothing(inout TraceState state, vec3 direction) {
    if (HAS_ENVIRONMENT) {
        vec3 met = environment_radiance(direction);
        if (met != vec3(0.0)) met *= met_weight(state, environment_density(direction));
        state.radiance += state.throughput * met;
    }
    state.ended = 1u;
}

// The surface that the path has met: its light, one point of the lights, and on by a lobe. False where
// the path ends.
bool meet(inout TraceState state, uint pixel, uint path, Hit hit, Surface surface, SurfaceMaterial material,
          float coverage) {
    state.distance += hit.t;
    if (HAS_VOLUME) state.throughput *= transmittance(state.flags, state.media, surface, hit.t);
    uint dimension = FIRST_DIMENSION + dimension_of(state.met, 3u);
    vec4 u = random4(params.seed, path, STREAM_PATH, pixel, dimension + 1u);
    vec4 v = random4(params.seed, path, STREAM_PATH, pixel, dimension + 2u);
    bool alive = true;
    if (is_culled(state.flags, surface, material) || (HAS_ALPHA && v.z >= coverage)) {
        // It is not there.
    } else if (HAS_UNLIT && has(material, SURFACE_UNLIT)) {
        if ((state.flags & PATH_STRAIGHT) != 0u) state.radiance += state.throughput * material.color;
        alive = false;
    } else {
        state.radiance += state.throughput * met_emission(state, hit.triangle, surface, material);
        uint number = pixel + state.done * (params.width * params.height);
        Bsdf bsdf = bsdf_for_path(material, surface, STREAM_PATH, number, state.flags, state.media, state.throughput);
        LobeWeights lobes = lobes_of(bsdf, surface, -state.direction);
        // Lamps seen by way of weak lobes must not be missed.
        if ((state.flags & PATH_STRAIGHT) != 0u) lobes = evened(lobes);
        if (gathers_light(bsdf)) ask_for_light(state, bsdf, surface, lobes, pixel, path, dimension);
        alive = scatter(state, bsdf, surface, lobes, u);
        state.distance = 0.0;
    }
    uint bounces = state.flags & PATH_BOUNCES;
    alive = alive && bounces < params.max_depth && state.met < MOST_MET;
    if (alive && bounces >= FIRST_ROULETTE) {
        // Russian roulette.
        float survival = min(1.0, largest(state.throughput));
        alive = u.z < survival;
        state.throughput *= 1.0 / survival;
    }
    state.origin = leave(surface, state.direction);
    return alive;
}

// The path and its rays to lights have ended: adds what it has brought, and begins the next one.
void end_path(inout TraceState state) {
    bool valid = finite(state.radiance);
    if (!valid) atomicAdd(status.invalid, 1u);
    state = new_path(state.done + 1u, state.sum + (valid ? state.radiance : vec3(0.0)));
}

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_TRACE)) return;
    TraceState state = new_path(0u, vec3(0.0));
    if (launch.round > 0u) {
        state = traces[pixel];
        if (state.done >= launch.paths) return;
    }
    uint rays = 0u;
    int steps = int(params.step_budget);
    while (state.done < launch.paths) {
        bool fresh = steps == int(params.step_budget);
        steps -= vertex_steps() + 2 * local_light_steps();
        if (steps < 0) {
            block_after(PASS_TRACE);
            break;
        }
        uint path = launch.iteration * launch.paths + state.done;
        bool shadow = has_light_ray(state.light_rays);
        LightRay light_ray = state.light_rays.of[0];
        float from_eye;
        if (state.met == 0u) {
            camera_ray(picture_pixel(pixel), path, state.origin, state.direction, from_eye);
        }
        vec3 origin = shadow ? light_ray.origin : state.origin;
        vec3 direction = shadow ? light_ray.direction : state.direction;
        Hit hit;
        Sought sought = before_light(light_ray);
        if (!shadow) sought = NEAREST;
        uint found = trace(origin, direction, sought, steps, hit);
        if (found == TRACE_UNFINISHED) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_TRACE);
            break;
        }
        ++rays;
        if (shadow && found == TRACE_MISS) {
            state.radiance += light_ray.light;
            state.light_rays.of[0].distance = 0.0;
        } else if (found == TRACE_MISS) {
            meet_nothing(state, direction);
        } else {
            Surface surface = surface_at(hit, direction);
            SurfaceMaterial material = material_at(hit, direction, surface);
            float coverage = HAS_ALPHA ? coverage_of(material) : 1.0;
            if (shadow) {
                pass_surface(light_ray, surface, hit.t, vec3(1.0 - coverage));
                state.light_rays.of[0] = light_ray;
            } else {
                ++state.met;
                state.ended = meet(state, picture_pixel(pixel), path, hit, surface, material, coverage) ? 0u : 1u;
            }
        }
        if (state.ended != 0u && !has_light_ray(state.light_rays)) end_path(state);
    }
    traces[pixel] = state;
    if (state.done == launch.paths) image[pixel] = state.sum / float(launch.paths);
    count_rays(rays);
}
