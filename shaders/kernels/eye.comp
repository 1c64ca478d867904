#version 460
// One invocation a pixel: a ray through a random point of the pixel (and of the lens), on to a surface on which photons
// are gathered. The rule, for every surface alike: paths follow lobes of width 0 (mirrors, smooth glass, smooth coats)
// and gather on diffuse lobes; between following a rough lobe and gathering on it the path chooses at random, and each
// way weighs what it finds (followed_weight of include/bsdf.glsl). Whatever it chooses, it asks for lights too
// (next-event estimation), and weighs what it could have met by following by the balance heuristic (multiple importance
// sampling; Veach and Guibas 1995). Of all that a path asks for of one group of lights one is chosen in proportion to
// what it brings and one ray traced: else the longest path of a SIMD group (subgroup) would hold up the others longer.
// Reads the scene, and pixels; writes hit_position, hit_weight, hit_emission, hit_surface in glossy scenes, aovs where
// asked for, searches, and eye_paths and light_rays where a path is unfinished. O(bounces x log triangles). Fails by
// running out of steps: the path then goes on next round.
#include "include/kernel.glsl"
#include "include/eye_path.glsl"
#include "include/pixels.glsl"

SEARCHES(STORES)

// Goes on with the path until it ends or is out of steps.
void follow_path(inout EyePath path) {
    while (bounces_of(path.at.flags) < params.max_depth && path.at.met < MOST_MET) {
        bool fresh = path.steps == int(params.step_budget);
        path.steps -= vertex_steps();
        Hit hit;
        uint found = trace(path.at.origin, path.at.direction, NEAREST, path.steps, hit);
        if (found == TRACE_UNFINISHED) {
            leave_unfinished(path, fresh);
            break;
        }
        ++path.rays;
        ++path.at.met;
        if (found == TRACE_MISS) {
            meet_nothing(path);
            break;
        }
        Vertex vertex = meet(path, hit);
        if (!is_there(path, vertex)) {
            path.at.origin = leave(vertex.surface, path.at.direction);
            continue;
        }
        ++path.at.flags;
        describe(path, vertex);
        if (is_unlit(vertex)) {
            meet_unlit(path, vertex);
            break;
        }
        meet_emission(path, vertex);
        weigh_lobes(path, vertex);
        if (vertex.asks) ask(path, vertex);
        uint lobe = choose(path, vertex);
        if (lobe == LOBE_NONE) break;
        if (lobe == LOBE_DIFFUSE) {
            gather(path, vertex);
            break;
        }
        if (!HAS_REFLECTION && !HAS_TRANSMISSION) break;
        if (!follow(path, vertex, lobe)) break;
    }
}

// Traces the rays to the lights that the path has asked for, if any.
void follow_light_rays(inout EyePath path) {
    while (has_light_ray(path.light_rays)) {
        bool fresh = path.steps == int(params.step_budget);
        path.steps -= vertex_steps();
        LightRay ray = path.light_rays.of[0];
        Hit hit;
        uint found = trace(ray.origin, ray.direction, before_light(ray), path.steps, hit);
        if (found == TRACE_UNFINISHED) {
            path.at.end = path.position.state;
            leave_unfinished(path, fresh);
            break;
        }
        ++path.rays;
        go_on_with_light_ray(path, found, hit);
    }
}

// True where the pixel has no starting radius, and looks for it in this iteration: where there are too few photons
// about that may never end, so it looks in those iterations whose number, of those that it gathered in, is a power of
// two.
bool searches_now(uint pixel) {
    PixelState state = pixels_at(pixel);
    return state.seeded == 0u && (state.seen & (state.seen - 1u)) == 0u;
}

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_EYE)) return;
    EyePath path = begin_eye_path(pixel);
    if (launch.round == 0u) {
        camera_ray(picture_pixel(pixel), launch.iteration, path.at.origin, path.at.direction, path.at.distance);
    } else {
        if (!load(path)) return;
    }
    bool begins = path.at.met == 0u;
    if (path.at.end == HIT_UNFINISHED) follow_path(path);
    // A loop of its own: software Vulkan runs all of a loop's code for every ray of it, and this one hardly shades.
    if (EYE_PATHS_ASK && path.position.state != HIT_UNFINISHED) follow_light_rays(path);
    store(path);
    // The knn pass, which has little to do after the first iterations, goes through these alone.
    if (gathers(path.position) && searches_now(pixel)) {
        uint place = atomicAdd(status.searches, 1u);
        if (place < pixel_count()) searches[place] = pixel;
    }
    if (begins && path.rays > 0u) --path.rays;  // the host knows of the first of every pixel
    if (path.rays > 0u) count_rays(path.rays);
}
