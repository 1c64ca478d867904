#include "render/status.h"

#include <fmt/format.h>

#include "core/error.h"

namespace vkcppm {

StatusCounts take_counts(gpu::Status& status, std::uint32_t step_budget, const std::string& device) {
    if (status.stuck > 0) {
        throw Error(ExitCode::internal,
                    fmt::format("{} rays need more than {} steps of the BVH each, the limit of device '{}'",
                                status.stuck, step_budget, device));
    }
    const StatusCounts counts{(std::uint64_t(status.rays_high) << 32) + status.rays, status.stored, status.invalid};
    status.rays = status.rays_high = status.stored = status.invalid = status.blocked = 0;
    return counts;
}

}  // namespace vkcppm
