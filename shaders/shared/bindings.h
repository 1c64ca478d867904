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
#define BIND_ENVIRONMENT_ALIAS 15  // usamplerBuffer, 1 word a pixel
// Storage buffers.
#define BIND_HIT_POSITION 16
#define BIND_HIT_WEIGHT 17
#define BIND_HIT_EMISSION 18
#define BIND_GATHERED 19
#define BIND_PIXELS 20
#define BIND_TALLY 21          // [bins x P] counts
#define BIND_FILM 22
#define BIND_PHOTONS 23        // [lanes x capacity] Photon, as traced
#define BIND_PHOTON_FLUX 24
#define BIND_PATHS 25          // [lanes] PathState; of the path tracer: [P] TraceState
#define BIND_SORTED 26         // [N] Photon in cell order
#define BIND_SORTED_FLUX 27
#define BIND_PAIRS_A 28        // [N] (cell, slot)
#define BIND_PAIRS_B 29
#define BIND_COUNTERS 30       // lane counts, cell starts, radix histogram, scan blocks
#define BIND_GRID 31
#define BIND_STATUS 32
#define BIND_CURSOR 33
#define BIND_NEAREST 34        // [knn x P] squared distances, while pixels are seeded
#define BIND_IMAGE 35
#define BIND_MOMENTS 36        // [moments x P] float sums of estimators that weigh photons
#define BIND_QUANTILES 37      // [rings x F_QUANTILES] thresholds of the F-tests
#define BIND_AOVS 38           // [P] Aovs, where they are asked for
#define BIND_HIT_SURFACE 39    // [P] HitSurface, in glossy scenes
#define BIND_COUNT 40
#define BIND_FIRST_TEXEL 1
#define BIND_FIRST_STORAGE 16
