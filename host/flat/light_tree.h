#pragma once
// The light tree, down which kernels choose a lamp by what it may bring to a point (shaders/include/light_tree.glsl).

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "shared/types.h"

namespace vkcppm {

/// A leaf: lights that are chosen together and then drawn in proportion to their power. Frame units.
struct Lamp {
    std::uint32_t first = 0;  // of asked_lights
    std::uint32_t count = 0;
    glm::vec3 low{std::numeric_limits<float>::infinity()};  // bounds
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
    glm::vec3 axis{0.0f, 0.0f, 1.0f};  // unit: the normal of an emitter, the axis of a spot light
    float spread = 0.0f;               // angle from the axis within which it shines as along it, radians
    float falloff = 0.0f;              // angle from there within which it shines at all, at most pi / 2
    bool both_sides = false;
    float reach = 0.0f;      // beyond which it sheds no light
    double intensity = 0.0;  // the largest, mean channel, W/sr (frame-scaled); above 0
};

struct LightTree {
    std::vector<gpu::LightBranch> branches;  // one less than lamps
    std::vector<std::uint32_t> lamps;        // of each its branch << 1 | which child it is
    std::uint32_t depth = 0;                 // branches down to the lowest lamp
};

/// Splits lamps in two where, over the buckets of the three axes, intensity times orientation measure times squared
/// diagonal is least (surface area orientation heuristic; Conty Estevez and Kulla 2018), until one is left: the squared
/// diagonal for the surface area, which is 0 for lamps in a row. From a depth of 64 on, and where all are in one place,
/// in halves. The same tree on any number of threads. Two lamps or more. O(n log n).
LightTree build_light_tree(std::span<const Lamp> lamps);

}  // namespace vkcppm
