#version 460
// Mirrors and dielectrics at every incidence.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/scene.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/specular.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { ScatterInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { ScatterOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.count) return;
    ScatterInput s = inputs[i];
    SurfaceMaterial material = material_at(s.material);
    float cosine = min(1.0, -dot(s.direction, s.normal));
    ScatterOutput result;
    result.reflectance =
        fresnel_dielectric(cosine, s.front != 0u ? 1.0 / material.ior : material.ior, result.cosine_t);
    result.metal = fresnel_metal(material.color, cosine);
    Surface surface = Surface(vec3(0.0), s.geometric, s.normal, 0.0, s.front != 0u, s.material);
    result.direction = s.direction;
    result.factor = scatter_specular(material, surface, s.u, s.radiance != 0u, result.direction);
    outputs[i] = result;
}
