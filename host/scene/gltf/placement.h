#pragma once
// How a mesh gets from its own space to the world.

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace vkcppm {

struct Placement {
    glm::dmat4 to_world;
    glm::dmat3 normal_to_world;  // the inverse transpose, but for a positive factor
    bool mirrored = false;       // the determinant is negative: the winding turns over

    /// Nothing where the transform is singular.
    static std::optional<Placement> of(const glm::dmat4& to_world);

    glm::dvec3 point(const glm::dvec3& p) const { return glm::dvec3(to_world * glm::dvec4(p, 1.0)); }

    /// A unit normal, or zero where `n` has no direction.
    glm::vec3 normal(const glm::dvec3& n) const;

    /// A unit tangent and the sign of its bitangent w cross(normal, tangent), or zeros where it has no direction. A
    /// mirror turns the cross product over, so the sign turns as well.
    glm::vec4 tangent(const glm::dvec4& t) const;
};

}  // namespace vkcppm
