// Regions of the counter buffer of this render: shared/types.h.
#ifndef COUNTERS_GLSL
#define COUNTERS_GLSL

#include "include/kernel.glsl"

#define PATH_COUNTS COUNTERS_OF_PATHS(params)
#define PHOTON_TOTAL COUNTER_OF_PHOTONS(params)
#define PATH_SLOTS COUNTERS_OF_SLOTS(params)
#define RADIX_COUNTS COUNTERS_OF_RADIX(params)
#define SCAN_SUMS COUNTERS_OF_SCAN(params, DIGIT_BITS)

// Photons, once a level of the grid. For those that include grid.glsl.
#define SORTED_TOTAL (counters[PHOTON_TOTAL] * grid.levels)

#endif
