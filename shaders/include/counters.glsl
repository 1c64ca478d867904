// Regions of the counter buffer, in words. The table of cell starts comes first: the searches index it directly.
// cell starts [cells + 1] | photons of each path, then their offsets [photons + 1] | slot of the first of each
// [photons] | radix histogram [digits x columns] | sums of scan blocks [scan_blocks].
#ifndef COUNTERS_GLSL
#define COUNTERS_GLSL

#include "include/kernel.glsl"

#define PATH_COUNTS (params.cells + 1u)
#define PHOTON_TOTAL (PATH_COUNTS + params.photons)
#define PATH_SLOTS (PHOTON_TOTAL + 1u)
#define RADIX_COUNTS (PATH_SLOTS + params.photons)
#define SCAN_SUMS (RADIX_COUNTS + (params.sort_lanes << DIGIT_BITS))

// Photons, once a level of the grid. For those that include grid.glsl.
#define SORTED_TOTAL (counters[PHOTON_TOTAL] * grid.levels)

#endif
