// CPPM: Lin et al. 2020, Algorithm 1. The radius stays while the photons in the disc pass a chi-squared test for a
// uniform density; it shrinks where they fail.
#include "estimators/uniform.glsl"

#define HOOK_KEEP STATISTIC_tally
void keep(uint pixel, Accepted photon, bool inside) { count(cell_bin(photon.v, photon.q)); }
