#pragma once
// A picture in memory: linear Rec. 709 radiance, first row on top.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/ext/vector_uint3_sized.hpp>
#include <glm/vec3.hpp>

namespace vkcppm {

struct Extent {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::size_t pixels() const { return std::size_t(width) * height; }
    bool operator==(const Extent&) const = default;
};

/// rgb [height x width], W m^-2 sr^-1 a channel, linear Rec. 709, row-major, first row on top.
struct Image {
    Extent extent;
    std::vector<glm::vec3> rgb;
    const glm::vec3& at(std::uint32_t x, std::uint32_t y) const { return rgb[std::size_t(y) * extent.width + x]; }
    bool operator==(const Image&) const = default;
};

/// Whether all channels are numbers.
inline bool is_finite(const glm::vec3& rgb) {
    return std::isfinite(rgb.r) && std::isfinite(rgb.g) && std::isfinite(rgb.b);
}

/// rgb [height x width], 8-bit sRGB, row-major, first row on top: what a screen takes.
struct Bitmap {
    Extent extent;
    std::vector<glm::u8vec3> rgb;
};

}  // namespace vkcppm
