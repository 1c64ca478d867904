#pragma once
// What the curves of several seeds say together.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/curve.h"
#include "core/metrics.h"
#include "study/estimate.h"

namespace vkcppm {

/// What an error is drawn against.
enum class Axis { iterations, seconds };

/// Curves of one estimator, one a seed, in the order of the seeds.
using Seeds = std::span<const Curve>;

/// The geometric mean of the errors over the seeds. [points] each, x rising, errors > 0.
struct Band {
    std::vector<double> x;
    std::vector<Estimate> error;
    std::optional<Estimate> slope;  // mean over the seeds of log_log_slope over the last factor of ten of x
};

/// Against iterations: at those where every seed has a snapshot. Against seconds: at the geometric mean of the seeds'
/// times of these, moved to where all curves reach. Both: also where the first curve ends. Between snapshots every
/// curve is interpolated log-log.
Band band(Seeds seeds, const Metric& metric, Axis axis);

/// How soon an estimator comes down to the error that a baseline has at its end, seed by seed.
struct EqualError {
    std::size_t reached = 0;          // seeds in which it comes down to it
    std::optional<Estimate> at;       // iterations or seconds: geometric mean, where all seeds reach it
    std::optional<Estimate> speedup;  // the baseline's own over them, the same
};

/// `seeds` and `baseline` [the same number]. By first_at_or_below.
EqualError equal_error(Seeds seeds, Seeds baseline, const Metric& metric, Axis axis);

/// The baseline held to itself: the end of every curve, speedup 1.
EqualError equal_error(Seeds baseline, Axis axis);

/// The error at the end of every curve: geometric mean. Absent where one has none that is > 0.
std::optional<Estimate> final_error(Seeds seeds, const Metric& metric);

}  // namespace vkcppm
