// What the probes of this folder and their tests share: bindings, inputs and outputs. Compiled by g++ and by glslc,
// there after include/kernel.glsl.
#ifdef __cplusplus
#pragma once
#include "shared/types.h"
#include "vk/binding.h"
#endif

// Storage bindings that no header under test declares.
#ifdef __cplusplus
namespace vkcppm {
inline constexpr Binding PROBE_INPUT = Binding::paths;
inline constexpr Binding PROBE_OUTPUT = Binding::image;
inline constexpr Binding PROBE_VIEW = Binding::grid;
}  // namespace vkcppm

namespace vkcppm::gpu {
#else
#define PROBE_INPUT PATHS(BINDING_NUMBER)
#define PROBE_OUTPUT IMAGE(BINDING_NUMBER)
#define PROBE_VIEW GRID(BINDING_NUMBER)
#endif

struct RngKey {
    uint seed;
    uint iteration;
    uint stream;
    uint path;
    uint dimension;
};
struct RngSample {
    uvec4 hash;        // pcg4d of (seed, iteration, stream, path)
    vec4 random;       // random4
    float stratified;  // of (seed, iteration, path, dimension)
};

struct FrameSample {
    uint word;  // packed
    vec3 unpacked;
    vec3 tangent;
    vec3 bitangent;
    vec3 tilted;  // from_frame of (0.6, 0.0, 0.8)
};

struct WarpInput {
    vec2 u;
    float inner;  // cosines of a spot light's cones
    float outer;
};
struct WarpOutput {
    vec3 cosine;
    vec2 triangle;
    vec2 disc;
    vec3 sphere;  // sample_azimuth of a uniform cosine
    float spot;
};

struct EmitInput {
    uvec4 bits;
    vec4 v;
};
struct EmitOutput {
    vec3 origin;
    vec3 direction;
    vec3 power;
    uint kind;      // LIGHT_*
    vec3 radiance;  // of the environment, against the direction
};

struct LampInput {
    vec3 position;
    uint lamp;  // branch << 1 | which child
    uint word;
    vec2 v;
};
struct LampOutput {
    uint first;  // of the lamp that the word chooses; count 0: none
    uint count;
    float probability;
    uint word;       // what is left of it
    float of_input;  // the probability of the input's lamp
};

struct ScatterInput {
    vec3 direction;
    vec3 normal;
    vec3 geometric;
    float u;  // chooses the lobe
    uint front;
    uint material;
    uint radiance;
};
struct ScatterOutput {
    vec3 direction;
    vec3 factor;        // of the lobe that was followed
    uint lobe;          // LOBE_*
    float probability;  // of that lobe
    float density;
    float reflectance;  // fresnel_dielectric
    float cosine_t;
    vec3 facet;  // facet_reflectance
};

struct BsdfView {
    vec3 outgoing;  // unit, on the side of the normals
    vec3 geometric;
    vec3 normal;
    vec3 clearcoat_normal;
    vec3 tangent;
    uint material;
    uint front;
    uint lobe;  // to follow; LOBE_NONE: each by its probability
    uint radiance;
};
struct BsdfInput {
    vec3 incoming;  // unit, away from the surface
    vec3 u;
};
struct BsdfOutput {
    uint lobe;          // LOBE_*
    float probability;  // of that lobe
    vec3 direction;
    vec3 weight;  // of sample_lobe
    float density;
    float followed;  // followed_weight
    float width;     // of the lobe: width_of
    uint sides;      // gathering_sides
    float scatter;   // scatter_density of the direction, lobes chosen by their probability
    vec3 value;      // rough_bsdf of all light
    vec3 gathered;   // of light that following the lobe finds, too
};

struct TextureInput {
    vec4 coordinates;
    uint texture;  // 1 + index of a TextureLookup
    uint triangle;
    vec2 barycentric;
    vec3 direction;  // towards the surface
};
struct TextureOutput {
    vec4 value;  // of the texture, or base colour and opacity
    vec3 emission;
    vec4 metal;  // metallic, roughness, transmission, specular
    vec3 specular_color;
    vec2 clearcoat;  // and its roughness
    float coverage;
    vec3 geometric;
    vec3 normal;
    vec3 clearcoat_normal;
    vec3 tangent;
    float anisotropy;
    vec2 film;   // its share and thickness
    vec4 sheen;  // its colour and roughness
};

struct WavelengthInput {
    float wavelength;  // micrometres
    float ior;
    float cauchy;
};
struct WavelengthOutput {
    float drawn;  // of path i
    vec3 weight;
    float index;
};

struct RayInput {
    vec3 origin;
    vec3 direction;
};
struct OcclusionInput {
    vec3 origin;
    vec3 direction;
    float within;
    uint but;  // a triangle, or NO_TRIANGLE
};
struct RayOutput {
    uint found;  // TRACE_*
    float t;
    uint triangle;
    vec2 barycentric;
    int steps;  // spent
    uint instance;
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
    vec3 outside;  // leave() against the ray
    vec3 inside;   // leave() along the ray
    uint instance;
};

#ifdef __cplusplus
}  // namespace vkcppm::gpu
#endif
