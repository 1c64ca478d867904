#version 460
// One invocation a pixel: a ray through a random point of the pixel (and of the lens), on to a surface on which photons
// are gathered. The rule, for every surface alike: paths follow lobes of width 0 (mirrors, smooth glass, smooth coats)
// and gather on diffuse lobes; between following a rough lobe and gathering on it the path chooses at random, and each
// way weighs what it finds (followed_weight of include/bsdf.glsl). Whatever it chooses, it asks for a light too, and
// weighs what it could have met by following by the balance heuristic (Veach and Guibas 1995). Of all that a path
// asks for one is chosen in proportion to what it brings, and one ray traced: else the longest path of a SIMD group
// would hold up the others twice as long. Reads the scene; writes hit_position, hit_weight, hit_emission, hit_surface
// in glossy scenes (and gathered, light_rays: the rest of an unfinished path). O(bounces x log triangles). Fails by
// running out of steps: the path then goes on next round.
#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/camera.glsl"
#include "include/environment.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/light.glsl"
#include "include/light_ray.glsl"
#include "include/path.glsl"
#include "include/pixels.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

SEARCHES(STORES)
AOVS(UPDATES)
LIGHT_RAYS(UPDATES)

#define FIRST_BOUNCE_DIMENSION 2u  // stratified dimensions 0 and 1 place the ray in the pixel
#define LOBE_DIMENSIONS 4096u      // of random numbers, beyond those of bounces: where in a lobe
#define LIGHT_DIMENSIONS 8192u     // which light is asked for, and where on it

bool sees_light(uint memory) { return !HAS_SPLIT || (memory & PATH_CAUSTIC) != 0u; }

// The weight of light that a ray meets and that could be asked for with `density`: the balance heuristic. followed: the
// density with which rough lobes gave the ray its direction; 0: none did, and nothing else finds this light.
float met_weight(float followed, float density) { return followed > 0.0 ? followed / (followed + density) : 1.0; }

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_EYE)) return;

    vec3 origin, direction;
    vec3 throughput = vec3(1.0);
    vec3 emission = vec3(0.0);
    float distance = 0.0;   // along the path, for the footprint
    uint memory = PATH_OUTSIDE | PATH_STRAIGHT;
    uint rays = 0u;
    float followed = 0.0;   // see met_weight
    float leg = 0.0;        // since the last vertex
    LightRay light_ray = no_light_ray();
    HitPosition position = HitPosition(vec3(0.0), HIT_NONE);
    HitWeight weight = HitWeight(vec3(0.0), 0u);
    bool follows = true;    // else the ray to a light is all that is left
    if (launch.round == 0u) {
        camera_ray(pixel, launch.iteration, origin, direction, distance);
    } else {
        HitPosition left = hit_position_at(pixel);
        if ((left.state & HIT_MASK) != HIT_UNFINISHED) return;
        origin = left.position;
        throughput = hit_weight_at(pixel).weight;
        memory = hit_weight_at(pixel).normal;
        emission = hit_emission_at(pixel).emission;
        distance = hit_emission_at(pixel).footprint;
        Gathered rest = gathered_at(pixel);
        direction = rest.flux;
        if (EYE_PATHS_ASK) {
            followed = rest.excess.x;
            leg = rest.excess.y;
            light_ray = light_rays[pixel];
            follows = rest.count == HIT_UNFINISHED;
            if (!follows) {
                position = HitPosition(origin, rest.count);
                weight = HitWeight(throughput, memory);
            }
        }
    }

    bool begins = (memory & PATH_BOUNCES) == 0u;
    int steps = int(params.step_budget);
    while (follows && (memory & PATH_BOUNCES) < params.max_depth) {
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
            gathered[pixel] = Gathered(direction, HIT_UNFINISHED, vec3(followed, leg, 0.0), 0u);
            break;
        }
        ++rays;
        ++memory;
        if (found == TRACE_MISS) {
            // A ray that goes nowhere meets nothing: the update pass is to hear of it.
            if (!finite(direction)) {
                emission += direction;
                break;
            }
            if (HAS_ENVIRONMENT && sees_light(memory)) {
                vec3 met = environment_radiance(direction);
                if (EYE_PATHS_ASK && met != vec3(0.0)) {
                    met *= met_weight(followed, environment_density(direction));
                }
                emission += throughput * met;
            }
            break;
        }
        distance += hit.t;
        leg += hit.t;
        Surface surface = surface_at(hit, direction);
        SurfaceMaterial material = material_at(hit, direction, surface);
        if (HAS_VOLUME) throughput *= transmittance(memory, surface, hit.t);
        vec4 u = vec4(0.0);  // where in a lobe, and whether the surface is there
        if (HAS_ROUGH || HAS_ALPHA) {
            u = random4(params.seed, launch.iteration, STREAM_EYE, pixel, LOBE_DIMENSIONS + depth);
        }
        if (HAS_ALPHA && u.z >= coverage_of(material)) {
            origin = leave(surface, direction);
            continue;
        }
        if (HAS_AOVS && (memory & PATH_SEEN) == 0u) {
            memory |= PATH_SEEN;
            Aovs sum = aovs[pixel];
            add(sum.albedo, sum.albedo_low, material.color);
            add(sum.normal, sum.normal_low, surface.normal);
            add(sum.depth, sum.depth_low, distance * dot(direction, params.forward));
            ++sum.hits;
            aovs[pixel] = sum;
        }
        if (HAS_UNLIT && has(material, SURFACE_UNLIT)) {
            // What emits no photons must not be seen by rough lobes: photons would have to bring their share of it.
            if ((memory & PATH_STRAIGHT) != 0u && sees_light(memory)) emission += throughput * material.color;
            break;
        }
        if ((surface.front || has(material, SURFACE_DOUBLE_SIDED)) && sees_light(memory)) {
            vec3 met = material.emission;
            if (EYE_PATHS_ASK && met != vec3(0.0)) {
                met *= met_weight(followed, met_density(material, surface, direction, leg));
            }
            emission += throughput * met;
        }
        float ior = index_for_path(material, STREAM_EYE, pixel, memory, throughput);
        Bsdf bsdf = bsdf_of(material, ior, surface.front);

        // Gathering takes part in the choice of a lobe, in place of the diffuse one.
        vec3 wo = -direction;
        LobeWeights lobes = lobes_of(bsdf, surface, wo);
        LobeWeights rough = share_with_photons(bsdf, lobes);
        // The probability that a rough lobe is followed.
        float rough_share = total(rough) / total(lobes);
        bool asks = EYE_PATHS_ASK && params.light_count > 0u && rough_share > 0.0;
        if (asks) {
            uvec4 bits = random_words(params.seed, launch.iteration, STREAM_EYE, pixel, LIGHT_DIMENSIONS + depth);
            LightSample light = sample_light(bits, u.xy, surface.position);
            vec3 factor = light.radiance * rough_bsdf(bsdf, surface, wo, light.direction, PART_FOLLOWED);
            factor *= abs(dot(light.direction, surface.normal)) * transmittance_to(light, memory, bsdf, surface);
            // What a path of full length would meet next it does not meet. (Rays to lights pass any number of surfaces
            // that are partly there, of which each costs a path a bounce: where it has too few left that share is
            // lost.)
            if (light.density > 0.0 && (memory & PATH_BOUNCES) < params.max_depth) {
                float other = rough_share * scatter_density(bsdf, surface, rough, wo, light.direction);
                factor *= light.density / (light.density + other);
            }
            take_one(light_ray, ray_to(light, throughput * factor, surface), u.w);
        }
        float choice = stratified(params.seed, launch.iteration, pixel, depth + FIRST_BOUNCE_DIMENSION);
        float inverse_probability;
        uint lobe = choose_lobe(lobes, choice, inverse_probability);
        if (lobe == LOBE_NONE) break;
        throughput *= inverse_probability;
        if (lobe == LOBE_DIFFUSE) {
            position.position = surface.position;
            weight.normal = pack_direction(surface.normal);
            uvec3 albedo = uvec3(1023u);
            if (HAS_GLOSS) {
                weight.weight = throughput * (1.0 / PI);
                hit_surface[pixel] = HitSurface(hit.triangle, hit.barycentric, pack_direction(wo));
                position.state = HIT_DIFFUSE | gathering_sides(bsdf);
            } else {
                weight.weight = throughput * bsdf.diffuse * (1.0 / PI);
                albedo = uvec3(clamp(bsdf.diffuse, 0.0, 1.0) * 1023.0 + 0.5);
                position.state = HIT_DIFFUSE;
            }
            position.state |= (albedo.x | albedo.y << 10u | albedo.z << 20u) << 2u;
            break;
        }
        if (!HAS_REFLECTION && !HAS_TRANSMISSION) break;
        float density;
        throughput *= sample_lobe(lobe, bsdf, surface, u.xy, true, direction, density);
        if (HAS_ROUGH) {
            throughput *= followed_weight(density, dot(direction, normal_of(lobe, surface)));
            memory = leave_lobe(memory, density);
            // A clearcoat's light from below the horizon of its base is not asked for: rough_bsdf leaves it out.
            float side = dot(direction, surface.normal) * dot(direction, surface.geometric);
            bool met_alone = !asks || density == DELTA || side <= 0.0;
            followed = met_alone ? 0.0 : rough_share * scatter_density(bsdf, surface, rough, wo, direction);
            leg = 0.0;
        }
        if (all(lessThanEqual(throughput, vec3(0.0)))) break;
        memory = pass_boundary(memory, bsdf, lobe, surface);
        origin = leave(surface, direction);
    }
    // A loop of its own: software Vulkan runs all of a loop's code for every ray of it, and this one hardly shades.
    while (EYE_PATHS_ASK && light_ray.distance > 0.0 && position.state != HIT_UNFINISHED) {
        --steps;
        bool fresh = steps + 1 == int(params.step_budget);
        Hit hit;
        uint found = trace(light_ray.origin, light_ray.direction, steps, hit);
        if (found == TRACE_UNFINISHED) {
            if (fresh) atomicAdd(status.stuck, 1u);
            block_after(PASS_EYE);
            gathered[pixel].count = position.state;
            position.state = HIT_UNFINISHED;
            break;
        }
        ++rays;
        bool reaches = reaches_light(light_ray, found, hit);
        if (reaches) emission += light_ray.light;
        if (reaches || !HAS_ALPHA) break;
        Surface surface = surface_at(hit, light_ray.direction);
        pass_surface(light_ray, surface, hit.t, coverage_of(material_at(hit, light_ray.direction, surface)));
    }
    if (EYE_PATHS_ASK && position.state == HIT_UNFINISHED) light_rays[pixel] = light_ray;
    hit_position[pixel] = position;
    hit_weight[pixel] = weight;
    hit_emission[pixel] = HitEmission(
        emission, (position.state & HIT_MASK) == HIT_UNFINISHED ? distance : distance * params.pixel_radius);
    // The knn pass, which has little to do after the first iterations, goes through these alone.
    if ((position.state & HIT_DIFFUSE) != 0u && pixels_at(pixel).seeded == 0u) {
        uint place = atomicAdd(status.searches, 1u);
        if (place < pixel_count()) searches[place] = pixel;
    }
    if (begins && rays > 0u) --rays;  // the host knows of the first of every pixel
    if (rays > 0u) count_rays(rays);
}
