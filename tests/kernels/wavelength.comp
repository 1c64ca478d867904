#version 460
// Colours and indices of refraction by wavelength.
#include "include/kernel.glsl"
#include "include/rng.glsl"
#include "include/wavelength.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { WavelengthInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { WavelengthOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    WavelengthInput s = inputs[i];
    outputs[i] = WavelengthOutput(wavelength_of(launch.argument, i), wavelength_weight(s.wavelength),
                                  index_at(s.ior, s.cauchy, s.wavelength));
}
