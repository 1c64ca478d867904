// Where eye paths start.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

#include "include/kernel.glsl"
#include "include/bounds.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"

#define LENS_DIMENSION 6u  // stratified dimensions 0 and 1 place the ray in the pixel, 6 and 7 on the lens

// Ray number `sequence` of a pixel, through a random point of it (box filter) and of the lens; distance: from the eye
// to `origin`, at the scene's bounds. It begins in the plane of depth `start`, for whose points the host has taken the
// eye's distance into account in double precision: from far away a direction in floats would miss what it aims at.
void camera_ray(uint pixel, uint sequence, out vec3 origin, out vec3 direction, out float distance) {
    vec2 jitter = vec2(stratified(params.seed, sequence, pixel, 0u),
                       stratified(params.seed, sequence, pixel, 1u));
    vec2 raster = vec2(pixel % params.width, pixel / params.width) + jitter;
    vec2 image_plane = 2.0 * raster / vec2(params.width, params.height) - 1.0;
    vec3 through = params.forward + image_plane.x * params.right - image_plane.y * params.up;
    vec3 eye = params.eye + params.start * (image_plane.x * params.right - image_plane.y * params.up);
    if (params.orthographic != 0u) {
        through = params.forward;
        eye = params.eye + image_plane.x * params.right - image_plane.y * params.up;
    }
    distance = params.start * length(through);
    if (params.lens_radius > 0.0) {
        // A thin lens: what lies in the plane of focus is met by rays from all of it.
        vec2 u = vec2(stratified(params.seed, sequence, pixel, LENS_DIMENSION),
                      stratified(params.seed, sequence, pixel, LENS_DIMENSION + 1u));
        vec2 lens = params.lens_radius * sample_disc(u);
        vec3 offset = lens.x * normalize(params.right) + lens.y * normalize(params.up);
        eye += offset * (1.0 - params.start / params.focus_distance);
        through = through * params.focus_distance - offset;
    }
    direction = normalize(through);
    origin = enter_bounds(eye, direction);
    distance += length(origin - eye);
}

// Radius of the footprint of a pixel, `distance` from the eye along its ray; frame units.
float footprint_at(float distance) { return params.pixel_radius * (params.orthographic != 0u ? 1.0 : distance); }

#endif
