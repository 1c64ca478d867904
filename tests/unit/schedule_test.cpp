// How radii go on after a pilot: means of the law over a slice, and the exponents of the estimators.

#include "render/schedule.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/estimators.h"

namespace vkcppm {
namespace {

TEST(Schedule, ASliceHasTheMeanOfItsIterations) {
    for (const double exponent : {0.0, 0.2, 1.0 / 3.0, 0.5503, 0.999, 1.0}) {
        for (const std::uint32_t first : {16u, 20u, 1000u}) {
            for (const std::uint32_t count : {1u, 4u, 16u}) {
                double sum = 0.0;  // over the middles of iterations and of their tenths
                for (std::uint32_t i = 0; i < 10 * count; ++i) {
                    sum += std::pow((first + (i + 0.5) / 10.0) / 16.0, -exponent);
                }
                EXPECT_NEAR(mean_shrink(exponent, 16, first, count), sum / (10.0 * count), 1e-5)
                    << exponent << ", " << count << " from " << first;
            }
        }
    }
}

TEST(Schedule, FollowsTheLawOfTheEstimator) {
    Settings settings;
    for (const EstimatorRow& row : estimators()) {
        settings.estimator = row.name;
        const double exponent = shrink_exponent(settings);
        EXPECT_GT(exponent, 0.0) << row.name;
        EXPECT_LT(exponent, 1.0) << row.name;
    }
    settings.estimator = "sppm";
    settings.alpha = 0.7;
    EXPECT_DOUBLE_EQ(shrink_exponent(settings), 0.3);
    // R^2 ~ T^(-1/3) where every batch is rejected and batches grow by k^-2.
    settings.estimator = "cppm-null";
    settings.k = 0.8;
    settings.beta = 1.0 / (0.8 * 0.8);
    EXPECT_NEAR(shrink_exponent(settings), 1.0 / 3.0, 1e-12);
}

// Knaus and Zwicker's radii, r_(i+1)^2 = r_i^2 (i + alpha) / (i + 1), from a pilot of 64 iterations on.
TEST(Schedule, IsKnausAndZwickersForTheirExponent) {
    const double alpha = 2.0 / 3.0;
    double shrink = 1.0, sum = 0.0;
    for (std::uint32_t i = 64; i < 4096; ++i) {
        if (i >= 4000) sum += shrink / 96.0;
        shrink *= (i + alpha) / (i + 1.0);
    }
    EXPECT_NEAR(mean_shrink(1.0 - alpha, 64, 4000, 96) / sum, 1.0, 0.005);
}

}  // namespace
}  // namespace vkcppm
