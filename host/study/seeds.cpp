#include "study/seeds.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vkcppm {
namespace {

constexpr double rounding = 1e-12;      // of a geometric mean
constexpr double fitted_factor = 10.0;  // of x, up to its end: the first iterations do not follow a power law

/// A curve of one metric against one axis. x, y [points]
struct Line {
    std::vector<double> x;
    std::vector<double> y;
};

double position(const CurvePoint& point, Axis axis) {
    return axis == Axis::iterations ? double(point.iterations) : point.seconds;
}

Line line_of(const Curve& curve, const Metric& metric, Axis axis) {
    Line line;
    for (const CurvePoint& point : curve) {
        line.x.push_back(position(point, axis));
        line.y.push_back(metric.of(point.error));
    }
    return line;
}

/// y at `x` between the ends of the line, log-log. Absent outside, and next to a y that is not > 0.
std::optional<double> interpolate(const Line& line, double x) {
    const auto next = std::lower_bound(line.x.begin(), line.x.end(), x);
    if (next == line.x.end()) return std::nullopt;
    const auto i = std::size_t(next - line.x.begin());
    if (!(line.y[i] > 0.0)) return std::nullopt;
    if (*next == x) return line.y[i];
    if (i == 0 || !(line.y[i - 1] > 0.0) || !(line.x[i - 1] > 0.0)) return std::nullopt;
    const double part = std::log(x / line.x[i - 1]) / std::log(line.x[i] / line.x[i - 1]);
    return line.y[i - 1] * std::pow(line.y[i] / line.y[i - 1], part);
}

/// x at the iterations at which every seed has a snapshot, the geometric mean over the seeds, and the first end of one.
std::vector<double> common_positions(Seeds seeds, Axis axis) {
    std::vector<double> positions;
    for (const CurvePoint& point : seeds.front()) {
        std::vector<double> of_seeds;
        for (const Curve& curve : seeds) {
            const auto same = std::ranges::find(curve, point.iterations, &CurvePoint::iterations);
            if (same != curve.end() && position(*same, axis) > 0.0) of_seeds.push_back(position(*same, axis));
        }
        // Iterations agree: their mean is one of them, free of rounding.
        if (of_seeds.size() == seeds.size()) {
            positions.push_back(axis == Axis::iterations ? of_seeds.front() : geometric_mean(of_seeds).mean);
        }
    }
    double begin = 0.0, end = INFINITY;  // where all curves reach
    for (const Curve& curve : seeds) {
        begin = std::max(begin, position(curve.front(), axis));
        end = std::min(end, position(curve.back(), axis));
    }
    if (!(begin > 0.0 && begin <= end)) return {};
    for (double& x : positions) x = std::clamp(x, begin, end);
    if (positions.empty() || end > (1.0 + rounding) * positions.back()) positions.push_back(end);
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    return positions;
}

std::optional<double> slope_of_end(const Line& line) {
    const double from = line.x.back() / fitted_factor;
    const auto first = std::size_t(std::ranges::lower_bound(line.x, from) - line.x.begin());
    return log_log_slope(std::span(line.x).subspan(first), std::span(line.y).subspan(first));
}

}  // namespace

Band band(Seeds seeds, const Metric& metric, Axis axis) {
    assert(!seeds.empty());
    std::vector<Line> lines;
    std::vector<double> slopes;
    for (const Curve& curve : seeds) {
        assert(!curve.empty());
        lines.push_back(line_of(curve, metric, axis));
        if (const auto slope = slope_of_end(lines.back())) slopes.push_back(*slope);
    }
    Band band;
    for (const double x : common_positions(seeds, axis)) {
        std::vector<double> errors;
        for (const Line& line : lines) {
            if (const auto error = interpolate(line, x)) errors.push_back(*error);
        }
        if (errors.size() < lines.size()) continue;
        band.x.push_back(x);
        band.error.push_back(geometric_mean(errors));
    }
    if (slopes.size() == seeds.size()) band.slope = arithmetic_mean(slopes);
    return band;
}

EqualError equal_error(Seeds seeds, Seeds baseline, const Metric& metric, Axis axis) {
    assert(seeds.size() == baseline.size());
    std::vector<double> at, speedups;
    for (std::size_t s = 0; s < seeds.size(); ++s) {
        const Line line = line_of(seeds[s], metric, axis);
        const auto x = first_at_or_below(line.x, line.y, metric.of(baseline[s].back().error));
        if (!x || !(*x > 0.0)) continue;
        at.push_back(*x);
        speedups.push_back(position(baseline[s].back(), axis) / *x);
    }
    EqualError result{at.size(), std::nullopt, std::nullopt};
    if (at.size() == seeds.size()) {
        result.at = geometric_mean(at);
        result.speedup = geometric_mean(speedups);
    }
    return result;
}

EqualError equal_error(Seeds baseline, Axis axis) {
    std::vector<double> at;
    for (const Curve& curve : baseline) at.push_back(position(curve.back(), axis));
    return {at.size(), geometric_mean(at), Estimate{1.0, std::nullopt}};
}

std::optional<Estimate> final_error(Seeds seeds, const Metric& metric) {
    std::vector<double> errors;
    for (const Curve& curve : seeds) {
        const double error = metric.of(curve.back().error);
        if (!(error > 0.0)) return std::nullopt;
        errors.push_back(error);
    }
    return geometric_mean(errors);
}

}  // namespace vkcppm
