// The family's one switch. Every estimator has two hooks:
//   record(pixel, v, q): a photon was accepted at v in the unit disc, q = |offset|^2 / R^2 < 1;
//   update(pixel, diffuse, found, state): after an iteration in which `found` photons were accepted (`diffuse`: the
//   pixel saw a surface to gather on); decides state.radius2 for the next one.
// All share the accumulator acc += Phi / (pi R^2) of the update kernel; only the rule of the radius differs.
#include "estimators/sectors.glsl"
#include "estimators/sppm.glsl"
#include "estimators/sppm_kz.glsl"
#include "estimators/cppm.glsl"

void record(uint pixel, vec2 v, float q) {
    if (ESTIMATOR == ESTIMATOR_CPPM) cppm_record(pixel, v, q);
}

void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    if (ESTIMATOR == ESTIMATOR_SPPM) sppm_update(found, state);
    else if (ESTIMATOR == ESTIMATOR_SPPM_KZ) sppm_kz_update(state);
    else cppm_update(pixel, found, state);
}
