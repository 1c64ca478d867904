// CPPM: Lin et al. 2020, Algorithm 1. The radius stays while the photons in the disc pass a chi-squared test for a
// uniform density; it shrinks where they fail.

void cppm_record(Accepted photon) { count(cell_bin(photon.v, photon.q)); }

// Chi-squared statistic of uniformity over the disc of the first `rings` rings, sum((c O - S)^2) / (c S), over its
// threshold. An empty disc passes.
float uniform_ratio(uint rings) {
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
