#pragma once
// A mean of few independent values, such as one a seed, and how far it can be trusted.

#include <optional>
#include <span>

namespace vkcppm {

inline constexpr double confidence = 0.95;  // of every interval

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

struct Estimate {
    double mean = 0.0;
    std::optional<Interval> interval;  // by Student's t; absent for one value, which tells nothing of its spread
};

/// Mean of one value or more.
Estimate arithmetic_mean(std::span<const double> values);

/// exp of the arithmetic mean of the logarithms and of its interval. Asserts that all values are > 0.
Estimate geometric_mean(std::span<const double> values);

}  // namespace vkcppm
