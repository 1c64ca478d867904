#pragma once
// Scenes of many instances.

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "scene/scene.h"
#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

/// A floor under a lamp, and over it instances of one bumpy sphere of about so many triangles, each turned, scaled
/// along its axes and some mirrored.
GltfBuilder instanced_spheres(std::uint32_t instances, std::uint32_t triangles);

/// The same picture without instances: their triangles after those of the world, instance by instance, in double
/// precision. Each has vertices of its own.
Scene copied(const Scene& scene);

/// The same picture with the triangles of a material as a shared mesh, in a space from which `to_world` puts them back
/// where they are.
Scene shared(const Scene& scene, std::uint32_t material, const glm::dmat4& to_world);

}  // namespace vkcppm::test
