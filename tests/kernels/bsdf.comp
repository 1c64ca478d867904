#version 460
// Lobes as they are chosen, followed and gathered on: all on one surface, and from one direction or one each.
// launch.argument: 0: `incoming` is given; else a lobe is chosen by u.z and followed.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "include/bsdf.glsl"
#include "probe.h"

layout(binding = PROBE_VIEW, scalar) readonly buffer ViewBlock { BsdfView views[]; };
layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { BsdfInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { BsdfOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    BsdfView view = views[min(i, uint(views.length()) - 1u)];
    SurfaceMaterial material = materials_at(view.material);
    Surface surface = Surface(vec3(0.0), view.geometric, view.normal, view.clearcoat_normal, view.tangent, 0.0,
                              view.front != 0u, view.material);
    Bsdf bsdf = bsdf_of(material, material.ior, surface.front);
    BsdfOutput result = BsdfOutput(LOBE_NONE, 1.0, inputs[i].incoming, vec3(0.0), 0.0, 0.0, 0.0, gathering_sides(bsdf),
                                   0.0, vec3(0.0), vec3(0.0));
    LobeWeights lobes = lobes_of(bsdf, surface, view.outgoing);
    if (launch.argument != 0u) {
        result.lobe = view.lobe;
        if (view.lobe == LOBE_NONE) {
            float inverse_probability;
            result.lobe = choose_lobe(lobes, inputs[i].u.z, inverse_probability);
            result.probability = 1.0 / inverse_probability;
        }
        result.direction = -view.outgoing;
        result.weight = sample_lobe(result.lobe, bsdf, surface, inputs[i].u.xy, view.radiance != 0u, result.direction,
                                    result.density);
        result.width = width_of(result.lobe, bsdf);
        result.followed = followed_weight(result.density, dot(result.direction, normal_of(result.lobe, surface)));
    }
    result.scatter = scatter_density(bsdf, surface, lobes, view.outgoing, result.direction);
    result.value = rough_bsdf(bsdf, surface, view.outgoing, result.direction, PART_ALL);
    result.gathered = rough_bsdf(bsdf, surface, view.outgoing, result.direction, PART_GATHERED);
    outputs[i] = result;
}
