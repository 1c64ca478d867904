#include "render/grid.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

namespace vkcppm {
namespace {

constexpr std::uint32_t least_mask = 7;  // of a hash of runs of eight cells

}  // namespace

bool grid_fits(const gpu::Grid& grid, const gpu::Params& params) {
    if (grid.levels < 1 || grid.levels > params.most_levels || grid.entries > params.cells) return false;
    for (std::uint32_t level = 0; level < grid.levels; ++level) {
        const gpu::uvec4& dims = grid.dims[level];
        const double cells = double(dims.x) * double(dims.y) * double(dims.z);
        const bool sized = std::isfinite(grid.cell[level]) && grid.cell[level] > 0.0f &&
                           std::isfinite(grid.inverse_cell[level]) && cells >= 1.0;
        const bool hashes = dims.w == 0 || (dims.w >= least_mask && std::has_single_bit(std::uint64_t(dims.w) + 1));
        const double entries = dims.w == 0 ? cells : double(dims.w) + 1.0;
        const double end = level + 1 < grid.levels ? grid.first[level + 1] : grid.entries;
        if (!sized || !hashes || grid.first[level] + entries != end) return false;
    }
    return true;
}

gpu::Grid coarsest(const gpu::Grid& grid, std::uint32_t levels) {
    assert(levels > 0 && grid.levels > 0);
    gpu::Grid kept = grid;
    kept.levels = std::min(grid.levels, levels);
    const std::uint32_t dropped = grid.levels - kept.levels;
    const auto drop = [&](auto& values) { std::shift_left(std::begin(values), std::end(values), dropped); };
    drop(kept.dims);
    drop(kept.cell);
    drop(kept.inverse_cell);
    drop(kept.reach);
    drop(kept.first);
    // Kernels may know of more levels.
    std::fill(std::begin(kept.reach) + (kept.levels - 1), std::end(kept.reach), std::numeric_limits<float>::max());
    return kept;
}

}  // namespace vkcppm
