#include "scene/gltf/placement.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "scene/gltf/values.h"

namespace vkcppm {

std::optional<Placement> Placement::of(const glm::dmat4& to_world) {
    glm::dmat3 linear(to_world);
    const double size = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    if (!(size > 0.0)) return std::nullopt;
    linear /= size;
    // Volume of the parallelepiped of unit edges: 0 is flat, whatever the scales are.
    const double volume =
        glm::determinant(glm::dmat3(glm::normalize(linear[0]), glm::normalize(linear[1]), glm::normalize(linear[2])));
    if (!(std::abs(volume) > 1e-12)) return std::nullopt;
    // The cofactors are det(M) M^-T: no division, and the sign of the determinant turns them to M^-T.
    const double sign = volume < 0.0 ? -1.0 : 1.0;
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    return Placement{to_world, sign * cofactors, volume < 0.0};
}

glm::vec3 Placement::normal(const glm::dvec3& n) const { return glm::vec3(unit_or_zero(normal_to_world * n)); }

glm::vec4 Placement::tangent(const glm::dvec4& t) const {
    const glm::vec3 direction(unit_or_zero(glm::dmat3(to_world) * glm::dvec3(t)));
    if (direction == glm::vec3(0.0f)) return glm::vec4(0.0f);
    return {direction, (t.w < 0.0) != mirrored ? -1.0f : 1.0f};
}

}  // namespace vkcppm
