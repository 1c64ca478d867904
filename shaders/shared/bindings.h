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
#define BIND_SORTED_TEXELS 4   // samplerBuffer over BIND_SORTED
#define BIND_FLUX_TEXELS 5     // samplerBuffer over BIND_SORTED_FLUX
// Storage buffers.
#define BIND_MATERIALS 6
#define BIND_LIGHTS 7
#define BIND_HIT_POSITION 8
#define BIND_HIT_WEIGHT 9
#define BIND_HIT_EMISSION 10
#define BIND_GATHERED 11
#define BIND_PIXELS 12
#define BIND_TALLY 13          // [bins x P] counts
#define BIND_FILM 14
#define BIND_PHOTONS 15        // [lanes x capacity] Photon, as traced
#define BIND_PHOTON_FLUX 16
#define BIND_PATHS 17          // [lanes] PathState
#define BIND_SORTED 18         // [N] Photon in cell order
#define BIND_SORTED_FLUX 19
#define BIND_PAIRS_A 20        // [N] (cell, slot)
#define BIND_PAIRS_B 21
#define BIND_COUNTERS 22       // lane counts, cell starts, radix histogram, scan blocks
#define BIND_GRID 23
#define BIND_STATUS 24
#define BIND_CURSOR 25
#define BIND_NEAREST 26        // [knn x P] squared distances, while pixels are seeded
#define BIND_IMAGE 27
#define BIND_MOMENTS 28        // [moments x P] float sums of estimators that weigh photons
#define BIND_QUANTILES 29      // [rings x F_QUANTILES] thresholds of the F-tests
#define BIND_AOVS 30           // [P] Aovs, where they are asked for
#define BIND_COUNT 31
#define BIND_FIRST_TEXEL 1
#define BIND_FIRST_STORAGE 6
