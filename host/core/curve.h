#pragma once
// Error against iterations and against time: when it is measured, and what is read from it.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/metrics.h"

namespace vkcppm {

/// A snapshot of a render. The clock runs while its passes do (eye, photon, grid, knn, gather, update, by the device's
/// timestamps) and stands still while it loads, compiles, takes this snapshot or writes.
struct CurvePoint {
    std::uint64_t iterations = 0;
    double seconds = 0.0;  // on the clock
    Comparison error;
};

using Curve = std::vector<CurvePoint>;  // in the order of iterations

/// An error at which a render ends.
struct StopAt {
    const Metric* metric = nullptr;
    double value = 0.0;  // > 0
};

/// True where there is a snapshot, and the last is at or below it.
bool reached(const StopAt& stop_at, const Curve& curve);

/// True where a snapshot is due after `iterations` >= 1 of them: powers of two up to 64, then multiples of 64.
/// Depends on nothing else, so that the same render is measured at the same iterations.
bool is_snapshot(std::uint64_t iterations);

/// Least squares slope of log y against log x over points with x, y > 0; absent for fewer than two different x.
std::optional<double> log_log_slope(std::span<const double> x, std::span<const double> y);

/// The x at which the piecewise log-log interpolation of (x, y) first comes down to `level`, as the paper reads times
/// to equal error (supplementary, Table 1). Absent where the curve never gets there; the first x where it begins below.
std::optional<double> first_at_or_below(std::span<const double> x, std::span<const double> y, double level);

}  // namespace vkcppm
