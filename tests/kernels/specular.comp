#version 460
// Lobes of width 0 at every incidence: mirrors and dielectrics.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/bsdf.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { ScatterInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { ScatterOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    ScatterInput s = inputs[i];
    SurfaceMaterial material = materials_at(s.material);
    Surface surface = Surface(vec3(0.0), s.geometric, s.normal, s.normal, vec3(0.0), 0.0, s.front != 0u, s.material);
    Bsdf bsdf = bsdf_of(material, material.ior, surface.front);
    float cosine = min(1.0, -dot(s.direction, s.normal));
    ScatterOutput result;
    result.reflectance = fresnel_dielectric(cosine, bsdf.eta, result.cosine_t);
    result.facet = facet_reflectance(bsdf, cosine);
    float inverse_probability;
    result.lobe = choose_lobe(lobes_of(bsdf, surface, -s.direction), s.u, inverse_probability);
    result.probability = 1.0 / inverse_probability;
    result.direction = s.direction;
    result.factor =
        sample_lobe(result.lobe, bsdf, surface, vec2(0.0), s.radiance != 0u, result.direction, result.density);
    outputs[i] = result;
}
