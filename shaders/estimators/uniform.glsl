// The chi-squared test of a uniform density.
#ifndef UNIFORM_GLSL
#define UNIFORM_GLSL

#include "estimators/tally.glsl"

// Chi-squared statistic of uniformity over the disc of the first `rings` rings, sum((c O - S)^2) / (c S), over its
// threshold. An empty disc passes.
float test_ratio(uint rings, PixelState state) {
    uint cells = rings * RING_CELLS;
    uint sum = observed_in(cells);
    if (sum == 0u) return 0.0;
    float squares = 0.0;
    for (uint bin = 0u; bin < cells; ++bin) {
        float difference = scaled_difference(cells, observed[bin], sum);
        squares += difference * difference;
    }
    return squares / (float(cells) * float(sum) * params.threshold[rings - 1u]);
}

#endif
