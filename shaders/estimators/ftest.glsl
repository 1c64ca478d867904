// F-tests: after Lin et al. 2025, arXiv:2504.04411: analysis of variance of contributions over sectors. One sample of a
// cell is the sum, over one iteration, of the luminance of the contributions (with the BSDF, without the throughput of
// the eye path) that fell there: it sees gradients of flux at constant density, and photons that come in clusters.
// ftest-fold adds opposite sectors first. Choices where the abstract is silent: cells as cppm, batches as cppm.
// Moments: rows [0, c) sums of this iteration | [c, 2c) means of the cells | [2c, 2c + rings) sums of squared
// deviations within the cells of a ring (Welford's recurrence: nothing cancels) | [2c + rings, 3c + 2 rings) the low
// parts of means and squares: after 10^6 samples one of them is less than the rounding of their sum.
#include "include/colour.glsl"
#include "include/hits.glsl"
#include "include/sum.glsl"
#include "estimators/algorithm1.glsl"

const uint MEANS = DISC_CELLS;
const uint SQUARES = 2u * DISC_CELLS;
const uint LOW = DISC_CELLS + RINGS;  // from a mean or a sum of squares to its low part

QUANTILES(TEXELS)

// Contributions a cell that this invocation has accepted, in registers as `counted`.
float contributed[DISC_CELLS];
vec3 albedo;

#define HOOK_KEEP STATISTIC_contribution
void keep(uint pixel, Accepted photon, bool inside) {
    uint bin = cell_bin(photon.v, photon.q);
    float x = luminance(albedo * photon.power) * params.flux_unit;
    for (uint cell = 0u; cell < DISC_CELLS; ++cell) contributed[cell] += cell == bin ? x : 0.0;
}

// The sums go on from where the round before left them: the same additions in the same order, however work is split.
#define HOOK_BEGIN
void begin(uint pixel) {
    for (uint cell = 0u; cell < DISC_CELLS; ++cell) contributed[cell] = moment_at(cell, pixel);
    albedo = hit_albedo(pixel);
}

#define HOOK_FLUSH
void flush(uint pixel) {
    for (uint cell = 0u; cell < DISC_CELLS; ++cell) moments[row_of(cell, pixel)] = contributed[cell];
}

// Means of the cells, sums of squares of the rings: of all samples so far.
float cell_mean[DISC_CELLS];
float ring_squares[RINGS];

void read_statistics(uint pixel) {}  // take_sample() has

// Reads them; where the pixel is `diffuse`, takes this iteration's sums as one more sample of every cell.
void take_sample(uint pixel, bool diffuse, inout PixelState state) {
    if (diffuse) add(state.count, state.count_low, 1.0);
    for (uint ring = 0u; ring < RINGS; ++ring) {
        float squares = moment_at(SQUARES + ring, pixel);
        float squares_low = moment_at(SQUARES + ring + LOW, pixel);
        for (uint bin = ring * RING_CELLS; bin < (ring + 1u) * RING_CELLS; ++bin) {
            float mean = moment_at(MEANS + bin, pixel);
            float mean_low = moment_at(MEANS + bin + LOW, pixel);
            if (diffuse) {
                float x = moment_at(bin, pixel);
                float deviation = x - mean;
                add(mean, mean_low, deviation / state.count);
                add(squares, squares_low, deviation * (x - mean));
                moments[row_of(MEANS + bin, pixel)] = mean;
                moments[row_of(MEANS + bin + LOW, pixel)] = mean_low;
                moments[row_of(bin, pixel)] = 0.0;
            }
            cell_mean[bin] = mean;
        }
        if (diffuse) {
            moments[row_of(SQUARES + ring, pixel)] = squares;
            moments[row_of(SQUARES + ring + LOW, pixel)] = squares_low;
        }
        ring_squares[ring] = squares;
    }
}

float quantile(uint row) { return uintBitsToFloat(texelFetch(quantiles_texels, int(row)).x); }

// Threshold for the disc of the first `rings` rings after m samples: linear between samples in 1 / (m - 1).
float f_threshold(uint rings, float m) {
    float x = min(2.0 / (m - 1.0), 1.0) * float(F_QUANTILES - 1);
    uint i = min(uint(x), uint(F_QUANTILES - 2));
    uint row = (rings - 1u) * F_QUANTILES + i;
    return mix(quantile(row), quantile(row + 1u), x - float(i));
}

// F = [m sum(mean_i - mean)^2 / (n - 1)] / [within / (n (m - 1))] over n cells, over its threshold. Fewer than three
// samples pass, and so do cells that are all equal.
float test_ratio(uint rings, PixelState state) {
    float m = state.count;
    if (m < 3.0) return 0.0;
    uint cells = rings * RING_CELLS;
    float mean = 0.0;
    for (uint bin = 0u; bin < cells; ++bin) mean += cell_mean[bin];
    mean /= float(cells);
    float between = 0.0;
    for (uint bin = 0u; bin < cells; ++bin) {
        float deviation = cell_mean[bin] - mean;
        between += deviation * deviation;
    }
    float within = 0.0;
    for (uint ring = 0u; ring < rings; ++ring) within += ring_squares[ring];
    if (between == 0.0) return 0.0;
    if (within == 0.0) return FAR;
    float f = (m * between / float(cells - 1u)) / (within / (float(cells) * (m - 1.0)));
    return f / f_threshold(rings, m);
}

#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    take_sample(pixel, diffuse, state);
    algorithm1(pixel, found, state);
}
