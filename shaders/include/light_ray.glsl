// Rays that ask for a light (next-event estimation). Surfaces that are partly there let that part pass, panes what goes
// straight on through them, but where light is split; all others stop them, glass too. Pure functions.
#ifndef LIGHT_RAY_GLSL
#define LIGHT_RAY_GLSL

#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/light.glsl"
#include "include/path.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"
#include "include/traverse.glsl"

// Rays to lights may go on behind a surface.
const bool LIGHT_RAYS_PASS = (FEATURES & (FEATURE_ALPHA | FEATURE_THIN)) != 0u;

const float POSITION_ERROR = 1e-6;  // frame units, as the smallest radius

LightRay no_light_ray() { return LightRay(vec3(0.0), 0.0, vec3(0.0), NO_TRIANGLE, vec3(0.0), LAYER_REST); }

LightRays no_light_rays() {
    LightRays rays;
    for (uint g = 0u; g < ASKED_GROUPS; ++g) rays.of[g] = no_light_ray();
    return rays;
}

// True while there is a ray to trace: the first.
bool has_light_ray(inout LightRays rays) {
    for (uint g = 1u; g < GROUPS && !(rays.of[0].distance > 0.0); ++g) {
        for (uint i = 1u; i < GROUPS; ++i) rays.of[i - 1u] = rays.of[i];
        rays.of[GROUPS - 1u].distance = 0.0;
    }
    return rays.of[0].distance > 0.0;
}

// What the solid that the ray goes through lets pass. flags, media: of the path that asks, at the surface.
vec3 transmittance_to(LightSample light, uint flags, uvec2 media, Bsdf bsdf, Surface surface) {
    if (!HAS_VOLUME) return vec3(1.0);
    bool through = dot(light.direction, surface.geometric) < 0.0;
    pass_boundary(flags, media, bsdf, through ? LOBE_TRANSMISSION : LOBE_NONE, surface);
    uint medium = medium_of(flags);
    // To a light that is infinitely far away nothing gets through what absorbs.
    return medium == PATH_NO_MEDIUM ? vec3(1.0) : exp(-min(light.distance * absorption_of(medium), vec3(100.0)));
}

// From the surface to the light. contribution: what it adds to the picture where nothing is in between, to that layer.
LightRay ray_to(LightSample light, vec3 contribution, uint layer, Surface surface) {
    vec3 origin = leave(surface, light.direction);
    float distance = light.distance - dot(origin - surface.position, light.direction);
    if (!any(greaterThan(contribution, vec3(0.0)))) distance = 0.0;
    return LightRay(origin, distance, light.direction, light.triangle, contribution, layer);
}

// One of two rays in proportion to what they add, for the sum of both; u in [0, 1).
void take_one(inout LightRay ray, LightRay other, float u) {
    float a = ray.distance > 0.0 ? ray.light.r + ray.light.g + ray.light.b : 0.0;
    float b = other.distance > 0.0 ? other.light.r + other.light.g + other.light.b : 0.0;
    bool takes = u * (a + b) < b;
    if (takes) ray = other;
    if (a + b > 0.0) ray.light *= (a + b) / (takes ? b : a);
}

// What is in between, but for what is as near to the light as positions are known: of a lamp that is no larger the ray
// may meet another triangle than it was aimed at.
Sought before_light(LightRay ray) { return Sought(ray.distance - POSITION_ERROR, ray.triangle, !LIGHT_RAYS_PASS); }

// What of light passes a surface to go straight on.
vec3 passes_straight(Surface surface, SurfaceMaterial material, vec3 direction) {
    float coverage = HAS_ALPHA ? coverage_of(material) : 1.0;
    vec3 passes = vec3(1.0 - coverage);
    if (HAS_THIN) {
        Bsdf b = bsdf_of(material, material.ior, surface.front);
        bool unlit = HAS_UNLIT && has(material, SURFACE_UNLIT);
        if (is_pane(b) && !unlit) passes += coverage * pane_transmittance(b, surface, -direction);
    }
    return passes;
}

// The ray has met a surface, `t` away, and goes on behind it with what passes.
void pass_surface(inout LightRay ray, Surface surface, float t, vec3 passes) {
    ray.light *= passes;
    ray.origin = leave(surface, ray.direction);
    ray.distance = any(greaterThan(passes, vec3(0.0))) ? max(1e-30, ray.distance - t) : 0.0;
}

#endif
