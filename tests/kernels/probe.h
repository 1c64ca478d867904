// What the probes of this folder and their tests share: bindings, inputs and outputs. Compiled by g++ and by glslc,
// there after include/kernel.glsl.
#ifdef __cplusplus
#pragma once
#include "shared/bindings.h"
#include "shared/types.h"
namespace vkcppm::gpu {
#endif

// Storage bindings that no header under test declares.
#define PROBE_INPUT BIND_PATHS
#define PROBE_OUTPUT BIND_IMAGE

struct RngKey {
    uint seed;
    uint iteration;
    uint stream;
    uint path;
    uint dimension;
};
struct RngSample {
    uvec4 hash;          // pcg4d of (seed, iteration, stream, path)
    vec4 random;         // random4
    float stratified;    // of (seed, iteration, path, dimension)
};

struct FrameSample {
    uint word;           // packed
    vec3 unpacked;
    vec3 tangent;
    vec3 bitangent;
    vec3 tilted;         // from_frame of (0.6, 0.0, 0.8)
};

struct WarpInput {
    vec2 u;
    float inner;         // cosines of a spot light's cones
    float outer;
};
struct WarpOutput {
    vec3 cosine;
    vec2 triangle;
    vec2 disc;
    vec3 sphere;         // sample_azimuth of a uniform cosine
    float spot;
};

struct EmitInput {
    vec4 u;
    vec4 v;
};
struct EmitOutput {
    vec3 origin;
    vec3 direction;
    vec3 power;
};

struct ScatterInput {
    vec3 direction;
    vec3 normal;
    vec3 geometric;
    float u;
    uint front;
    uint material;
    uint radiance;
};
struct ScatterOutput {
    vec3 direction;
    vec3 factor;
    float reflectance;   // fresnel_dielectric
    float cosine_t;
    vec3 metal;          // fresnel_metal of the material's color
};

struct RayInput {
    vec3 origin;
    vec3 direction;
};
struct RayOutput {
    uint found;          // TRACE_*
    float t;
    uint triangle;
    vec2 barycentric;
    int steps;           // spent
};
struct SurfaceOutput {
    uint found;
    uint triangle;
    vec3 position;
    vec3 geometric;
    vec3 normal;
    float error;
    uint front;
    uint material;
    vec3 outside;        // leave() against the ray
    vec3 inside;         // leave() along the ray
};

#ifdef __cplusplus
}  // namespace vkcppm::gpu
#endif
