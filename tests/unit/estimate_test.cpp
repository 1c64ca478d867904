#include "study/estimate.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

TEST(Estimate, OneValueHasNoInterval) {
    const std::array value{0.1};
    EXPECT_EQ(arithmetic_mean(value).mean, 0.1);
    EXPECT_FALSE(arithmetic_mean(value).interval);
    EXPECT_EQ(geometric_mean(value).mean, 0.1) << "to the last bit: no logarithm in between";
    EXPECT_FALSE(geometric_mean(value).interval);
}

/// Quantiles of Student's t at 97.5 % from printed tables (Fisher and Yates 1963, table III).
TEST(Estimate, IntervalsAreStudents) {
    const std::vector<std::pair<std::vector<double>, double>> cases = {
        {{1.0, 3.0}, 12.706}, {{1.0, 2.0, 6.0}, 4.303}, {{5.0, 1.0, 4.0, 2.0, 3.0}, 2.776}};
    for (const auto& [values, quantile] : cases) {
        double sum = 0.0, squares = 0.0;
        for (const double value : values) sum += value;
        const double n = double(values.size()), mean = sum / n;
        for (const double value : values) squares += (value - mean) * (value - mean);
        const double half = quantile * std::sqrt(squares / (n - 1.0) / n);
        const Estimate estimate = arithmetic_mean(values);
        EXPECT_NEAR(estimate.mean, mean, 1e-14);
        ASSERT_TRUE(estimate.interval);
        EXPECT_NEAR(estimate.interval->low, mean - half, 3e-4 * half) << n << " values";
        EXPECT_NEAR(estimate.interval->high, mean + half, 3e-4 * half) << n << " values";
    }
}

TEST(Estimate, GeometricIsArithmeticOfLogarithms) {
    const std::array values{1e-4, 1e-3, 1e-2};
    const std::array logarithms{-4.0, -3.0, -2.0};
    const Estimate geometric = geometric_mean(values), arithmetic = arithmetic_mean(logarithms);
    EXPECT_NEAR(std::log10(geometric.mean), -3.0, 1e-12);
    EXPECT_NEAR(std::log10(geometric.interval->low), arithmetic.interval->low, 1e-12);
    EXPECT_NEAR(std::log10(geometric.interval->high), arithmetic.interval->high, 1e-12);
}

}  // namespace
}  // namespace vkcppm
