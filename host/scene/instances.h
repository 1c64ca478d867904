#pragma once
// Shared meshes and their instances.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm {

/// Triangles [first, last) of Scene::triangles.
struct TriangleRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;

    std::size_t count() const { return last - first; }
};

/// Those in world space.
TriangleRange world_triangles(const Scene& scene);

/// Those of a shared mesh, in its space.
TriangleRange triangles_of_mesh(const Scene& scene, std::uint32_t mesh);

/// The shared mesh that a triangle belongs to; none where it is in world space.
std::optional<std::uint32_t> mesh_of(const Scene& scene, std::uint32_t triangle);

/// How many triangles the scene shows, those of instances counted in each.
std::size_t shown_triangles(const Scene& scene);

/// An axis-aligned box; low > high: of nothing.
struct SceneBox {
    glm::dvec3 low;
    glm::dvec3 high;

    static SceneBox nothing();
    bool is_empty() const { return !(low.x <= high.x); }
    void grow(const glm::dvec3& p);
    void grow(const SceneBox& other);
};

/// The box round triangles, in their space. On all cores.
SceneBox box_of(const Scene& scene, const TriangleRange& triangles);

/// Boxes, at most 64, that hold all corners of a mesh's triangles: of them as a whole a box turned by an instance is
/// nearly as small as that of the corners themselves.
std::vector<SceneBox> cells_of(const Scene& scene, const TriangleRange& triangles);

/// [instances] The boxes round them in the world, hardly larger than they are. On all cores.
std::vector<SceneBox> instance_boxes(const Scene& scene);

/// The box round all that the scene shows.
SceneBox world_box(const Scene& scene);

/// False of a transform that shears so much, or is so much longer along one axis than along another, that what float
/// rounds in it and in its inverse would count.
bool is_shareable(const glm::dmat4& to_world);

}  // namespace vkcppm
