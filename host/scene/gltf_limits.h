#pragma once
// What a small file must not add up to: names are cheap, what they stand for is not.

#include <cfloat>
#include <cstddef>
#include <string_view>

#include "scene/bad_scene.h"

namespace vkcppm {

constexpr std::size_t max_triangles = std::size_t(1) << 27;      // of all instances, degenerate ones included
constexpr std::size_t max_vertices = std::size_t(1) << 27;       // of all instances
constexpr std::size_t max_primitives = std::size_t(1) << 24;     // of all instances, empty ones included
constexpr std::size_t max_instances = std::size_t(1) << 24;      // of meshes
constexpr std::size_t max_read_vectors = std::size_t(1) << 27;   // of all accessors together
constexpr std::size_t max_zero_elements = std::size_t(1) << 22;  // of an accessor that no bytes of the file back
constexpr std::size_t max_texels = std::size_t(1) << 26;         // of all images together
constexpr std::size_t max_image_side = 16384;                    // texels
constexpr double max_coordinate = FLT_MAX;                       // m; its square is finite in double
constexpr double max_uv = 1 << 24;  // of texture coordinates and their transform: float has no fraction beyond

/// Throws Error(bad_scene) where `total` is above `limit`, e.g. "the number of triangles is 9; the limit is 8".
inline void check_total(std::size_t total, std::size_t limit, std::string_view what, std::string_view file) {
    if (total <= limit) return;
    bad_scene(file, fmt::format("the number of {}", what), fmt::to_string(total),
              fmt::format("the limit is {}", limit));
}

}  // namespace vkcppm
