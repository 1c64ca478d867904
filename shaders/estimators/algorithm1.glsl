// Algorithm 1 of Lin et al. 2020, shared by every estimator that tests the disc.
#ifndef ALGORITHM1_GLSL
#define ALGORITHM1_GLSL

#include "include/pixels.glsl"
#include "estimators/kept.glsl"

// Of the estimator: reads what it keeps, once for all tests of an iteration.
void read_statistics(uint pixel);
// Of the estimator: the statistic of the disc of the first `rings` rings over its threshold; below 1 the null
// hypothesis stands.
float test_ratio(uint rings, PixelState state);

// Starts the statistics again with the disc as it is.
void forget(uint pixel, inout PixelState state) {
    state.total = 0u;
    state.count = 0.0;
    state.count_low = 0.0;
    clear_statistics(pixel);
}

// Once a batch is full, the disc is tested in every iteration. After a rejection the largest inner disc that passes
// becomes the disc (rings have equal areas), or the area shrinks by k where none does; the statistics start again and
// the batch grows by beta. A disc that has passed with as many photons as counters hold starts them again, too.
void algorithm1(uint pixel, uint found, inout PixelState state) {
    state.total += found;  // an iteration stores fewer than 2^27 photons: no sum of the tally reaches 2^31
    if (!batch_is_full(state)) return;
    read_statistics(pixel);
    state.statistic = test_ratio(RINGS, state);
    if (state.statistic < 1.0) {
        if (float(state.total) >= MOST_PHOTONS) forget(pixel, state);
        return;
    }
    float factor = params.k;
    for (uint rings = RINGS - 1u; rings > 0u; --rings) {
        if (test_ratio(rings, state) < 1.0) {
            factor = float(rings) / float(RINGS);
            break;
        }
    }
    state.radius2 *= factor;
    state.batch *= params.beta;
    ++state.rejections;
    forget(pixel, state);
}

#endif
