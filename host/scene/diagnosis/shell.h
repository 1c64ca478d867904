#pragma once
// Surfaces in one piece: what they enclose, and what is inside.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm {

/// Triangles that hang together by edges. Corners at the same position are one, but for rounding: glTF repeats a vertex
/// at every seam. All are in world space or of one shared mesh; measures are those of its space.
struct Shell {
    std::vector<std::uint32_t> triangles;  // into Scene::triangles, ascending
    std::size_t open_edges = 0;            // edges of an odd number of triangles
    std::size_t twisted_edges = 0;         // edges of an even number of triangles that disagree about the front
    double volume = 0.0;                   // m^3, of a closed shell; negative where the fronts face inwards
    glm::dvec3 low{0.0}, high{0.0};        // m, bounding box

    /// Has an inside: no edge is open or twisted, and two sheets that lie on one another do not count.
    bool is_closed() const { return open_edges == 0 && twisted_edges == 0 && !is_flat(); }
    bool is_flat() const;
};

/// The shells of those triangles, in the order of their first triangles. Triangles with two corners at one position
/// belong to none.
std::vector<Shell> find_shells(const Scene& scene, std::span<const std::uint32_t> triangles);

/// Shells in the order of their first triangles, parted by the space that they are in: the world's, then that of each
/// shared mesh.
std::vector<std::span<const Shell>> by_space(const Scene& scene, std::span<const Shell> shells);

/// The corners of a triangle of the scene, m.
std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t triangle);

/// The share of all directions in which the triangle is seen from the point; negative from its front (van Oosterom and
/// Strackee 1983). Of those of a closed surface the sum is how often it winds around the point.
double share_of_directions(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point);

/// How often the shell winds around the point: 1 inside, 0 outside, -1 inside one whose fronts face inwards, 1/2 on a
/// smooth surface.
double winding_number(const Scene& scene, const Shell& shell, const glm::dvec3& point);

/// Turns around a point from which on it is inside: what lies on a surface, such as a lamp that touches glass, is not.
inline constexpr double inside_turns = 0.75;

}  // namespace vkcppm
