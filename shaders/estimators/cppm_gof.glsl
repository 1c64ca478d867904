// CPPM-GOF: the null hypothesis is a generalised odd density, p(x) + p(-x) constant, supplementary section 5.2.1: a
// photon is counted at the opposite place with probability one half, then the test of uniformity is cppm's. The flip
// changes the count only, never the radiance.
#include "include/rng.glsl"
#include "estimators/uniform.glsl"

#define HOOK_KEEP STATISTIC_tally
void keep(uint pixel, Accepted photon, bool inside) {
    bool flip = random4(params.seed, launch.iteration, STREAM_GATHER, picture_pixel(pixel), photon.index).x < 0.5;
    count(cell_bin(flip ? -photon.v : photon.v, photon.q));
}
