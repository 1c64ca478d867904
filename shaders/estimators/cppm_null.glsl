// The ablation of cppm: every full batch shrinks the area by k, without a test.
#include "include/pixels.glsl"
#include "include/sum.glsl"

#define HOOK_UPDATE
void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    state.total = add_saturated(state.total, found);
    if (!batch_is_full(state)) return;
    state.radius2 *= params.k;
    state.total = 0u;
    state.batch *= params.beta;
    ++state.rejections;
}
