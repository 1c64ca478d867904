// SPPM, shared statistics: Hachisuka and Jensen 2009. N starts at 0 and grows by alpha M; the disc keeps the share
// (N + alpha M) / (N + M) of its area. Their tau / R^2 is the sum of Phi / R^2 that all estimators accumulate.
#include "include/pixels.glsl"
#include "include/sum.glsl"

#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    if (found == 0u) return;
    float m = float(found);
    add(state.radius2, state.radius2_low, -state.radius2 * ((1.0 - params.alpha) * m / (state.count + m)));
    add(state.count, state.count_low, params.alpha * m);
}
