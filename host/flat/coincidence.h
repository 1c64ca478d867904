#pragma once
// Triangles that lie on one another. A ray that starts at one of two surfaces in the same place can neither meet the
// other nor leave it out with certainty: rounding would decide, ray by ray. So one place has one triangle, and surfaces
// that touch are moved apart by little more than rounding.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace vkcppm {

using Corners = std::array<glm::vec3, 3>;

/// What counts of a triangle where another one lies on it.
struct FaceTraits {
    std::uint32_t material = 0;
    bool emits = false;
    bool is_solid = false;  // the boundary of solid glass
};

/// Bound of the rounding error of points on the triangle and of its corners: 8 half-ulps of the largest term.
float position_error(const Corners& corners);

/// Indices, ascending, of the triangles to keep: not those without a normal in floats, and of triangles with the same
/// corners and the same front one, the first that emits or else the first. O(n log n).
std::vector<std::uint32_t> distinct_triangles(std::span<const Corners> corners, std::span<const FaceTraits> faces);

/// Moves apart what touches, by four times the rounding error: a lamp in the plane of what it lies on goes to its
/// front, and so do the two sides of an opaque sheet, triangles with the same corners that differ; a face of solid
/// glass that lies front to front on another face, wholly or in part, goes into its solid, so that there is a thin
/// gap of air as between any two bodies; on a face of another solid it goes out of its own, so that the two overlap
/// and nothing is between them, as between a liquid and its glass. least_error: of a point on any of them, where the
/// corners are a mesh's whose instances are known less precisely than it is. Returns whether solids touch. O(n log n)
/// where few lie on many.
bool part_touching_faces(std::span<Corners> corners, std::span<const FaceTraits> faces, float least_error = 0.0f);

}  // namespace vkcppm
