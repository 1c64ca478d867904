// The picture in layers (LAYER_*), where there are further channels: adds what a pass has found for a pixel to its
// sums. Writes aovs.
#ifndef LAYERS_GLSL
#define LAYERS_GLSL

#include "include/kernel.glsl"
#include "include/sum.glsl"

AOVS(UPDATES)

// radiance [LAYERS] W m^-2 sr^-1 of one iteration. What is not finite is dropped, as the update pass does.
void add_layers(uint pixel, vec3 radiance[LAYERS]) {
    Aovs sum = aovs[pixel];
    for (uint i = 0u; i < LAYERS; ++i) {
        if (finite(radiance[i])) add(sum.layer[i], sum.layer_low[i], radiance[i]);
    }
    aovs[pixel] = sum;
}

#endif
