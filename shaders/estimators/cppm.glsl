// CPPM: Lin et al. 2020, Algorithm 1. The radius stays while the photons in the disc pass a chi-squared test for a
// uniform density; it shrinks where they fail.

void cppm_record(uint pixel, vec2 v, float q) { ++tally[tally_index(sector_bin(v, q), pixel)]; }

// Chi-squared test of uniformity over the disc of the first `rings` rings: sum((c O - S)^2) / (c S) < quantile. An
// empty disc passes.
bool cppm_pass(uint pixel, uint rings) {
    uint cells = rings * SECTORS;
    uint sum = 0u;
    for (uint bin = 0u; bin < cells; ++bin) sum += tally[tally_index(bin, pixel)];
    if (sum == 0u) return true;
    float statistic = 0.0;
    for (uint bin = 0u; bin < cells; ++bin) {
        float difference = scaled_difference(cells, tally[tally_index(bin, pixel)], sum);
        statistic += difference * (difference / (float(cells) * float(sum)));
    }
    return statistic < params.threshold[rings - 1u];
}

// After a rejection: the largest inner disc that passes becomes the disc (areas of rings are equal), or the area
// shrinks by k where none does. The tally starts again and the batch grows by beta.
void cppm_update(uint pixel, uint found, inout PixelState state) {
    state.total += found;
    if (float(state.total) < state.batch || cppm_pass(pixel, RINGS)) return;
    float factor = params.k;
    for (uint rings = RINGS - 1u; rings > 0u; --rings) {
        if (cppm_pass(pixel, rings)) {
            factor = float(rings) / float(RINGS);
            break;
        }
    }
    state.radius2 *= factor;
    state.total = 0u;
    state.batch *= params.beta;
    ++state.rejections;
    clear_tally(pixel);
}
