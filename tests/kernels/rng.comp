#version 460
// Random numbers of every key.
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { RngKey keys[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { RngSample samples[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    RngKey k = keys[i];
    samples[i] = RngSample(pcg4d(uvec4(k.seed, k.iteration, k.stream, k.path)),
                           random4(k.seed, k.iteration, k.stream, k.path, k.dimension),
                           stratified(k.seed, k.iteration, k.path, k.dimension));
}
