#version 460
// Surfaces with their materials, textures looked up, at points of triangles. The first texture is also looked up at
// coordinates that are given.
#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"
#include "include/surface.glsl"
#include "probe.h"

layout(binding = PROBE_INPUT, scalar) readonly buffer InputBlock { TextureInput inputs[]; };
layout(binding = PROBE_OUTPUT, scalar) writeonly buffer OutputBlock { TextureOutput outputs[]; };

void main() {
    uint i = invocation();
    if (i >= launch.items) return;
    TextureInput at = inputs[i];
    TextureOutput result;
    if (launch.argument == 0u) {
        result.value = texture_at(at.texture, at.coordinates);
    } else {
        Hit hit = Hit(0.0, at.triangle, at.barycentric, NO_INSTANCE);
        Surface surface = surface_at(hit, at.direction);
        SurfaceMaterial material = material_at(hit, at.direction, surface);
        result.value = vec4(material.color, material.opacity);
        result.emission = met_radiance(material, surface, at.direction);
        result.metal = vec4(material.metallic, material.roughness, material.transmission, material.specular);
        result.specular_color = material.specular_color;
        result.clearcoat = vec2(material.clearcoat, material.clearcoat_roughness);
        result.coverage = coverage_of(material);
        result.geometric = surface.geometric;
        result.normal = surface.normal;
        result.clearcoat_normal = surface.clearcoat_normal;
        result.tangent = surface.tangent;
        result.anisotropy = material.anisotropy.z;
        result.sheen = vec4(material.sheen_color, material.sheen_roughness);
        result.film = vec2(material.iridescence, material.film_thickness.y);
    }
    outputs[i] = result;
}
