#pragma once
// The frame in which kernels work: centred on the scene, scaled by a power of two to a radius in (1/2, 1]. A scene of
// 10^6 m or 10^-4 m, or far from the origin, then meets the same floats as the same scene at 1 m.

#include <glm/vec3.hpp>

namespace vkcppm {

struct SceneFrame {
    glm::dvec3 centre{0.0};  // m, world
    double scale = 1.0;      // frame units a metre, a power of two

    glm::dvec3 point(const glm::dvec3& world) const { return (world - centre) * scale; }
    double length(double metres) const { return metres * scale; }
};

}  // namespace vkcppm
