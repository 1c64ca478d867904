#include "scene/diagnosis/alpha.h"

#include <algorithm>
#include <cstdint>

namespace vkcppm {
namespace {

/// Of the image's texels.
float least_alpha(const TextureImage& image) {
    std::uint8_t least = 255;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) least = std::min(least, image.rgba[i]);
    return least / 255.0f;
}

}  // namespace

std::vector<float> least_alphas(const Scene& scene) {
    std::vector<float> vertices(scene.materials.size(), 1.0f);
    for (const Triangle& triangle : scene.triangles) {
        if (scene.colors.empty()) break;
        float& least = vertices[triangle.material];
        for (const std::uint32_t vertex : triangle.vertex) least = std::min(least, scene.colors[vertex].a);
    }
    std::vector<float> alphas;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        float& alpha = alphas.emplace_back(1.0f);
        if (material.alpha == Material::Alpha::opaque) continue;
        alpha = material.opacity * vertices[i];
        if (const auto& texture = material.base_color_texture) alpha *= least_alpha(scene.images[texture->image]);
    }
    return alphas;
}

bool is_partly_there(const Material& material, float least_alpha) {
    switch (material.alpha) {
        case Material::Alpha::opaque: return false;
        case Material::Alpha::mask: return least_alpha < material.alpha_cutoff;
        case Material::Alpha::blend: return least_alpha < 1.0f;
    }
    return false;
}

}  // namespace vkcppm
