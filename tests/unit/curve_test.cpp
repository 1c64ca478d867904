#include "core/curve.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

using Values = std::vector<double>;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// y = factor x^exponent.
Values power_law(const Values& x, double factor, double exponent) {
    Values y;
    for (const double value : x) y.push_back(factor * std::pow(value, exponent));
    return y;
}

TEST(Snapshots, AreAtPowersOfTwoAndThenEvenlySpaced) {
    std::vector<std::uint64_t> due;
    for (std::uint64_t i = 1; i <= 300; ++i) {
        if (is_snapshot(i)) due.push_back(i);
    }
    EXPECT_EQ(due, (std::vector<std::uint64_t>{1, 2, 4, 8, 16, 32, 64, 128, 192, 256}));
    EXPECT_TRUE(is_snapshot(std::uint64_t(1) << 40));
    EXPECT_FALSE(is_snapshot((std::uint64_t(1) << 40) + 32));
}

TEST(Slope, OfAPowerLawIsItsExponent) {
    const Values x{1, 2, 4, 8, 16, 32, 64, 128, 192};
    for (const double exponent : {-1.0, -2.0 / 3.0, 0.0, 0.25}) {
        const auto slope = log_log_slope(x, power_law(x, 3.0, exponent));
        ASSERT_TRUE(slope);
        EXPECT_NEAR(*slope, exponent, 1e-14);
    }
}

TEST(Slope, IsTheLeastSquaresOneOfTheLogarithms) {
    // The normal equations in long double against the running sums.
    std::mt19937 engine(3);
    std::normal_distribution<double> noise(0.0, 0.4);
    Values x, y;
    long double n = 0.0L, su = 0.0L, sv = 0.0L, suu = 0.0L, suv = 0.0L;
    for (int i = 1; i <= 50; ++i) {
        x.push_back(1000.0 * i);
        y.push_back(0.2 * std::pow(i, -0.7) * std::exp(noise(engine)));
        const long double u = std::log((long double)x.back()), v = std::log((long double)y.back());
        n += 1.0L, su += u, sv += v, suu += u * u, suv += u * v;
    }
    const auto slope = log_log_slope(x, y);
    ASSERT_TRUE(slope);
    EXPECT_NEAR(*slope, double((n * suv - su * sv) / (n * suu - su * su)), 1e-12);
}

TEST(Slope, LeavesOutWhatHasNoLogarithm) {
    const Values x{0.0, 1.0, 2.0, -4.0, 4.0, 8.0, 9.0}, y{5.0, 8.0, 4.0, 1.0, 2.0, 0.0, no_value};
    const auto slope = log_log_slope(x, y);
    ASSERT_TRUE(slope);
    EXPECT_NEAR(*slope, -1.0, 1e-14);
}

TEST(Slope, NeedsTwoDifferentAbscissas) {
    EXPECT_FALSE(log_log_slope({}, {}));
    EXPECT_FALSE(log_log_slope(Values{2.0}, Values{3.0}));
    EXPECT_FALSE(log_log_slope(Values{2.0, 2.0, 2.0}, Values{3.0, 4.0, 5.0}));
    EXPECT_FALSE(log_log_slope(Values{2.0, 3.0}, Values{1.0, 0.0}));
}

TEST(EqualError, IsReadExactlyOffAPowerLaw) {
    const Values x{1, 2, 4, 8, 16, 32, 64, 128, 192, 256};
    const Values y = power_law(x, 5.0, -0.75);
    for (const double at : {1.5, 2.0, 3.0, 50.0, 150.0, 191.9, 255.0}) {
        const auto found = first_at_or_below(x, y, 5.0 * std::pow(at, -0.75));
        ASSERT_TRUE(found) << at;
        EXPECT_NEAR(*found / at, 1.0, 1e-13);
    }
}

TEST(EqualError, OfAPointIsThatPoint) {
    const Values x{1.0, 3.0, 7.0, 20.0}, y{0.9, 0.5, 0.25, 0.1};
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto found = first_at_or_below(x, y, y[i]);
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, x[i], 1e-14 * x[i]);
    }
    EXPECT_FALSE(first_at_or_below(x, y, std::nextafter(0.1, 0.0)));
}

TEST(EqualError, IsTheFirstOfSeveral) {
    // Flat at the level, up again, and below it for good: the first touch counts.
    const Values x{1.0, 2.0, 4.0, 8.0, 16.0}, y{4.0, 1.0, 1.0, 3.0, 0.5};
    EXPECT_EQ(first_at_or_below(x, y, 1.0), 2.0);
    const auto between = first_at_or_below(x, y, 2.0);  // on y = 4 x^-2
    ASSERT_TRUE(between);
    EXPECT_NEAR(*between, std::sqrt(2.0), 1e-15);
    const auto late = first_at_or_below(x, y, 0.75);  // from (8, 3) to (16, 0.5)
    ASSERT_TRUE(late);
    EXPECT_NEAR(*late, 8.0 * std::pow(2.0, std::log(4.0) / std::log(6.0)), 1e-13);
}

TEST(EqualError, OfACurveThatBeginsBelowIsItsBeginning) {
    EXPECT_EQ(first_at_or_below(Values{1.0, 2.0}, Values{0.5, 0.9}, 0.6), 1.0);
    EXPECT_EQ(first_at_or_below(Values{1.0, 2.0}, Values{0.5, 0.1}, 0.5), 1.0);
}

TEST(EqualError, IsAbsentWhereTheCurveNeverGetsThere) {
    EXPECT_FALSE(first_at_or_below({}, {}, 1.0));
    EXPECT_FALSE(first_at_or_below(Values{1.0, 2.0}, Values{3.0, 2.0}, 1.0));
    EXPECT_FALSE(first_at_or_below(Values{1.0, 2.0}, Values{no_value, no_value}, 1.0));
    EXPECT_FALSE(first_at_or_below(Values{1.0, 2.0}, Values{3.0, 2.0}, 0.0));
    EXPECT_FALSE(first_at_or_below(Values{1.0}, Values{infinity}, 1.0));
}

TEST(EqualError, OfACurveThatComesToZeroIsThatPoint) {
    EXPECT_EQ(first_at_or_below(Values{1.0, 2.0, 4.0}, Values{3.0, 2.0, 0.0}, 1.0), 4.0);
    EXPECT_EQ(first_at_or_below(Values{1.0, 2.0, 4.0}, Values{3.0, 2.0, 0.0}, 0.0), 4.0);
}

}  // namespace
}  // namespace vkcppm
