#include "oracle/light_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "oracle/octahedral.h"

namespace vkcppm::oracle {
namespace {

double importance(const gpu::LightBranch& branch, std::uint32_t child, const glm::dvec3& position) {
    const glm::dvec3 away = position - glm::dvec3(branch.sphere[child]);
    const double distance = glm::length(away), radius = branch.sphere[child].w;
    const double about = 1.0 / std::max({distance * distance, 0.4 * radius * radius, 1e-12});
    if (distance <= radius) return about;
    if (distance - radius > branch.reach[child]) return 0.0;
    double cosine = glm::dot(away, unpack_direction(branch.axis[child])) / distance;
    if (branch.cones[child] >> 31) cosine = std::abs(cosine);
    const double cone = std::acos(std::clamp(std::int16_t(branch.cones[child] & 0xffffu) / 32767.0, -1.0, 1.0));
    const double falloff = std::acos((branch.cones[child] >> 16 & 0x7fffu) / 32767.0);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) - cone - std::asin(radius / distance);
    return angle < falloff ? std::cos(std::max(0.0, angle)) * about : 0.0;
}

}  // namespace

double lamp_probability(std::span<const gpu::LightBranch> tree, std::uint32_t lamp, const glm::dvec3& position) {
    double probability = 1.0;
    for (; lamp != NO_LAMP; lamp = tree[lamp >> 1].parent) {
        const gpu::LightBranch& branch = tree[lamp >> 1];
        const double of[2] = {importance(branch, 0, position), branch.ratio * importance(branch, 1, position)};
        probability *= of[0] + of[1] > 0.0 ? of[lamp & 1u] / (of[0] + of[1]) : 0.0;
    }
    return probability;
}

}  // namespace vkcppm::oracle
