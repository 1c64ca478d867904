// Estimators that count photons a cell of the disc and test the counts. One that includes this defines keep(), which
// calls count(), and test_ratio() of Algorithm 1, which looks at `observed` (uniform.glsl has one); begin, flush and
// update it has from here. One with a rule of its own around algorithm1() defines its update before it includes this.
#ifndef TALLY_GLSL
#define TALLY_GLSL

#include "estimators/kept.glsl"
#include "estimators/algorithm1.glsl"

// Photons a cell that this invocation has accepted, two counters of 16 bits a word: the step budget stays below 2^16.
// Registers, added to under a comparison a word: an array in memory, or the tally itself, costs a loop over the lanes
// of the SIMD group (subgroup) for every candidate.
uint counted[(DISC_CELLS + 1u) / 2u];

void count(uint bin) {
    for (uint word = 0u; word < (DISC_CELLS + 1u) / 2u; ++word) {
        counted[word] += bin / 2u == word ? 1u << (16u * (bin % 2u)) : 0u;
    }
}

#define HOOK_BEGIN
void begin(uint pixel) {
    for (uint word = 0u; word < (DISC_CELLS + 1u) / 2u; ++word) counted[word] = 0u;
}

#define HOOK_FLUSH
void flush(uint pixel) {
    for (uint bin = 0u; bin < DISC_CELLS; ++bin) {
        uint found = counted[bin / 2u] >> (16u * (bin % 2u)) & 0xffffu;
        tally[row_of(bin, pixel)] = tally_at(bin, pixel) + found;
    }
}

#ifndef HOOK_UPDATE
#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) { algorithm1(pixel, found, state); }
#endif

// The pixel's tally, read once for all tests of the disc.
uint observed[DISC_CELLS];

void read_statistics(uint pixel) {
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

#endif
