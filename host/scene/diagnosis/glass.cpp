#include "scene/diagnosis/glass.h"

#include "scene/diagnosis/shell.h"

namespace vkcppm {

bool is_glass(const Material& material) {
    return material.transmission > 0.0f && (material.metallic < 1.0f || material.metallic_roughness_texture);
}

bool is_solid_glass(const Material& material) { return is_glass(material) && material.thickness > 0.0f; }

void make_glass_solid(Scene& scene) {
    const auto is_thin = [](const Material& material) { return is_glass(material) && !is_solid_glass(material); };
    const std::vector<std::uint32_t> thin = triangles_of(scene, is_thin);
    std::vector<std::uint32_t> closed;
    for (const Shell& shell : find_shells(scene, thin)) {
        if (shell.is_closed()) closed.insert(closed.end(), shell.triangles.begin(), shell.triangles.end());
    }

    std::vector<std::int64_t> open_triangles(scene.materials.size());
    for (const std::uint32_t i : thin) ++open_triangles[scene.triangles[i].material];
    for (const std::uint32_t i : closed) --open_triangles[scene.triangles[i].material];

    std::vector<std::uint32_t> solid(scene.materials.size());  // 0: not made yet, else the index of the solid one + 1
    for (const std::uint32_t i : closed) {
        std::uint32_t& material = scene.triangles[i].material;
        std::uint32_t& replacement = solid[material];
        if (replacement == 0) {
            replacement = material + 1;
            if (open_triangles[material] > 0) {
                scene.materials.push_back(Material(scene.materials[material]));
                replacement = std::uint32_t(scene.materials.size());
            }
            scene.materials[replacement - 1].thickness = 1.0f;  // m; any that is not 0 means solid
        }
        material = replacement - 1;
    }
}

}  // namespace vkcppm
