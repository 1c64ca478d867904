#include "oracle/environment_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "oracle/bsdf.h"
#include "oracle/channels.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;

}  // namespace

EnvironmentLight::EnvironmentLight(const std::optional<Environment>& environment) {
    if (!environment) return;
    size_ = environment->size;
    radiance_.assign(environment->radiance.begin(), environment->radiance.end());
    assert(radiance_.size() == size_.pixels());
    for (std::size_t i = 0; i < radiance_.size(); ++i) {
        const double row = double(i / size_.width);
        const double high = std::cos(pi * row / size_.height), low = std::cos(pi * (row + 1.0) / size_.height);
        cumulative_.push_back(total_ += largest(radiance_[i]) * 2.0 * pi / size_.width * (high - low));
    }
}

std::size_t EnvironmentLight::pixel(const glm::dvec3& direction) const {
    const double u = 0.5 + std::atan2(direction.z, direction.x) / (2.0 * pi);
    const double v = std::acos(std::clamp(direction.y, -1.0, 1.0)) / pi;
    const auto column = std::min(std::uint32_t(u * size_.width), size_.width - 1);
    const auto row = std::min(std::uint32_t(v * size_.height), size_.height - 1);
    return std::size_t(row) * size_.width + column;
}

glm::dvec3 EnvironmentLight::radiance(const glm::dvec3& direction) const {
    return radiance_.empty() ? glm::dvec3(0.0) : radiance_[pixel(direction)];
}

glm::dvec3 EnvironmentLight::sample(std::mt19937_64& random) const {
    const double place = uniform(random) * total_;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), place);
    const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), cumulative_.size() - 1);
    const double column = double(i % size_.width) + uniform(random), row = double(i / size_.width);
    const double high = std::cos(pi * row / size_.height), low = std::cos(pi * (row + 1.0) / size_.height);
    const double y = high + (low - high) * uniform(random);
    const double angle = 2.0 * pi * (column / size_.width - 0.5), radius = std::sqrt(std::max(0.0, 1.0 - y * y));
    return {radius * std::cos(angle), y, radius * std::sin(angle)};
}

double EnvironmentLight::density(const glm::dvec3& direction) const {
    return empty() ? 0.0 : largest(radiance(direction)) / total_;
}

}  // namespace vkcppm::oracle
