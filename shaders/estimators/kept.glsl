// What an estimator keeps of a pixel besides PixelState: of the buffers tally and moments those are declared that its
// row of shared/estimators.h keeps, so that a file that uses the other does not compile.
#ifndef KEPT_GLSL
#define KEPT_GLSL

#include "include/kernel.glsl"
#include "shared/estimators.h"
#include "estimators/sectors.glsl"

// A row of either. Neighbours stand together in memory.
uint row_of(uint row, uint pixel) { return row * pixel_count() + pixel; }

#define DECLARE_TALLY(rows) \
    TALLY(STORES)           \
    TALLY(TEXELS)           \
    uint tally_at(uint row, uint pixel) { return texelFetch(tally_texels, int(row_of(row, pixel))).x; }
#define DECLARE_MOMENTS(rows) \
    MOMENTS(STORES)           \
    MOMENTS(TEXELS)           \
    float moment_at(uint row, uint pixel) { \
        return uintBitsToFloat(texelFetch(moments_texels, int(row_of(row, pixel))).x); \
    }
KEEPS(DECLARE_TALLY, DECLARE_MOMENTS, DISC_CELLS, RINGS)

#define CLEAR_TALLY(rows) for (uint row = 0u; row < (rows); ++row) tally[row_of(row, pixel)] = 0u;
#define CLEAR_MOMENTS(rows) for (uint row = 0u; row < (rows); ++row) moments[row_of(row, pixel)] = 0.0;
void clear_statistics(uint pixel) { KEEPS(CLEAR_TALLY, CLEAR_MOMENTS, DISC_CELLS, RINGS) }

#endif
