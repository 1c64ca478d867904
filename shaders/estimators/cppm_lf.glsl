// CPPM-LF: the null hypothesis is a linear density, supplementary section 5.2.2. Tallies are cppm's.
#include "include/sampling.glsl"
#include "estimators/tally.glsl"

#define HOOK_KEEP STATISTIC_tally
void keep(uint pixel, Accepted photon, bool inside) { count(cell_bin(photon.v, photon.q)); }

// A_a = (2/3) (a^(3/2) - (a-1)^(3/2)) sin(pi/n_s) n_a^(-3/2) of ring a = ring + 1 of n_a = rings: the probability of a
// cell changes with k1 by A_a cos(theta_s), with k2 by A_a sin(theta_s). Eq. (9).
float ring_slope(uint ring, uint rings) {
    float factor = 2.0 / 3.0 * sin(PI / float(SECTORS)) / (float(rings) * sqrt(float(rings)));
    float inner = float(ring), outer = inner + 1.0;
    return factor * (outer * sqrt(outer) - inner * sqrt(inner));
}

// Chi-squared statistic against the best linear density f = k1 x + k2 y + c on the disc of the first `rings` rings (its
// radius taken as 1), over its threshold; two degrees of freedom fewer. Least squares, Eq. (10); |k| at most c = 1/pi
// keeps f positive, Eq. (12)-(15). Eq. (9) with the factor n_a^(-3/2): the printed n_a^(2/3) is a slip of the pen that
// makes probabilities negative.
float test_ratio(uint rings, PixelState state) {
    uint cells = rings * RING_CELLS;
    uint sum = observed_in(cells);
    if (sum == 0u) return 0.0;
    vec2 moment = vec2(0.0);
    float norm = 0.0;
    for (uint ring = 0u; ring < rings; ++ring) {
        float slope = ring_slope(ring, rings);
        for (uint s = 0u; s < SECTORS; ++s) {
            moment += float(observed[ring * SECTORS + s]) * slope * params.sector_centre[s];
        }
        norm += 0.5 * float(SECTORS) * slope * slope;
    }
    vec2 k = moment / (float(sum) * norm);
    float limit = 1.0 / PI;
    float size = length(k);
    if (size > limit) k *= limit / size;

    float statistic = 0.0;
    float share = 1.0 / float(cells);
    for (uint ring = 0u; ring < rings; ++ring) {
        float slope = ring_slope(ring, rings);
        for (uint s = 0u; s < SECTORS; ++s) {
            float tilt = slope * dot(k, params.sector_centre[s]);
            float p = max(share + tilt, 1e-6 * share);
            // O - S p = (c O - S) / c - S (p - 1/c)
            float difference = scaled_difference(cells, observed[ring * SECTORS + s], sum) * share -
                               float(sum) * (p - share);
            statistic += difference * (difference / (float(sum) * p));
        }
    }
    return statistic / params.threshold[rings - 1u];
}
