#include "study/estimate.h"

#include <cassert>
#include <cmath>
#include <vector>

#include <boost/math/distributions/students_t.hpp>

namespace vkcppm {

Estimate arithmetic_mean(std::span<const double> values) {
    assert(!values.empty());
    double mean = 0.0, squares = 0.0;  // running sum of squares about the mean (Welford 1962)
    double count = 0.0;
    for (const double value : values) {
        count += 1.0;
        const double from_mean = value - mean;
        mean += from_mean / count;
        squares += from_mean * (value - mean);
    }
    if (values.size() < 2) return {mean, std::nullopt};
    const boost::math::students_t distribution(count - 1.0);
    const double quantile = boost::math::quantile(complement(distribution, 0.5 * (1.0 - confidence)));
    const double half = quantile * std::sqrt(squares / (count - 1.0) / count);
    return {mean, Interval{mean - half, mean + half}};
}

Estimate geometric_mean(std::span<const double> values) {
    if (values.size() == 1) return {values.front(), std::nullopt};  // to the last bit
    std::vector<double> logarithms;
    for (const double value : values) {
        assert(value > 0.0);
        logarithms.push_back(std::log(value));
    }
    Estimate estimate = arithmetic_mean(logarithms);
    estimate.mean = std::exp(estimate.mean);
    if (estimate.interval) {
        estimate.interval = Interval{std::exp(estimate.interval->low), std::exp(estimate.interval->high)};
    }
    return estimate;
}

}  // namespace vkcppm
