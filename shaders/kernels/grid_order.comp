#version 460
// Copies the photons into the order of their cells, so that a row of cells is one run of memory. Reads photons and the
// sorted pairs; writes sorted, sorted_flux. Invocations stride over the photons.
#include "include/kernel.glsl"
#include "include/grid.glsl"
#include "include/counters.glsl"

layout(binding = BIND_PAIRS_A, scalar) buffer PairBlockA { uvec2 pairs_a[]; };
layout(binding = BIND_PAIRS_B, scalar) buffer PairBlockB { uvec2 pairs_b[]; };
layout(binding = BIND_PHOTON_TEXELS) uniform usamplerBuffer photons;
layout(binding = BIND_PHOTON_FLUX_TEXELS) uniform usamplerBuffer fluxes;
layout(binding = BIND_SORTED, scalar) writeonly buffer SortedBlock { uvec4 sorted[]; };  // Photon
layout(binding = BIND_SORTED_FLUX, scalar) writeonly buffer SortedFluxBlock { uvec4 sorted_flux[]; };  // PhotonFlux
layout(binding = BIND_COUNTERS, scalar) readonly buffer CounterBlock { uint counters[]; };

void main() {
    if (blocked(0u)) return;
    bool in_a = sort_passes() % 2u == 0u;
    uint total = SORTED_TOTAL;
    uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint i = invocation(); i < total; i += stride) {
        uint slot = in_a ? pairs_a[i].y : pairs_b[i].y;
        sorted[i] = texelFetch(photons, int(slot));
        sorted_flux[i] = texelFetch(fluxes, int(slot));
    }
}
