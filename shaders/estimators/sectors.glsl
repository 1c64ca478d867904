// The unified domain of Lin et al. 2020: the unit disc cut into n_a rings of equal area and n_s sectors.


// Estimators that fold count opposite sectors together.
const bool FOLDED = ESTIMATOR == ESTIMATOR_CPPM_FOLD || ESTIMATOR == ESTIMATOR_FTEST_FOLD;
const uint RING_CELLS = FOLDED ? SECTORS / 2u : SECTORS;

// Bin of a photon at v, q = |offset|^2 / R^2 in [0, 1). Half-plane tests instead of an arc tangent: the same on every
// driver. n_s is even: the lower half plane is the upper one turned by n_s / 2 sectors.
uint cell_bin(vec2 v, float q) {
    uint ring = min(RINGS - 1u, uint(q * float(RINGS)));
    bool lower = v.y < 0.0 || (v.y == 0.0 && v.x < 0.0);
    if (lower) v = -v;
    uint sector = lower && !FOLDED ? SECTORS / 2u : 0u;
    for (uint s = 1u; s < SECTORS / 2u; ++s) {
        vec2 edge = params.sector_edge[s];
        sector += edge.x * v.y - edge.y * v.x >= 0.0 ? 1u : 0u;
    }
    return ring * RING_CELLS + sector;
}

const uint DISC_CELLS = RINGS * RING_CELLS;

// Photons a cell that this invocation has accepted, two counters of 16 bits a word: the step budget stays below 2^16.
// Registers, added to under a comparison a word: an array in memory, or the tally itself, costs a loop over the lanes
// of the SIMD group for every candidate.
uint counted[(DISC_CELLS + 1u) / 2u];

void count(uint bin) {
    for (uint word = 0u; word < (DISC_CELLS + 1u) / 2u; ++word) {
        counted[word] += bin / 2u == word ? 1u << (16u * (bin % 2u)) : 0u;
    }
}

void tally_begin() {
    for (uint word = 0u; word < (DISC_CELLS + 1u) / 2u; ++word) counted[word] = 0u;
}

void tally_flush(uint pixel) {
    for (uint bin = 0u; bin < DISC_CELLS; ++bin) {
        uint found = counted[bin / 2u] >> (16u * (bin % 2u)) & 0xffffu;
        tally[row_of(bin, pixel)] = tally_at(bin, pixel) + found;
    }
}

// The pixel's tally, read once for all tests of the disc.
uint observed[DISC_CELLS];

void read_tally(uint pixel) {
    for (uint bin = 0u; bin < DISC_CELLS; ++bin) observed[bin] = tally_at(bin, pixel);
}

uint observed_in(uint cells) {
    uint sum = 0u;
    for (uint bin = 0u; bin < cells; ++bin) sum += observed[bin];
    return sum;
}

// cells * count - sum: the textbook form of chi-squared cancels in floats. Here the mean is taken off in integers, and
// what is left is exact up to 2^24 and right to a rounding error beyond. sum: below 2^31.
float scaled_difference(uint cells, uint count, uint sum) {
    return float(int(count - sum / cells)) * float(cells) - float(sum % cells);
}
