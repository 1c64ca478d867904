// An eye path and what it does: it meets surfaces and light, asks for a light (next-event estimation), chooses a lobe
// and follows it (BSDF sampling) or gathers photons there. What it meets and what it asks for are weighed by the
// balance heuristic (multiple importance sampling), direct light by the rules of include/direct.glsl. Reads the scene;
// writes the records of the hit, AOVs, and the state of a path that has run out of steps.
#ifndef EYE_PATH_GLSL
#define EYE_PATH_GLSL

#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/camera.glsl"
#include "include/direct.glsl"
#include "include/environment.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/layers.glsl"
#include "include/light.glsl"
#include "include/light_ray.glsl"
#include "include/path.glsl"
#include "include/rng.glsl"
#include "include/split.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

EYE_PATHS(UPDATES)
LIGHT_RAYS(UPDATES)

#define FIRST_BOUNCE_DIMENSION 2u  // stratified dimensions 0 and 1 place the ray in the pixel
#define LOBE_DIMENSIONS 4096u      // of random numbers, beyond those of bounces: where in a lobe
#define LIGHT_DIMENSIONS 8192u     // which light is asked for, and where on it
#define CANDIDATE_DIMENSIONS 1024u //   of one candidate, beyond that: where in a pixel of the environment, and whether
                                   //   it is taken

struct EyePath {
    uint pixel;            // in the band
    EyeState at;           // its next ray, and what it has found
    LightRays light_rays;  // that it has chosen so far
    HitPosition position;  // where it has ended; HIT_UNFINISHED: it, or its ray to a light, goes on next round
    HitWeight weight;
    uint rays;             // traced by this invocation
    int steps;             // left to it
};

// A surface that the path has met.
struct Vertex {
    Hit hit;
    Surface surface;
    SurfaceMaterial material;
    Bsdf bsdf;
    vec3 wo;            // towards the eye
    vec3 throughput;    // of the path, before a lobe is chosen
    uint dimension;     // of its random numbers
    vec4 u;             // where in a lobe, and whether the surface is there
    LobeWeights lobes;  // to choose from: gathering has the place of the diffuse lobe
    LobeWeights rough;  // those of rough lobes that are followed
    float rough_share;  // the probability that one of them is
    bool asks;          // for a light
};

uint bounces_of(uint flags) { return flags & PATH_BOUNCES; }

// ---- begin, load, store ----

EyePath begin_eye_path(uint pixel) {
    EyePath path;
    path.pixel = pixel;
    path.at = EyeState(vec3(0.0), flags_at_eye(), vec3(0.0), 0.0, vec3(1.0), 0.0, vec3(0.0), 0.0, HIT_UNFINISHED,
                       vec3[](vec3(0.0), vec3(0.0)), vec3(1.0), 0u, media_at_eye(), 0.0);
    path.light_rays = no_light_rays();
    path.position = HitPosition(vec3(0.0), HIT_NONE);
    path.weight = HitWeight(vec3(0.0), 0u);
    path.rays = 0u;
    path.steps = int(params.step_budget);
    return path;
}

// True where the path was left unfinished, and goes on where it was.
bool load(inout EyePath path) {
    HitPosition left = hit_position_at(path.pixel);
    bool unfinished = hit_kind(left) == HIT_UNFINISHED;
    if (unfinished) {
        path.at = eye_paths[path.pixel];
        for (uint g = 0u; EYE_PATHS_ASK && g < GROUPS; ++g) {
            path.light_rays.of[g] = light_rays[g * pixel_count() + path.pixel];
        }
        if (EYE_PATHS_ASK && path.at.end != HIT_UNFINISHED) {
            path.position = HitPosition(left.position, path.at.end);
            path.weight = hit_weight_at(path.pixel);
        }
    }
    return unfinished;
}

// Out of steps: the path, or its ray to a light, goes on next round. fresh: one ray had the whole budget.
void leave_unfinished(inout EyePath path, bool fresh) {
    if (fresh) atomicAdd(status.stuck, 1u);
    block_after(PASS_EYE);
    path.position.state = HIT_UNFINISHED;
}

void store(EyePath path) {
    if (HAS_AOVS && path.position.state != HIT_UNFINISHED) {
        add_layers(path.pixel, path.at.layer);
        if (HAS_ROUGH) eye_paths[path.pixel].flags = path.at.flags;  // for the gather
    }
    if (HAS_NESTED) {
        eye_paths[path.pixel].flags = path.at.flags;  // likewise
        eye_paths[path.pixel].media = path.at.media;
    }
    if (path.position.state == HIT_UNFINISHED) {
        eye_paths[path.pixel] = path.at;
        for (uint g = 0u; EYE_PATHS_ASK && g < GROUPS; ++g) {
            light_rays[g * pixel_count() + path.pixel] = path.light_rays.of[g];
        }
    }
    hit_position[path.pixel] = path.position;
    hit_weight[path.pixel] = path.weight;
    hit_emission[path.pixel] = HitEmission(path.at.emission, footprint_at(path.at.distance));
}

// ---- meet ----

// The path has found light.
void find(inout EyePath path, vec3 light, uint layer) {
    path.at.emission += light;
    if (HAS_AOVS && layer < LAYERS) path.at.layer[layer] += light;
}

// The layer of light that the path meets: it has come, from there to the surface seen, by what the path has gone.
uint layer_of_met(uint flags) {
    if ((flags & PATH_STRAIGHT) != 0u) return LAYER_DIRECT;
    if ((flags & PATH_ROUGH_TWICE) != 0u) return LAYER_REST;
    return (flags & PATH_CAUSTIC) != 0u ? LAYER_CAUSTIC : LAYER_DIRECT;
}

// The layer of light that arrives at a vertex.
uint layer_of_asked(uint flags) { return (flags & PATH_STRAIGHT) != 0u ? LAYER_DIRECT : LAYER_REST; }

// The weight of light that a ray meets and that could be asked for with `density`: the balance heuristic. followed: the
// density with which rough lobes gave the ray its direction; 0: none did, and nothing else finds this light.
float met_weight(float followed, float density) { return followed > 0.0 ? followed / (followed + density) : 1.0; }

// The throughput for light that the ray meets and that could be asked for with `density`. asks: it is asked for, where
// direct light is.
vec3 throughput_of_met(EyePath path, float density, bool asks) {
    if (!EYE_PATHS_ASK) return path.at.throughput;
    if (!HAS_DIRECT) return path.at.throughput * met_weight(path.at.followed, density);
    if (!HAS_ROUGH || !asks) return path.at.throughput;
    return path.at.direct * met_weight(path.at.followed, density);
}

// What lies between the path's last vertex and the next lets through so much.
void attenuate(inout EyePath path, vec3 transmittance) {
    path.at.throughput *= transmittance;
    if (HAS_DIRECT && HAS_ROUGH) path.at.direct *= transmittance;
}

void meet_nothing(inout EyePath path) {
    if (!finite(path.at.direction)) {
        // A ray that goes nowhere meets nothing: the update pass is to hear of it.
        path.at.emission += path.at.direction;
    } else if (HAS_ENVIRONMENT && sees_light(path.at.flags)) {
        vec3 met = environment_radiance(path.at.direction);
        if (met != vec3(0.0)) {
            float density = EYE_PATHS_ASK ? environment_density(path.at.direction) : 0.0;
            find(path, throughput_of_met(path, density, true) * met, layer_of_met(path.at.flags));
        }
    }
}

Vertex meet(inout EyePath path, Hit hit) {
    Vertex v;
    v.dimension = dimension_of(path.at.met - 1u, 1u);
    path.at.distance += hit.t;
    path.at.leg += hit.t;
    v.wo = -path.at.direction;
    v.surface = surface_at(hit, path.at.direction);
    v.hit = hit;
    v.material = material_at(hit, path.at.direction, v.surface);
    if (HAS_VOLUME) attenuate(path, transmittance(path.at.flags, path.at.media, v.surface, hit.t));
    v.u = vec4(0.0);
    if (HAS_ROUGH || HAS_ALPHA) {
        v.u = random4(params.seed, launch.iteration, STREAM_EYE, picture_pixel(path.pixel),
                      LOBE_DIMENSIONS + v.dimension);
    }
    return v;
}

bool is_there(EyePath path, Vertex v) {
    return !is_culled(path.at.flags, v.surface, v.material) && !(HAS_ALPHA && v.u.z >= coverage_of(v.material));
}

bool is_unlit(Vertex v) { return HAS_UNLIT && has(v.material, SURFACE_UNLIT); }

// Writes down what the first surface of the path is like.
void describe(inout EyePath path, Vertex v) {
    if (HAS_AOVS && (path.at.flags & PATH_SEEN) == 0u) {
        path.at.flags |= PATH_SEEN;
        Aovs sum = aovs[path.pixel];
        add(sum.albedo, sum.albedo_low, v.material.color);
        add(sum.normal, sum.normal_low, v.surface.normal);
        add(sum.depth, sum.depth_low, path.at.distance * dot(path.at.direction, params.forward));
        ++sum.hits;
        aovs[path.pixel] = sum;
    }
}

// What emits no photons must not be seen by rough lobes: photons would have to bring their share of it.
void meet_unlit(inout EyePath path, Vertex v) {
    if ((path.at.flags & PATH_STRAIGHT) != 0u && sees_light(path.at.flags)) {
        find(path, path.at.throughput * v.material.color, LAYER_DIRECT);
    }
}

void meet_emission(inout EyePath path, Vertex v) {
    if ((v.surface.front || has(v.material, SURFACE_DOUBLE_SIDED)) && sees_light(path.at.flags)) {
        vec3 met = met_radiance(v.material, v.surface, path.at.direction);
        if (met != vec3(0.0)) {
            AskedDensity asked = AskedDensity(0.0, 0.0);
            if (EYE_PATHS_ASK) {
                path.steps -= local_light_steps();
                asked = met_density(v.hit.triangle, v.material, v.surface, path.at.direction, path.at.leg);
            }
            vec3 throughput = throughput_of_met(path, asked.density, asks_emitter(asked.of_lamp));
            find(path, throughput * met, layer_of_met(path.at.flags));
        }
    }
}

// How the surface scatters, and what the path has to choose from there.
void weigh_lobes(inout EyePath path, inout Vertex v) {
    v.bsdf = bsdf_for_path(v.material, v.surface, STREAM_EYE, picture_pixel(path.pixel), path.at.flags, path.at.media,
                           path.at.throughput);
    v.throughput = path.at.throughput;
    v.lobes = lobes_of(v.bsdf, v.surface, v.wo);
    v.rough = share_with_photons(v.bsdf, v.lobes);
    v.rough_share = total(v.rough) / total(v.lobes);
    // Where photons are gathered there is direct light too.
    bool asks = v.rough_share > 0.0 || (HAS_DIRECT && v.lobes.of[LOBE_DIFFUSE] > 0.0);
    v.asks = EYE_PATHS_ASK && params.light_count > 0u && asks;
}

// ---- ask ----

// What a sample of the light that arrives at the vertex brings, where nothing is in between.
vec3 light_from(EyePath path, Vertex v, LightSample light) {
    if (HAS_DIRECT && light.triangle != NO_TRIANGLE && !asks_emitter(light.of_lamp)) return vec3(0.0);
    uint part = HAS_DIRECT ? PART_ALL : PART_FOLLOWED;
    vec3 factor = light.radiance * rough_bsdf(v.bsdf, v.surface, v.wo, light.direction, part);
    factor *= abs(dot(light.direction, v.surface.normal)) *
              transmittance_to(light, path.at.flags, path.at.media, v.bsdf, v.surface);
    // What a path of full length would meet next it does not meet.
    if (HAS_ROUGH && light.density > 0.0 && v.rough_share > 0.0 && bounces_of(path.at.flags) < params.max_depth) {
        float other = v.rough_share * scatter_density(v.bsdf, v.surface, v.rough, v.wo, light.direction);
        factor *= light.density / (light.density + other);
    }
    return v.throughput * factor;
}

// Asks for lights: of each group for one or several points. Of all of a group that the path asks for one is kept in
// proportion to what it brings (resampled importance sampling; Talbot, Cline and Egbert 2005).
void ask(inout EyePath path, Vertex v) {
    uint dimension = LIGHT_DIMENSIONS + v.dimension;
    uint pixel = picture_pixel(path.pixel);
    uvec4 bits = random_words(params.seed, 0u, STREAM_EYE, pixel, dimension);
    for (uint g = 0u; g < GROUPS; ++g) {
        AskedGroup group = params.asked[g];
        uvec2 seeds = bits.xy;
        for (uint i = 0u; i < group.candidates; ++i) {
            path.steps -= 1 + int(group.depth);
            dimension += CANDIDATE_DIMENSIONS;
            vec4 u = random4(params.seed, launch.iteration, STREAM_EYE, pixel, dimension);
            uvec2 pair = sobol_pair(launch.iteration * group.candidates + i, seeds);
            LightSample light = sample_light(group, pair, u.xy, v.surface.position);
            vec3 brings = light_from(path, v, light) / float(group.candidates);
            if (!finite(brings)) path.at.emission += brings;  // the update pass is to hear of it
            take_one(path.light_rays.of[g], ray_to(light, brings, layer_of_asked(path.at.flags), v.surface), u.w);
        }
        bits = bits.zwyx;  // the seeds of the next group
    }
}

// Goes on with the ray to a light that has been traced, to behind a surface or to its end.
void go_on_with_light_ray(inout EyePath path, uint found, Hit hit) {
    LightRay ray = path.light_rays.of[0];
    bool reaches = found == TRACE_MISS;
    if (reaches) find(path, ray.light, ray.layer);
    if (LIGHT_RAYS_PASS && !reaches) {
        Surface surface = surface_at(hit, ray.direction);
        SurfaceMaterial material = material_at(hit, ray.direction, surface);
        pass_surface(ray, surface, hit.t, passes_straight(surface, material, ray.direction));
        path.light_rays.of[0] = ray;
    } else {
        path.light_rays.of[0].distance = 0.0;
    }
}

// ---- choose, follow, gather ----

// A lobe, or LOBE_DIFFUSE to gather, by the probabilities of v.lobes.
uint choose(inout EyePath path, Vertex v) {
    uint dimension = v.dimension + FIRST_BOUNCE_DIMENSION;
    float choice = stratified(params.seed, launch.iteration, picture_pixel(path.pixel), dimension);
    float inverse_probability;
    uint lobe = choose_lobe(v.lobes, choice, inverse_probability);
    if (lobe != LOBE_NONE) {
        path.at.throughput *= inverse_probability;
        if (passes_pane(v.bsdf, lobe)) path.at.direct *= inverse_probability;
    }
    return lobe;
}

// The path ends: photons are gathered here.
void gather(inout EyePath path, Vertex v) {
    path.position.position = v.surface.position;
    path.weight.normal = pack_direction(v.surface.normal);
    if (HAS_GLOSS) {
        path.weight.weight = path.at.throughput * (1.0 / PI);
        hit_surface[path.pixel] = HitSurface(v.hit.triangle, v.hit.barycentric, pack_direction(v.wo));
        if (HAS_INSTANCES) hit_instance[path.pixel] = v.hit.instance;
        path.position.state = hit_state(HIT_DIFFUSE | gathering_sides(v.bsdf), uvec3(1023u));
    } else {
        path.weight.weight = path.at.throughput * v.bsdf.diffuse * (1.0 / PI);
        path.position.state = hit_state(HIT_DIFFUSE, uvec3(clamp(v.bsdf.diffuse, 0.0, 1.0) * 1023.0 + 0.5));
    }
}

// Follows a lobe to the next ray; false where it sends nothing on.
bool follow(inout EyePath path, Vertex v, uint lobe) {
    float density;
    vec3 weight = sample_lobe(lobe, v.bsdf, v.surface, v.u.xy, true, path.at.direction, density);
    path.at.throughput *= weight;
    if (HAS_ROUGH && passes_pane(v.bsdf, lobe)) {
        path.at.direct *= weight;  // as if nothing had been met
    } else if (HAS_ROUGH) {
        path.at.direct = path.at.throughput;
        path.at.throughput *= followed_weight(density, dot(path.at.direction, normal_of(lobe, v.surface)));
        bool again = density != DELTA && (path.at.flags & PATH_STRAIGHT) == 0u;
        if (HAS_AOVS && again) path.at.flags |= PATH_ROUGH_TWICE;
        path.at.flags = leave_lobe(path.at.flags, density);
        // A clearcoat's light from below the horizon of its base is not asked for: rough_bsdf leaves it out.
        float side = dot(path.at.direction, v.surface.normal) * dot(path.at.direction, v.surface.geometric);
        bool met_alone = !v.asks || density == DELTA || side <= 0.0;
        path.at.followed = met_alone ? 0.0 : v.rough_share * scatter_density(v.bsdf, v.surface, v.rough, v.wo,
                                                                              path.at.direction);
        // Direct light from there counts by all lobes, whichever gave the direction.
        if (HAS_DIRECT && path.at.followed > 0.0) {
            float cosine = abs(dot(path.at.direction, v.surface.normal));
            path.at.direct = v.throughput * (cosine / path.at.followed) *
                             rough_bsdf(v.bsdf, v.surface, v.wo, path.at.direction, PART_ALL);
        }
        path.at.leg = 0.0;
    }
    bool goes_on = !all(lessThanEqual(path.at.throughput, vec3(0.0)));
    pass_boundary(path.at.flags, path.at.media, v.bsdf, lobe, v.surface);
    if (goes_straight(v.bsdf, lobe)) --path.at.flags;
    path.at.origin = leave(v.surface, path.at.direction);
    return goes_on;
}

#endif
