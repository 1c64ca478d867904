#pragma once
// Materials that light passes through.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace vkcppm {

/// KHR_materials_transmission above 0 in what is no metal all over.
bool is_glass(const Material& material);

/// Glass with a KHR_materials_volume thickness: refracts. Without one it is thin-walled, and light passes straight on.
bool is_solid_glass(const Material& material);

/// Indices of the triangles whose material `matches`, in order.
template <typename Predicate> std::vector<std::uint32_t> triangles_of(const Scene& scene, Predicate matches) {
    std::vector<bool> of_material(scene.materials.size());
    for (std::size_t i = 0; i < of_material.size(); ++i) of_material[i] = matches(scene.materials[i]);
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        if (of_material[scene.triangles[i].material]) triangles.push_back(std::uint32_t(i));
    }
    return triangles;
}

/// Gives thin-walled glass a thickness wherever its mesh is closed. A material that is on open meshes as well is
/// divided: its closed ones take a copy.
void make_glass_solid(Scene& scene);

}  // namespace vkcppm
