#pragma once
// What kernels tell the host by gpu::Status.

#include <cstdint>
#include <string>

#include "shared/types.h"

namespace vkcppm {

/// Of the passes since it was taken last.
struct StatusCounts {
    std::uint64_t rays = 0;     // as far as kernels count them
    std::uint64_t stored = 0;   // photons
    std::uint64_t invalid = 0;  // contributions that were not finite and were dropped
};

/// Takes the counts out of `status`, and that passes are blocked, so that the next count from 0. Throws Error(internal)
/// where rays could not be traced within `step_budget`, the limit of the device of that name.
StatusCounts take_counts(gpu::Status& status, std::uint32_t step_budget, const std::string& device);

}  // namespace vkcppm
