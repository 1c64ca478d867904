#include "render/schedule.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

namespace vkcppm {
namespace {
constexpr int pooled = 2;  // pixels to each side
}

std::vector<float> exponents_of(const Settings& settings, const Extent& extent, std::span<const gpu::PixelState> before,
                                std::span<const gpu::PixelState> after) {
    const char* env = std::getenv("VKCPPM_SCHEDULE");
    const std::string rule = env ? env : "third";
    const double limit = std::getenv("VKCPPM_LIMIT") ? atof(std::getenv("VKCPPM_LIMIT")) : 1.0 / 3.0;
    std::vector<float> exponents(extent.pixels(), float(1.0 - settings.alpha));
    if (rule == "third") return exponents;
    if (rule == "none") return std::vector<float>(extent.pixels(), 0.0f);
    std::vector<double> own(extent.pixels(), -1.0);
    for (std::size_t i = 0; i < own.size(); ++i) {
        if (before[i].seeded && after[i].seeded) own[i] = std::log2(double(before[i].radius2) / after[i].radius2);
    }
    const int width = int(extent.width), height = int(extent.height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0.0, count = 0.0;
            for (int v = std::max(y - pooled, 0); v <= std::min(y + pooled, height - 1); ++v) {
                for (int u = std::max(x - pooled, 0); u <= std::min(x + pooled, width - 1); ++u) {
                    const double e = own[std::size_t(v) * extent.width + std::size_t(u)];
                    if (e < 0.0) continue;
                    sum += e;
                    ++count;
                }
            }
            exponents[std::size_t(y) * extent.width + std::size_t(x)] =
                count > 0.0 ? float(std::min(sum / count, limit)) : float(1.0 - settings.alpha);
        }
    }
    return exponents;
}

double mean_shrink(double exponent, std::uint32_t pilot, std::uint32_t first, std::uint32_t count) {
    const double from = double(first) / pilot, to = (double(first) + count) / pilot, rest = 1.0 - exponent;
    return (std::pow(to, rest) - std::pow(from, rest)) / (rest * (to - from));
}

}  // namespace vkcppm
