#pragma once
// A picture as means over square blocks of its pixels.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

/// Sides in pixels of the blocks over which pictures are looked at beside single pixels: 8, 64, 512, ..., the last
/// covers the whole picture.
std::vector<std::uint32_t> block_sides(Extent extent);

/// Columns and rows of blocks; those at the right and at the bottom are what is within the picture.
Extent blocks_of(Extent extent, std::uint32_t side);

/// The block of a pixel.
std::size_t block_at(Extent extent, std::uint32_t side, std::size_t pixel);

/// [blocks] Means of the values; [pixels].
std::vector<glm::dvec3> block_means(Extent extent, std::uint32_t side, const std::vector<glm::dvec3>& values);

}  // namespace vkcppm
