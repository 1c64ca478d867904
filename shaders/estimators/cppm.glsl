// CPPM: Lin et al. 2020, Algorithm 1. The radius stays while the photons in the disc pass a chi-squared test for a
// uniform density; it shrinks where they fail.

void cppm_record(Accepted photon) { count(cell_bin(photon.v, photon.q)); }

uint tally_sum(uint pixel, uint cells) {
    uint sum = 0u;
    for (uint bin = 0u; bin < cells; ++bin) sum += tally[row_of(bin, pixel)];
    return sum;
}

// Chi-squared statistic of uniformity over the disc of the first `rings` rings, sum((c O - S)^2) / (c S), over its
// threshold. An empty disc passes.
float uniform_ratio(uint pixel, uint rings) {
    uint cells = rings * RING_CELLS;
    uint sum = tally_sum(pixel, cells);
    if (sum == 0u) return 0.0;
    float statistic = 0.0;
    for (uint bin = 0u; bin < cells; ++bin) {
        float difference = scaled_difference(cells, tally[row_of(bin, pixel)], sum);
        statistic += difference * (difference / (float(cells) * float(sum)));
    }
    return statistic / params.threshold[rings - 1u];
}
