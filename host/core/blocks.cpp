#include "core/blocks.h"

#include <algorithm>
#include <cassert>

namespace vkcppm {
namespace {

constexpr std::uint32_t sides_apart = 8;

}  // namespace

std::vector<std::uint32_t> block_sides(Extent extent) {
    std::vector<std::uint32_t> sides;
    std::uint32_t side = 1;
    while (side < std::max(extent.width, extent.height)) sides.push_back(side *= sides_apart);
    return sides;
}

Extent blocks_of(Extent extent, std::uint32_t side) {
    return {(extent.width + side - 1) / side, (extent.height + side - 1) / side};
}

std::size_t block_at(Extent extent, std::uint32_t side, std::size_t pixel) {
    const std::size_t x = pixel % extent.width, y = pixel / extent.width;
    return y / side * blocks_of(extent, side).width + x / side;
}

std::vector<glm::dvec3> block_means(Extent extent, std::uint32_t side, const std::vector<glm::dvec3>& values) {
    assert(values.size() == extent.pixels());
    std::vector<glm::dvec3> means(blocks_of(extent, side).pixels(), glm::dvec3(0.0));
    std::vector<double> counts(means.size(), 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t block = block_at(extent, side, i);
        means[block] += values[i];
        counts[block] += 1.0;
    }
    for (std::size_t block = 0; block < means.size(); ++block) means[block] /= counts[block];
    return means;
}

}  // namespace vkcppm
