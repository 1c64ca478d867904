#pragma once
// The materials that tests are built of.

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm::test {

/// Pure Lambert: no metal, no coat. emission: W m^-2 sr^-1.
inline Material lambert(const glm::vec3& reflectance, const glm::vec3& emission = glm::vec3(0.0f)) {
    Material material;
    material.base_color = reflectance;
    material.metallic = material.specular = 0.0f;
    material.emission = emission;
    return material;
}

/// Black, but for what it emits, on its front unless it is said to have two sides.
inline Material emitter(const glm::vec3& radiance, bool double_sided = false) {
    Material material = lambert(glm::vec3(0.0f), radiance);
    material.double_sided = double_sided;
    return material;
}

/// Smooth metal.
inline Material mirror(const glm::vec3& reflectance) {
    Material material;
    material.base_color = reflectance;
    material.roughness = 0.0f;
    return material;
}

/// Solid, smooth and without colour.
inline Material glass(float ior) {
    Material material;
    material.metallic = material.roughness = 0.0f;
    material.transmission = material.thickness = 1.0f;
    material.ior = ior;
    return material;
}

}  // namespace vkcppm::test
