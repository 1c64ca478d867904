// Algorithm 1 of Lin et al. 2020, shared by every estimator that tests the disc.

// Statistic of the disc of the first `rings` rings over its threshold: below 1 the null hypothesis stands.
float test_ratio(uint pixel, uint rings, PixelState state) {
    switch (ESTIMATOR) {
        case ESTIMATOR_CPPM_LF: return linear_ratio(pixel, rings);
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD: return f_ratio(pixel, rings, state.count);
        default: return uniform_ratio(pixel, rings);
    }
}

void clear_statistics(uint pixel) {
    switch (ESTIMATOR) {
        case ESTIMATOR_SPPM:
        case ESTIMATOR_SPPM_KZ:
        case ESTIMATOR_CPPM_NULL: break;
        case ESTIMATOR_APPM:
            for (uint row = 0u; row < APPM_MOMENTS; ++row) moments[row_of(row, pixel)] = 0.0;
            break;
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD:
            for (uint row = 0u; row < 2u * DISC_CELLS + RINGS; ++row) moments[row_of(row, pixel)] = 0.0;
            break;
        default:
            for (uint row = 0u; row < DISC_CELLS; ++row) tally[row_of(row, pixel)] = 0u;
            break;
    }
}

// Once a batch is full, the disc is tested in every iteration. After a rejection the largest inner disc that passes
// becomes the disc (rings have equal areas), or the area shrinks by k where none does; the statistics start again and
// the batch grows by beta.
void algorithm1_update(uint pixel, uint found, inout PixelState state) {
    state.total += found;
    if (float(state.total) < state.batch) return;
    state.statistic = test_ratio(pixel, RINGS, state);
    if (state.statistic < 1.0) return;
    float factor = params.k;
    for (uint rings = RINGS - 1u; rings > 0u; --rings) {
        if (test_ratio(pixel, rings, state) < 1.0) {
            factor = float(rings) / float(RINGS);
            break;
        }
    }
    state.radius2 *= factor;
    state.total = 0u;
    state.count = 0.0;
    state.batch *= params.beta;
    ++state.rejections;
    clear_statistics(pixel);
}
