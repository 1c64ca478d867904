#pragma once
// The grid of photons as the device holds it.

#include <cstdint>

#include "shared/types.h"

namespace vkcppm {

/// True where kernels stay within their table of cells and their sorted photons.
bool grid_fits(const gpu::Grid& grid, const gpu::Params& params);

/// The grid without its finest levels, so that it has at most so many: discs that looked there look at the finest that
/// is left.
gpu::Grid coarsest(const gpu::Grid& grid, std::uint32_t levels);

}  // namespace vkcppm
