#include "study/seeds.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

const Metric& mse = find_metric("", "mse");

/// MSE = start * n^slope at the iterations; `each` seconds an iteration.
Curve power_law(const std::vector<std::uint64_t>& iterations, double start, double slope, double each) {
    Curve curve;
    for (const std::uint64_t n : iterations) {
        CurvePoint point{n, each * double(n), {}};
        point.error.mse = {start * std::pow(double(n), slope), 0.0};
        curve.push_back(point);
    }
    return curve;
}

const std::vector<std::uint64_t> doubling = {1, 2, 4, 8, 16, 32, 64, 128};

TEST(Seeds, BandOfOneSeedIsItsCurveToTheLastBit) {
    const std::vector<Curve> seeds = {power_law(doubling, 0.1, -2.0 / 3.0, 0.03)};
    for (const Axis axis : {Axis::iterations, Axis::seconds}) {
        const Band result = band(seeds, mse, axis);
        ASSERT_EQ(result.x.size(), doubling.size());
        for (std::size_t i = 0; i < doubling.size(); ++i) {
            EXPECT_EQ(result.x[i], axis == Axis::iterations ? double(doubling[i]) : seeds[0][i].seconds);
            EXPECT_EQ(result.error[i].mean, seeds[0][i].error.mse.all);
            EXPECT_FALSE(result.error[i].interval);
        }
        ASSERT_TRUE(result.slope);
        EXPECT_NEAR(result.slope->mean, -2.0 / 3.0, 1e-12);
    }
}

TEST(Seeds, BandIsTheGeometricMeanWithStudentsInterval) {
    const std::vector<Curve> seeds = {power_law(doubling, 0.1, -1.0, 0.03), power_law(doubling, 0.4, -1.0, 0.03)};
    const Band result = band(seeds, mse, Axis::iterations);
    // Logarithms of two errors a factor of 4 apart: their mean is a factor of 2 off, half the interval 12.706 log 2.
    for (std::size_t i = 0; i < result.x.size(); ++i) {
        EXPECT_NEAR(result.error[i].mean * result.x[i], 0.2, 1e-12);
        EXPECT_NEAR(std::log2(result.error[i].interval->high / result.error[i].mean), 12.706, 1e-3);
        EXPECT_NEAR(std::log2(result.error[i].mean / result.error[i].interval->low), 12.706, 1e-3);
    }
}

TEST(Seeds, AgainstTimeCurvesAreInterpolatedWhereAllReach) {
    // One seed is four times as slow: at the same time its error is that of a quarter of the iterations.
    const std::vector<Curve> seeds = {power_law(doubling, 0.1, -1.0, 0.01), power_law(doubling, 0.1, -1.0, 0.04)};
    const Band result = band(seeds, mse, Axis::seconds);
    ASSERT_GE(result.x.size(), 2u);
    EXPECT_NEAR(result.x.front(), 0.04, 1e-15) << "the slow seed's first snapshot";
    EXPECT_NEAR(result.x.back(), 1.28, 1e-14) << "the fast seed's last";
    for (std::size_t i = 0; i < result.x.size(); ++i) {
        const double fast = 0.1 * 0.01 / result.x[i];
        EXPECT_NEAR(result.error[i].mean, 2.0 * fast, 1e-12 * fast) << "of fast and 4 fast, at " << result.x[i];
    }
}

TEST(Seeds, IterationsThatOneSeedLacksAreLeftOutButTheFirstEnd) {
    const std::vector<Curve> seeds = {power_law({1, 2, 4, 7}, 0.1, -0.5, 1.0),
                                      power_law({1, 2, 4, 8, 9}, 0.1, -0.5, 1.0)};
    const Band result = band(seeds, mse, Axis::iterations);
    EXPECT_EQ(result.x, (std::vector<double>{1, 2, 4, 7}));
    EXPECT_NEAR(result.error.back().mean, 0.1 / std::sqrt(7.0), 1e-15) << "a power law is interpolated without error";
}

TEST(Seeds, SlopeIsThatOfTheLastFactorOfTen) {
    // Flat up to 8 iterations, then -1.
    Curve curve = power_law(doubling, 1.0, -1.0, 1.0);
    for (CurvePoint& point : curve) {
        if (point.iterations < 13) point.error.mse.all = 1.0 / 8.0;
    }
    const Band result = band(std::vector<Curve>{curve}, mse, Axis::iterations);
    ASSERT_TRUE(result.slope);
    EXPECT_NEAR(result.slope->mean, -1.0, 1e-12);
    EXPECT_FALSE(band(std::vector<Curve>{{curve.front()}}, mse, Axis::iterations).slope) << "one point has none";
}

TEST(Seeds, ErrorsThatAreNotPositiveAreNotDrawn) {
    Curve curve = power_law({1, 2, 4}, 0.1, -1.0, 1.0);
    curve[1].error.mse.all = 0.0;
    curve[2].error.mse.all = NAN;
    const Band result = band(std::vector<Curve>{curve}, mse, Axis::iterations);
    EXPECT_EQ(result.x, std::vector<double>{1.0});
    EXPECT_FALSE(result.slope);
    EXPECT_FALSE(final_error(std::vector<Curve>{curve}, mse));
}

TEST(Seeds, EqualErrorIsReadSeedBySeed) {
    const double each = 0.02;
    const std::vector<Curve> baseline = {power_law(doubling, 0.1, -0.5, each), power_law(doubling, 0.2, -0.5, each)};
    // An error 2 and 4 times smaller at the same iterations: there after 128 / 4 and 128 / 16 of them. An iteration
    // takes twice the time.
    const std::vector<Curve> better = {power_law(doubling, 0.05, -0.5, 2.0 * each),
                                       power_law(doubling, 0.05, -0.5, 2.0 * each)};
    const EqualError iterations = equal_error(better, baseline, mse, Axis::iterations);
    EXPECT_EQ(iterations.reached, 2u);
    EXPECT_NEAR(iterations.at->mean, std::sqrt(32.0 * 8.0), 1e-10);
    EXPECT_NEAR(iterations.speedup->mean, std::sqrt(4.0 * 16.0), 1e-10);
    EXPECT_NEAR(std::log2(iterations.speedup->interval->high / iterations.speedup->mean), 12.706, 1e-3)
        << "speedups of 4 and 16 are a factor of 2 from their mean";
    const EqualError seconds = equal_error(better, baseline, mse, Axis::seconds);
    EXPECT_NEAR(seconds.speedup->mean, 4.0, 1e-10);
    EXPECT_NEAR(seconds.at->mean, 2.0 * each * 16.0, 1e-10);
}

TEST(Seeds, EqualErrorTellsWhoNeverGetsThere) {
    const std::vector<Curve> baseline = {power_law(doubling, 0.1, -0.5, 1.0), power_law(doubling, 0.1, -0.5, 1.0)};
    const std::vector<Curve> worse = {power_law(doubling, 0.05, -0.5, 1.0), power_law(doubling, 0.2, -0.5, 1.0)};
    const EqualError result = equal_error(worse, baseline, mse, Axis::iterations);
    EXPECT_EQ(result.reached, 1u);
    EXPECT_FALSE(result.at || result.speedup);
}

TEST(Seeds, TheBaselineTakesWhatItTook) {
    // It was nearer by chance before its end: that does not make it faster than itself.
    std::vector<Curve> baseline = {power_law(doubling, 0.1, -0.5, 0.5)};
    baseline[0][5].error.mse.all = 1e-9;
    EXPECT_EQ(equal_error(baseline, Axis::iterations).at->mean, 128.0);
    EXPECT_EQ(equal_error(baseline, Axis::seconds).at->mean, 64.0);
    EXPECT_EQ(equal_error(baseline, Axis::seconds).speedup->mean, 1.0);
}

}  // namespace
}  // namespace vkcppm
