#pragma once
// What a small file must not add up to: names are cheap, what they stand for is not.

#include <algorithm>
#include <cfloat>
#include <cstddef>
#include <string_view>

#include "core/process.h"
#include "scene/bad_scene.h"
#include "scene/gltf/file.h"

namespace vkcppm {

/// How many things a file may stand for: so many for each of its bytes, its buffers' included, and 2^18 more, but never
/// more than `most`.
struct Expansion {
    std::size_t per_byte;
    std::size_t most;

    std::size_t of(std::size_t bytes) const { return std::min(most, (std::size_t(1) << 18) + per_byte * bytes); }
};

constexpr Expansion max_triangles{256, std::size_t(1) << 27};    // of all instances, degenerate ones included
constexpr Expansion max_vertices{256, std::size_t(1) << 27};     // of all instances
constexpr Expansion max_primitives{256, std::size_t(1) << 24};   // of all instances, empty ones included
constexpr Expansion max_instances{256, std::size_t(1) << 24};    // of meshes
constexpr Expansion max_read_vectors{16, std::size_t(1) << 27};  // of all accessors together
constexpr Expansion max_decoded_bytes{256, max_gltf_bytes};      // of all compressed bufferViews
constexpr Expansion max_draco_bytes{1024, max_gltf_bytes};       // of all that KHR_draco_mesh_compression decodes to
constexpr std::size_t max_image_side = 16384;                    // texels
constexpr std::size_t max_texels_per_byte = 8256;                // of an image: Deflate's 1032 to 1, of 1-bit texels
constexpr double max_coordinate = FLT_MAX;                       // m; its square is finite in double
constexpr double max_uv = 1 << 24;  // of texture coordinates and their transform: float has no fraction beyond

constexpr std::size_t max_flat_texels = std::size_t(1) << 24;  // more of a WebP, whose flat parts take no bytes at all

/// Texels of all images together: 2^27, and of larger files 256 for each of their bytes, as many as can be numbered.
constexpr std::size_t max_texels(std::size_t bytes) {
    return std::clamp(256 * bytes, std::size_t(1) << 27, (std::size_t(1) << 32) - 1);
}

/// Throws Error(bad_input) where `total` is above `limit`, e.g. "the number of triangles is 9; the limit is 8".
inline void check_total(std::size_t total, std::size_t limit, std::string_view what, std::string_view file) {
    if (total <= limit) return;
    bad_scene(file, fmt::format("the number of {}", what), fmt::to_string(total),
              fmt::format("the limit is {}", limit));
}

/// The same with the limit for a file of its size.
inline void check_total(std::size_t total, const Expansion& limit, std::string_view what, const GltfFile& file) {
    if (total <= limit.of(file.bytes)) return;
    bad_scene(file.name, fmt::format("the number of {}", what), fmt::to_string(total),
              fmt::format("the limit is {} for its {} bytes", limit.of(file.bytes), file.bytes));
}

/// Throws Error(bad_input) where `total` things of so many bytes each are more than memory has left.
inline void check_room(std::size_t total, std::size_t bytes_each, std::string_view what, std::string_view file) {
    const std::size_t needed = total * bytes_each, there = available_memory();
    if (needed <= there) return;
    bad_scene(file, fmt::format("the number of {}", what), fmt::to_string(total),
              fmt::format("they need {} MB of memory, there are {} MB, enough for {}", needed / 1000000,
                          there / 1000000, there / bytes_each));
}

}  // namespace vkcppm
