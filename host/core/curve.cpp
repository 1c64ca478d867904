#include "core/curve.h"

#include <cassert>
#include <cmath>

namespace vkcppm {
namespace {

constexpr std::uint64_t last_doubling = 64;

}  // namespace

bool is_snapshot(std::uint64_t iterations) {
    assert(iterations > 0);
    return iterations < last_doubling ? (iterations & (iterations - 1)) == 0 : iterations % last_doubling == 0;
}

bool reached(const StopAt& stop_at, const Curve& curve) {
    return !curve.empty() && stop_at.metric->of(curve.back().error) <= stop_at.value;
}

std::optional<double> log_log_slope(std::span<const double> x, std::span<const double> y) {
    assert(x.size() == y.size());
    double count = 0.0, mean_x = 0.0, mean_y = 0.0;
    double square = 0.0, product = 0.0;  // running sums of squares about the means (Welford 1962)
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0.0 && y[i] > 0.0)) continue;
        count += 1.0;
        const double u = std::log(x[i]), v = std::log(y[i]);
        const double du = u - mean_x;
        mean_x += du / count;
        mean_y += (v - mean_y) / count;
        square += du * (u - mean_x);
        product += du * (v - mean_y);
    }
    if (!(square > 0.0)) return std::nullopt;
    return product / square;
}

std::optional<double> first_at_or_below(std::span<const double> x, std::span<const double> y, double level) {
    assert(x.size() == y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(y[i] <= level)) continue;
        if (i == 0 || !(level > 0.0) || !(y[i] > 0.0)) return x[i];
        const double part = std::log(y[i - 1] / level) / std::log(y[i - 1] / y[i]);
        return x[i - 1] * std::pow(x[i] / x[i - 1], part);
    }
    return std::nullopt;
}

}  // namespace vkcppm
