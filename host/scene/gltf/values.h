#pragma once
// Numbers of a glTF file brought into the range that they must have.

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "scene/bad_scene.h"
#include "scene/warnings.h"

namespace vkcppm {

inline bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// v / |v|, or zero where v has no direction.
inline glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    if (length > 1e-140 && length < 1e140) return v / length;
    // The squares have left the range of normal doubles: once more, with 1 as the largest component.
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !is_finite(v)) return glm::dvec3(0.0);
    const glm::dvec3 scaled(v.x / largest, v.y / largest, v.z / largest);
    return scaled / glm::length(scaled);
}

inline std::string to_text(const glm::dvec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// `value`, within the range; a warning where it is not.
inline double clamped(double value, double low, double high, const std::string& object, Warnings& warnings) {
    if (value < low || value > high) {
        warnings.add("outside its range, clamped", fmt::format("{} = {} ({} to {})", object, value, low, high));
    }
    return std::clamp(value, low, high);
}

inline glm::vec3 clamped(const glm::dvec3& value, double low, double high, const std::string& object,
                         Warnings& warnings) {
    return {clamped(value.x, low, high, object, warnings), clamped(value.y, low, high, object, warnings),
            clamped(value.z, low, high, object, warnings)};
}

/// color * strength a channel: both must be non-negative and the product a finite float, else Error(bad_input); color
/// is at most 1.
inline glm::vec3 emitted(const glm::dvec3& color, double strength, const std::string& color_name,
                         const std::string& strength_name, const std::string& file, Warnings& warnings) {
    for (int c = 0; c < 3; ++c) {
        if (color[c] < 0.0) bad_scene(file, color_name, to_text(color), "it must not be negative");
    }
    if (strength < 0.0) bad_scene(file, strength_name, fmt::to_string(strength), "it must not be negative");
    if (strength > FLT_MAX) {
        bad_scene(file, strength_name, fmt::to_string(strength), fmt::format("the limit is {}", FLT_MAX));
    }
    return clamped(color, 0.0, 1.0, color_name, warnings) * float(strength);
}

}  // namespace vkcppm
