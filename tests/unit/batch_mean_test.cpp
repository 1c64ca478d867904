#include "study/batch_mean.h"

#include <random>

#include <gtest/gtest.h>

namespace vkcppm::test {
namespace {

TEST(BatchMean, AndItsErrorAreThoseOfTwoPasses) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(1000.0, 1.0);  // a small spread on a large mean
    std::vector<std::vector<glm::dvec3>> batches(50, std::vector<glm::dvec3>(6));
    for (auto& batch : batches) {
        for (glm::dvec3& pixel : batch) pixel = {normal(random), 2.0 * normal(random), -normal(random)};
    }
    BatchMean running({3, 2});
    EXPECT_EQ(running.squared_error(0), glm::dvec3(0.0));
    for (const auto& batch : batches) running.add(batch);
    EXPECT_EQ(running.batches(), batches.size());
    const double n = double(batches.size());
    for (std::size_t pixel = 0; pixel < 6; ++pixel) {
        for (int c = 0; c < 3; ++c) {
            double mean = 0.0, squares = 0.0;
            for (const auto& batch : batches) mean += batch[pixel][c] / n;
            for (const auto& batch : batches) squares += (batch[pixel][c] - mean) * (batch[pixel][c] - mean);
            EXPECT_NEAR(running.mean()[pixel][c], mean, 1e-9);
            EXPECT_NEAR(running.squared_error(pixel)[c], squares / (n - 1.0) / n, 1e-9);
        }
    }
}

TEST(BatchMean, NoErrorIsKnownOfOneBatch) {
    BatchMean running({1, 1});
    running.add(std::vector<glm::dvec3>{{1.0, 2.0, 3.0}});
    EXPECT_EQ(running.mean()[0], glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(running.squared_error(0), glm::dvec3(0.0));
}

}  // namespace
}  // namespace vkcppm::test
