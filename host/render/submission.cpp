#include "render/submission.h"

#include <algorithm>

namespace vkcppm {
namespace {

constexpr double submission_seconds = 0.1;
constexpr std::uint32_t most_iterations = 32;

}  // namespace

std::uint32_t submission_size(std::uint32_t done, double seconds, const Settings& settings,
                              const std::function<bool(std::uint32_t)>& is_measured) {
    if (done == 0) return 1;
    const double each = std::max(seconds / done, 1e-6);
    double wanted = std::min<double>(most_iterations, submission_seconds / each);
    if (settings.seconds) wanted = std::min(wanted, (*settings.seconds - seconds) / each);
    const std::uint32_t most = std::min(settings.iterations - done, std::uint32_t(std::max(wanted, 1.0)));
    std::uint32_t size = 1;
    while (size < most && !is_measured(done + size)) ++size;
    return size;
}

}  // namespace vkcppm
