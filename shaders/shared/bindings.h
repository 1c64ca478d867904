// The one descriptor set: what is bound where. Every kernel uses this layout.
#ifdef __cplusplus
#pragma once
#endif
// Uniform buffer.
#define BIND_PARAMS 0
// Texel buffers: software Vulkan reads a texel of four words for the lanes of a SIMD group at once, and every word of a
// storage buffer lane by lane. What an invocation has stored it does not read as texels in the same launch.
#define BIND_NODES 1                 // usamplerBuffer, 4 texels a BvhNode
#define BIND_TRIANGLES 2             // samplerBuffer, 3 texels a TriangleGeometry
#define BIND_SHADING 3               // usamplerBuffer, 1 texel a TriangleShading
#define BIND_SORTED_TEXELS 4         // usamplerBuffer over BIND_SORTED
#define BIND_SORTED_FLUX_TEXELS 5    // usamplerBuffer over BIND_SORTED_FLUX
#define BIND_MATERIALS 6             // usamplerBuffer, 9 texels a SurfaceMaterial
#define BIND_LIGHTS 7                // usamplerBuffer, 6 texels a Light
#define BIND_COUNTER_TEXELS 8        // usamplerBuffer over BIND_COUNTERS, a word a texel
#define BIND_TEXCOORDS 9             // samplerBuffer, 3 texels a triangle: (u, v) of set 0 and of set 1 a corner
#define BIND_VERTEX_COLORS 10        // usamplerBuffer, 2 texels a triangle: 4 half floats a corner, then 2 unused words
#define BIND_TANGENTS 11             // usamplerBuffer, 1 texel a triangle: an octahedral tangent a corner; last word:
                                     // per corner bit c: there is one, bit c + 3: its bitangent points the other way
#define BIND_TEXTURES 12             // usamplerBuffer, 3 texels a TextureLookup
#define BIND_TEXELS 13               // usamplerBuffer, 1 word a texel of an image: 8 bits a channel
#define BIND_ENVIRONMENT 14          // samplerBuffer, 1 texel a pixel: radiance, keep of its alias table
#define BIND_ENVIRONMENT_ALIAS 15    // usamplerBuffer, 2 words a pixel: its other entry, environment_area
#define BIND_PHOTON_TEXELS 16        // usamplerBuffer over BIND_PHOTONS
#define BIND_PHOTON_FLUX_TEXELS 17   // usamplerBuffer over BIND_PHOTON_FLUX
#define BIND_HIT_POSITION_TEXELS 18  // usamplerBuffer over BIND_HIT_POSITION
#define BIND_HIT_WEIGHT_TEXELS 19    // usamplerBuffer over BIND_HIT_WEIGHT
#define BIND_HIT_EMISSION_TEXELS 20  // usamplerBuffer over BIND_HIT_EMISSION
#define BIND_HIT_SURFACE_TEXELS 21   // usamplerBuffer over BIND_HIT_SURFACE
#define BIND_GATHERED_TEXELS 22      // usamplerBuffer over BIND_GATHERED, 2 texels a pixel
#define BIND_PIXEL_TEXELS 23         // usamplerBuffer over BIND_PIXELS, 3 texels a pixel
#define BIND_TALLY_TEXELS 24         // usamplerBuffer over BIND_TALLY, a word a texel
#define BIND_MOMENT_TEXELS 25        // usamplerBuffer over BIND_MOMENTS, a word a texel
#define BIND_FILM_TEXELS 26          // usamplerBuffer over BIND_FILM, a word a texel
// Storage buffers.
#define BIND_HIT_POSITION 27
#define BIND_HIT_WEIGHT 28
#define BIND_HIT_EMISSION 29
#define BIND_GATHERED 30
#define BIND_PIXELS 31
#define BIND_TALLY 32          // [bins x P] counts
#define BIND_FILM 33
#define BIND_PHOTONS 34        // [lanes x capacity] Photon, as traced
#define BIND_PHOTON_FLUX 35
#define BIND_PATHS 36          // [lanes] PathState; of the path tracer: [P] TraceState
#define BIND_SORTED 37         // [N] Photon in cell order
#define BIND_SORTED_FLUX 38
#define BIND_PAIRS_A 39        // [N] (cell, slot)
#define BIND_PAIRS_B 40
#define BIND_COUNTERS 41       // cell starts, photons of the paths, radix histogram, scan blocks
#define BIND_GRID 42
#define BIND_STATUS 43
#define BIND_CURSOR 44
#define BIND_NEAREST 45        // [knn x P] squared distances, while pixels are seeded
#define BIND_IMAGE 46
#define BIND_MOMENTS 47        // [moments x P] float sums of estimators that weigh photons
#define BIND_QUANTILES 48      // [rings x F_QUANTILES] thresholds of the F-tests
#define BIND_AOVS 49           // [P] Aovs, where they are asked for
#define BIND_HIT_SURFACE 50    // [P] HitSurface, in glossy scenes
#define BIND_LIGHT_RAYS 51     // [P] LightRay, where eye paths ask for lights
#define BIND_SEARCHES 52       // [P] pixels that look for a starting radius
#define BIND_COUNT 53
#define BIND_FIRST_TEXEL 1
#define BIND_FIRST_STORAGE 27
