#version 460
// One invocation a pixel: a ray through a random point of the pixel (and of the lens), on to a surface on which photons
// are gathered. The rule, for every surface alike: paths follow lobes of width 0 (mirrors, smooth glass, smooth coats)
// and gather on diffuse lobes; between following a rough lobe, gathering on it and sampling a punctual light the path
// chooses at random, and each way weighs what it finds (followed_weight of include/bsdf.glsl). Reads the scene; writes
// hit_position, hit_weight, hit_emission, hit_surface in glossy scenes (and gathered[].flux as the direction of an
// unfinished path). O(bounces x log triangles). Fails by running out of steps: the path then goes on next round.
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/sum.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/bsdf.glsl"
#include "include/path.glsl"
#include "include/environment.glsl"
#include "include/light.glsl"
#include "include/bounds.glsl"
#include "include/camera.glsl"
#include "include/hits.glsl"

layout(binding = BIND_AOVS, scalar) buffer AovBlock { Aovs aovs[]; };

#define FIRST_BOUNCE_DIMENSION 2u  // stratified dimensions 0 and 1 place the ray in the pixel
#define LOBE_DIMENSIONS 4096u      // of random numbers, beyond those of bounces: where in a lobe

// Where light is split photons bring caustics alone, and of those an eye path finds what it meets by delta lobes after
// it has followed a rough one.
#define ASKS_FOR_LIGHTS (PUNCTUAL_ON_ROUGH && (FEATURES & FEATURE_SPLIT) == 0u)

bool sees_light(uint memory) { return (FEATURES & FEATURE_SPLIT) == 0u || (memory & PATH_CAUSTIC) != 0u; }

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_EYE)) return;

    vec3 origin, direction;
    vec3 throughput = vec3(1.0);
    vec3 emission = vec3(0.0);
    float distance = 0.0;   // along the path, for the footprint
    uint memory = PATH_OUTSIDE | PATH_STRAIGHT;
    uint rays = 0u;
    if (launch.round == 0u) {
        camera_ray(pixel, launch.iteration, origin, direction, distance);
    } else {
        if (hit_state(pixel) != HIT_UNFINISHED) return;
        origin = hit_position[pixel].position;
        throughput = hit_weight[pixel].weight;
        memory = hit_weight[pixel].normal;
        emission = hit_emission[pixel].emission;
        distance = hit_emission[pixel].footprint;
        direction = gathered[pixel].flux;
    }

    HitPosition position = HitPosition(vec3(0.0), HIT_NONE);
    HitWeight weight = HitWeight(vec3(0.0), 0u);
    int steps = int(params.step_budget);
    while (true) {
        bool shadow = ASKS_FOR_LIGHTS && (memory & PATH_SHADOW) != 0u;
        if ((memory & PATH_BOUNCES) >= (shadow ? PATH_BOUNCES : params.max_depth)) break;
        --steps;
        uint depth = memory & PATH_BOUNCES;
        bool fresh = steps + 1 == int(params.step_budget);
        Hit hit;
        uint found = trace(origin, direction, steps, hit);
        if (found == TRACE_UNFINISHED) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_EYE);
            position = HitPosition(origin, HIT_UNFINISHED);
            weight = HitWeight(throughput, memory);
            gathered[pixel].flux = direction;
            break;
        }
        ++rays;
        ++memory;
        if (shadow && (found == TRACE_MISS || hit.t >= distance)) {
            emission += throughput;
            break;
        }
        if (found == TRACE_MISS) {
            // A ray that goes nowhere meets nothing: the update pass is to hear of it.
            if (!finite(direction)) {
                emission += direction;
                break;
            }
            if ((FEATURES & FEATURE_ENVIRONMENT) != 0u && sees_light(memory)) {
                emission += throughput * environment_radiance(direction);
            }
            break;
        }
        distance += shadow ? -hit.t : hit.t;
        Surface surface = surface_at(hit, direction);
        SurfaceMaterial material = material_at(hit, direction, surface);
        if ((FEATURES & FEATURE_VOLUME) != 0u) throughput *= transmittance(memory, surface, hit.t);
        vec4 u = vec4(0.0);  // where in a lobe, and whether the surface is there
        if ((FEATURES & (FEATURE_ROUGH | FEATURE_ALPHA)) != 0u) {
            u = random4(params.seed, launch.iteration, STREAM_EYE, pixel, LOBE_DIMENSIONS + depth);
        }
        if ((FEATURES & FEATURE_ALPHA) != 0u && u.z >= coverage_of(material)) {
            origin = leave(surface, direction);
            continue;
        }
        if (shadow) break;
        if ((FEATURES & FEATURE_AOVS) != 0u && (memory & PATH_SEEN) == 0u) {
            memory |= PATH_SEEN;
            Aovs sum = aovs[pixel];
            add(sum.albedo, sum.albedo_low, material.color);
            add(sum.normal, sum.normal_low, surface.normal);
            add(sum.depth, sum.depth_low, distance * dot(direction, params.forward));
            ++sum.hits;
            aovs[pixel] = sum;
        }
        if ((FEATURES & FEATURE_UNLIT) != 0u && has(material, SURFACE_UNLIT)) {
            // What emits no photons must not be seen by rough lobes: photons would have to bring their share of it.
            if ((memory & PATH_STRAIGHT) != 0u && sees_light(memory)) emission += throughput * material.color;
            break;
        }
        if ((surface.front || has(material, SURFACE_DOUBLE_SIDED)) && sees_light(memory)) {
            emission += throughput * material.emission;
        }
        float ior = index_for_path(material, STREAM_EYE, pixel, memory, throughput);
        Bsdf bsdf = bsdf_of(material, ior, surface.front);

        // Gathering takes part in the choice of a lobe, in place of the diffuse one.
        vec4 lobes = lobes_of(bsdf, surface, -direction);
        vec3 rough = vec3(0.0);
        if ((FEATURES & FEATURE_ROUGH) != 0u) {
            rough = vec3(bsdf.alpha > 0.0 ? lobes.yz : vec2(0.0), bsdf.clearcoat_alpha > 0.0 ? lobes.w : 0.0);
            vec3 shares = rough * vec3(vec2(gathered_share(bsdf.alpha)), gathered_share(bsdf.clearcoat_alpha));
            rough -= shares;
            lobes.x += shares.x + shares.y + shares.z;
            lobes.yzw -= shares;
        }
        float choice = stratified(params.seed, launch.iteration, pixel, depth + FIRST_BOUNCE_DIMENSION);
        float inverse_probability;
        uint lobe = choose_lobe(lobes, choice, inverse_probability);
        if (lobe == LOBE_NONE) break;
        if (ASKS_FOR_LIGHTS && lobe != LOBE_DIFFUSE && rough[lobe - 1u] > 0.0) {
            // One half of what would follow rough lobes asks for a light instead.
            if (u.w < 0.5) {
                vec3 towards;
                throughput *= sample_punctual(2.0 * u.w, surface.position, towards, distance);
                throughput *= rough_bsdf(bsdf, surface, -direction, towards, PART_FOLLOWED);
                throughput *= abs(dot(towards, surface.normal)) * (lobes.x + lobes.y + lobes.z + lobes.w) /
                              (0.5 * (rough.x + rough.y + rough.z));
                if (all(lessThanEqual(throughput, vec3(0.0)))) break;
                direction = towards;
                origin = leave(surface, direction);
                memory |= PATH_SHADOW;
                continue;
            }
            inverse_probability *= 2.0;
        }
        throughput *= inverse_probability;
        if (lobe == LOBE_DIFFUSE) {
            position.position = surface.position;
            weight.normal = pack_direction(surface.normal);
            uvec3 albedo = uvec3(1023u);
            if ((FEATURES & FEATURE_GLOSS) != 0u) {
                weight.weight = throughput * (1.0 / PI);
                hit_surface[pixel] = HitSurface(hit.triangle, hit.barycentric, pack_direction(-direction));
                position.state = bsdf.glass > 0.0 && bsdf.alpha > 0.0 ? HIT_BOTH_SIDES : HIT_DIFFUSE;
            } else {
                weight.weight = throughput * bsdf.diffuse * (1.0 / PI);
                albedo = uvec3(clamp(bsdf.diffuse, 0.0, 1.0) * 1023.0 + 0.5);
                position.state = HIT_DIFFUSE;
            }
            position.state |= (albedo.x | albedo.y << 10u | albedo.z << 20u) << 2u;
            break;
        }
        if ((FEATURES & (FEATURE_REFLECTION | FEATURE_TRANSMISSION)) == 0u) break;
        float density;
        throughput *= sample_lobe(lobe, bsdf, surface, u.xy, true, direction, density);
        if ((FEATURES & FEATURE_ROUGH) != 0u) {
            vec3 n = lobe == LOBE_CLEARCOAT ? surface.clearcoat_normal : surface.normal;
            throughput *= followed_weight(density, dot(direction, n));
            memory = leave_lobe(memory, density);
        }
        if (all(lessThanEqual(throughput, vec3(0.0)))) break;
        memory = pass_boundary(memory, bsdf, lobe, surface);
        origin = leave(surface, direction);
    }
    hit_position[pixel] = position;
    hit_weight[pixel] = weight;
    hit_emission[pixel] = HitEmission(
        emission, (position.state & HIT_MASK) == HIT_UNFINISHED ? distance : distance * params.pixel_radius);
    if (rays > 1u) count_rays(rays - 1u);  // the host knows of the first of every pixel
}
