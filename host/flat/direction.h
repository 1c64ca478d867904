#pragma once
// Unit vectors in a word.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace vkcppm {

/// Octahedral snorm16x2, as pack_direction of shaders/include/frame.glsl.
inline std::uint32_t pack_direction(const glm::vec3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 p(n.x / sum, n.y / sum);
    if (n.z < 0.0f) {
        p = glm::vec2((1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                      (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    }
    const auto snorm = [](float x) {
        return std::uint32_t(std::int32_t(std::floor(std::clamp(x, -1.0f, 1.0f) * 32767.0f + 0.5f))) & 0xffffu;
    };
    return snorm(p.x) | snorm(p.y) << 16;
}

}  // namespace vkcppm
