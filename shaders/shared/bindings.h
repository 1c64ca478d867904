// The one descriptor set: what is bound where. Every kernel uses this layout.
#ifdef __cplusplus
#pragma once
#endif
// Uniform buffer.
#define BIND_PARAMS 0
// Texel buffers. (Vulkan promises 16 of them to a stage.)
#define BIND_NODES 1               // usamplerBuffer, 4 texels a BvhNode
#define BIND_TRIANGLES 2           // samplerBuffer, 3 texels a TriangleGeometry
#define BIND_SHADING 3             // usamplerBuffer, 1 texel a TriangleShading
#define BIND_SORTED_TEXELS 4       // usamplerBuffer over BIND_SORTED
#define BIND_FLUX_TEXELS 5         // usamplerBuffer over BIND_SORTED_FLUX
#define BIND_MATERIALS 6           // usamplerBuffer, 9 texels a SurfaceMaterial
#define BIND_LIGHTS 7              // usamplerBuffer, 6 texels a Light
#define BIND_COUNTER_TEXELS 8      // usamplerBuffer over BIND_COUNTERS, a word a texel
#define BIND_TEXCOORDS 9           // samplerBuffer, 3 texels a triangle: (u, v) of set 0 and of set 1 a corner
#define BIND_VERTEX_COLORS 10      // usamplerBuffer, 2 texels a triangle: 4 half floats a corner, then 2 unused words
#define BIND_TANGENTS 11           // usamplerBuffer, 1 texel a triangle: an octahedral tangent a corner; last word: per
                                   // corner bit c: there is one, bit c + 3: its bitangent points the other way
#define BIND_TEXTURES 12           // usamplerBuffer, 3 texels a TextureLookup
#define BIND_TEXELS 13             // usamplerBuffer, 1 word a texel of an image: 8 bits a channel
#define BIND_ENVIRONMENT 14        // samplerBuffer, 1 texel a pixel: radiance, keep of its alias table
#define BIND_ENVIRONMENT_ALIAS 15  // usamplerBuffer, 2 words a pixel: its other entry, environment_area
#define BIND_PHOTON_TEXELS 16      // usamplerBuffer over BIND_PHOTONS
// Storage buffers.
#define BIND_HIT_POSITION 17
#define BIND_HIT_WEIGHT 18
#define BIND_HIT_EMISSION 19
#define BIND_GATHERED 20
#define BIND_PIXELS 21
#define BIND_TALLY 22          // [bins x P] counts
#define BIND_FILM 23
#define BIND_PHOTONS 24        // [lanes x capacity] Photon, as traced
#define BIND_PHOTON_FLUX 25
#define BIND_PATHS 26          // [lanes] PathState; of the path tracer: [P] TraceState
#define BIND_SORTED 27         // [N] Photon in cell order
#define BIND_SORTED_FLUX 28
#define BIND_PAIRS_A 29        // [N] (cell, slot)
#define BIND_PAIRS_B 30
#define BIND_COUNTERS 31       // cell starts, photons of the paths, radix histogram, scan blocks
#define BIND_GRID 32
#define BIND_STATUS 33
#define BIND_CURSOR 34
#define BIND_NEAREST 35        // [knn x P] squared distances, while pixels are seeded
#define BIND_IMAGE 36
#define BIND_MOMENTS 37        // [moments x P] float sums of estimators that weigh photons
#define BIND_QUANTILES 38      // [rings x F_QUANTILES] thresholds of the F-tests
#define BIND_AOVS 39           // [P] Aovs, where they are asked for
#define BIND_HIT_SURFACE 40    // [P] HitSurface, in glossy scenes
#define BIND_LIGHT_RAYS 41     // [P] LightRay, where eye paths ask for lights
#define BIND_SEARCHES 42       // [P] pixels that look for a starting radius
#define BIND_COUNT 43
#define BIND_FIRST_TEXEL 1
#define BIND_FIRST_STORAGE 17
