// The one descriptor set: what is bound where. Every kernel uses this layout.
#ifdef __cplusplus
#pragma once
#endif
// Uniform buffer.
#define BIND_PARAMS 0
// Texel buffers.
#define BIND_NODES 1           // usamplerBuffer, 4 texels a BvhNode
#define BIND_TRIANGLES 2       // samplerBuffer, 3 texels a TriangleGeometry
#define BIND_SHADING 3         // usamplerBuffer, 1 texel a TriangleShading
#define BIND_SORTED_TEXELS 4   // usamplerBuffer over BIND_SORTED
#define BIND_FLUX_TEXELS 5     // usamplerBuffer over BIND_SORTED_FLUX
#define BIND_MATERIALS 6       // usamplerBuffer, 2 texels a SurfaceMaterial
#define BIND_LIGHTS 7          // usamplerBuffer, 4 texels a Light
#define BIND_COUNTER_TEXELS 8  // usamplerBuffer over BIND_COUNTERS, a word a texel
// Storage buffers.
#define BIND_HIT_POSITION 9
#define BIND_HIT_WEIGHT 10
#define BIND_HIT_EMISSION 11
#define BIND_GATHERED 12
#define BIND_PIXELS 13
#define BIND_TALLY 14          // [bins x P] counts
#define BIND_FILM 15
#define BIND_PHOTONS 16        // [lanes x capacity] Photon, as traced
#define BIND_PHOTON_FLUX 17
#define BIND_PATHS 18          // [lanes] PathState
#define BIND_SORTED 19         // [N] Photon in cell order
#define BIND_SORTED_FLUX 20
#define BIND_PAIRS_A 21        // [N] (cell, slot)
#define BIND_PAIRS_B 22
#define BIND_COUNTERS 23       // lane counts, cell starts, radix histogram, scan blocks
#define BIND_GRID 24
#define BIND_STATUS 25
#define BIND_CURSOR 26
#define BIND_NEAREST 27        // [knn x P] squared distances, while pixels are seeded
#define BIND_IMAGE 28
#define BIND_MOMENTS 29        // [moments x P] float sums of estimators that weigh photons
#define BIND_QUANTILES 30      // [rings x F_QUANTILES] thresholds of the F-tests
#define BIND_AOVS 31           // [P] Aovs, where they are asked for
#define BIND_COUNT 32
#define BIND_FIRST_TEXEL 1
#define BIND_FIRST_STORAGE 9
