// SPPM, probabilistic form: Knaus and Zwicker 2011. No local statistics: r_(i+1)^2 = r_i^2 (i + alpha) / (i + 1), with
// i counted from the iteration in which the pixel got its first radius.
#include "include/pixels.glsl"
#include "include/sum.glsl"

#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    add(state.count, state.count_low, 1.0);
    add(state.radius2, state.radius2_low, -state.radius2 * ((1.0 - params.alpha) / (state.count + 1.0)));
}
