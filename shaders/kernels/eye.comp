#version 460
// One invocation a pixel: a ray through a random point of the pixel, on through mirrors and glass to the first diffuse
// surface. Reads the scene; writes hit_position, hit_weight, hit_emission (and gathered[].flux as the direction of an
// unfinished path). O(bounces x log triangles). Fails by running out of steps: the path then goes on next round.
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/specular.glsl"
#include "include/bounds.glsl"
#include "include/hits.glsl"

layout(binding = BIND_AOVS, scalar) buffer AovBlock { Aovs aovs[]; };

void main() {
    uint pixel = invocation();
    if (pixel >= pixel_count() || blocked(PASS_EYE)) return;

    vec3 origin, direction;
    vec3 throughput = vec3(1.0);
    vec3 emission = vec3(0.0);
    float distance = 0.0;   // along the path, for the footprint
    uint depth = 0u;
    uint rays = 0u;
    if (launch.round == 0u) {
        vec2 jitter = vec2(stratified(params.seed, launch.iteration, pixel, 0u),
                           stratified(params.seed, launch.iteration, pixel, 1u));
        vec2 raster = vec2(pixel % params.width, pixel / params.width) + jitter;
        vec2 film = 2.0 * raster / vec2(params.width, params.height) - 1.0;
        direction = normalize(params.forward + film.x * params.right - film.y * params.up);
        origin = enter_bounds(params.eye, direction);
        distance = length(origin - params.eye);
    } else {
        if ((hit_position[pixel].state & HIT_MASK) != HIT_UNFINISHED) return;
        origin = hit_position[pixel].position;
        throughput = hit_weight[pixel].weight;
        depth = hit_weight[pixel].normal;
        emission = hit_emission[pixel].emission;
        distance = hit_emission[pixel].footprint;
        direction = gathered[pixel].flux;
    }

    HitPosition position = HitPosition(vec3(0.0), HIT_NONE);
    HitWeight weight = HitWeight(vec3(0.0), 0u);
    int steps = int(params.step_budget);
    for (; depth < params.max_depth; ++depth) {
        --steps;
        bool fresh = steps + 1 == int(params.step_budget);
        Hit hit;
        uint found = trace(origin, direction, steps, hit);
        if (found == TRACE_UNFINISHED) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_EYE);
            position = HitPosition(origin, HIT_UNFINISHED);
            weight = HitWeight(throughput, depth);
            gathered[pixel].flux = direction;
            break;
        }
        ++rays;
        if (found == TRACE_MISS) break;
        distance += hit.t;
        Surface surface = surface_at(hit, direction);
        SurfaceMaterial material = material_at(surface.material);
        if ((FEATURES & FEATURE_AOVS) != 0u && depth == 0u) {
            Aovs sum = aovs[pixel];
            aovs[pixel] = Aovs(sum.albedo + material.color, sum.normal + surface.normal,
                               sum.depth + distance * dot(direction, params.forward), sum.hits + 1u);
        }
        if (surface.front || (material.kind & SURFACE_DOUBLE_SIDED) != 0u) emission += throughput * material.emission;
        if (kind_of(material) == SURFACE_DIFFUSE) {
            weight.weight = throughput * material.color * (1.0 / PI);
            weight.normal = pack_direction(surface.normal);
            position.position = surface.position;
            uvec3 albedo = uvec3(clamp(material.color, 0.0, 1.0) * 1023.0 + 0.5);
            position.state = any(greaterThan(weight.weight, vec3(0.0))) ? HIT_DIFFUSE : HIT_NONE;
            position.state |= (albedo.x | albedo.y << 10u | albedo.z << 20u) << 2u;
            break;
        }
        if ((FEATURES & (FEATURE_MIRROR | FEATURE_DIELECTRIC)) == 0u) break;
        float u = stratified(params.seed, launch.iteration, pixel, depth + 2u);
        throughput *= scatter_specular(material, surface, u, true, direction);
        if (all(lessThanEqual(throughput, vec3(0.0)))) break;
        origin = leave(surface, direction);
    }
    hit_position[pixel] = position;
    hit_weight[pixel] = weight;
    hit_emission[pixel] = HitEmission(
        emission, (position.state & HIT_MASK) == HIT_UNFINISHED ? distance : distance * params.pixel_radius);
    if (rays > 1u) atomicAdd(status.rays, rays - 1u);  // the host knows of the first of every pixel
}
