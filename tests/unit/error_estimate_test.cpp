// The estimate of a render's own error, on groups whose noise and bias are known.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/error_estimate.h"

namespace vkcppm::test {
namespace {

constexpr Extent extent{40, 25};  // 1000 pixels: one is left out of trimmed measures

/// Sums of a picture whose iterations are value(pixel, iteration): radiance and bias.
ErrorSums sums_of(std::uint32_t iterations, const std::function<glm::dvec4(std::size_t, std::uint32_t)>& value) {
    ErrorSums sums{extent, group_sizes(iterations), {}};
    std::vector<glm::dvec4> of_group[ERROR_GROUPS];
    for (auto& group : of_group) group.assign(extent.pixels(), glm::dvec4(0.0));
    for (std::uint32_t i = 0; i < iterations; ++i) {
        for (std::size_t pixel = 0; pixel < extent.pixels(); ++pixel)
            of_group[error_group(i)][pixel] += value(pixel, i);
    }
    for (std::size_t k = 0; k < ERROR_GROUPS; ++k) sums.of_group[k].assign(of_group[k].begin(), of_group[k].end());
    return sums;
}

/// Radiance `mean` with independent noise of `deviation` an iteration, the same for all channels, and a bias.
ErrorSums noisy(std::uint32_t seed, std::uint32_t iterations, double mean, double deviation, double bias = 0.0) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, deviation);
    return sums_of(iterations, [&](std::size_t, std::uint32_t) {
        return glm::dvec4(glm::dvec3(mean + noise(random)), bias + noise(random));
    });
}

TEST(ErrorGroups, HaveOneRunOfEveryOctave) {
    for (std::uint32_t octave = ERROR_GROUPS; octave <= 4096; octave *= 2) {
        std::vector<std::uint32_t> found(ERROR_GROUPS);
        for (std::uint32_t i = octave; i < 2 * octave; ++i) {
            ++found[error_group(i)];
            const bool goes_on = i % (octave / ERROR_GROUPS) != 0;
            EXPECT_TRUE(!goes_on || error_group(i) == error_group(i - 1)) << "iteration " << i;
        }
        for (const std::uint32_t count : found) EXPECT_EQ(count, octave / ERROR_GROUPS) << "octave from " << octave;
    }
    EXPECT_EQ(error_group(1u << 31), error_group((1u << 31) + 1));
}

TEST(ErrorGroups, TheirSizesAreThoseThatAreCounted) {
    std::array<std::uint32_t, ERROR_GROUPS> counted{};
    for (std::uint32_t iterations = 0; iterations < 700; ++iterations) {
        EXPECT_EQ(group_sizes(iterations), counted) << iterations << " iterations";
        ++counted[error_group(iterations)];
    }
}

TEST(ErrorEstimate, OfIndependentNoiseIsItsVariance) {
    for (const std::uint32_t iterations : {16u, 23u, 64u, 150u}) {
        const ErrorEstimate estimate = estimate_error(noisy(7, iterations, 0.5, 0.2));
        const double expected = 0.2 * 0.2 / iterations / (0.5 * 0.5 + 0.01);
        // 1,000 pixels of 7 degrees of freedom: 2 % of it, and with the part of strata 6 %.
        EXPECT_NEAR(estimate.relmse.noise, expected, 0.2 * expected) << iterations << " iterations";
        EXPECT_NEAR(estimate.noise.value, std::sqrt(expected), 0.12 * std::sqrt(expected)) << iterations;
        EXPECT_LT(estimate.relmse_trimmed.error.value, estimate.relmse.error.value);
        EXPECT_EQ(estimate.rare, 0.0);
    }
}

TEST(ErrorEstimate, OfABiasIsItsSquare) {
    const double bias = 0.15;
    const ErrorEstimate estimate = estimate_error(noisy(8, 64, 0.5, 0.02, bias));
    const double expected = bias * bias / ((0.5 - bias) * (0.5 - bias) + 0.01);  // relative to the truth
    EXPECT_NEAR(estimate.relmse.bias, expected, 0.01 * expected);
    EXPECT_NEAR(estimate.relmse.error.value, estimate.relmse.noise + estimate.relmse.bias, 1e-12);
}

// The bar must hold what is expected of a picture: over seeds the bound of 90 % holds the expectation in 90 % of them,
// here within the binomial interval of 1 in 1000.
TEST(ErrorEstimate, BoundHoldsAtItsLevel) {
    constexpr int seeds = 200;
    constexpr std::uint32_t iterations = 32;
    const double expected = 0.2 * 0.2 / iterations / (0.5 * 0.5 + 0.01);
    int below = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> noise(0.0, 0.2);
        // All pixels of an iteration move together in part, as those that share photons do.
        std::vector<double> shared(iterations);
        for (double& value : shared) value = noise(random);
        const ErrorSums sums = sums_of(iterations, [&](std::size_t, std::uint32_t i) {
            const double own = noise(random);
            return glm::dvec4(glm::dvec3(0.5 + std::sqrt(0.5) * (own + shared[i])), 0.0);
        });
        below += expected <= upper_bound(estimate_error(sums).relmse.error, 0.9) ? 1 : 0;
    }
    EXPECT_GE(below, 166) << "of " << seeds;
    RecordProperty("below", below);
}

// A pixel that an edge crosses, sampled by an additive recurrence: its error falls faster than with 1 / N, which the
// spread of the groups alone does not show.
TEST(ErrorEstimate, OfStrataIsSmallerThanTheSpreadOfGroups) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform;
    constexpr std::uint32_t iterations = 256;
    std::vector<glm::dvec4> edges;  // shift of both dimensions, slope, covered part
    for (std::size_t i = 0; i < extent.pixels(); ++i) {
        edges.emplace_back(uniform(random), uniform(random), uniform(random) - 0.5, 0.3 + 0.4 * uniform(random));
    }
    const auto value = [&](std::size_t pixel, std::uint32_t i) {
        const glm::dvec4& edge = edges[pixel];
        const double x = std::fmod(edge.x + i * 0.7548776662466927, 1.0),
                     y = std::fmod(edge.y + i * 0.5698402909980532, 1.0);
        return glm::dvec4(glm::dvec3(x < edge.w + edge.z * (y - 0.5) ? 1.0 : 0.0), 0.0);
    };
    const ErrorSums sums = sums_of(iterations, value);
    const ErrorEstimate estimate = estimate_error(sums);
    double truth = 0.0, spread = 0.0;
    const std::vector<float> error = error_channels(sums).at("StdErr");
    for (std::size_t pixel = 0; pixel < extent.pixels(); ++pixel) {
        double mean = 0.0;
        for (const auto& group : sums.of_group) mean += group[pixel].x / iterations;
        const double covered = edges[pixel].w;  // the edge leaves the pixel above and below alike
        truth += (mean - covered) * (mean - covered) / (covered * covered + 0.01) / double(extent.pixels());
        spread += double(error[pixel]) * error[pixel] / (mean * mean + 0.01) / double(extent.pixels());
    }
    EXPECT_GT(spread, 2.5 * truth);
    EXPECT_LT(estimate.relmse.error.value, 2.0 * truth);
    EXPECT_GT(estimate.relmse.error.value, 0.7 * truth);
}

// A pixel that rests on one find is measured by its neighbours as well, and its share of the light is told.
TEST(ErrorEstimate, OfOneFindIsRelativeToItselfAndItsNeighbours) {
    const std::size_t speck = 500;
    const ErrorSums sums = sums_of(32, [&](std::size_t pixel, std::uint32_t i) {
        return glm::dvec4(glm::dvec3(pixel == speck && i == 11 ? 3200.0 : 0.1), 0.0);
    });
    const ErrorEstimate estimate = estimate_error(sums);
    const double light = 0.1 * double(extent.pixels());
    EXPECT_NEAR(estimate.rare, 100.1 / (light + 100.0), 0.01);
    // One of 32 iterations, of which the variance of the mean is 100^2 (1 - 1 / 32), as groups of 4 see it.
    const double pi = 3.14159265358979, own = 1e4 + 0.01, neighbours = 0.1 * 0.1 + 0.01;
    const double expected = 0.5 * pi * 1e4 / std::sqrt(own * neighbours) / double(extent.pixels());
    EXPECT_NEAR(estimate.relmse.noise, expected, 0.1 * expected);
    EXPECT_NEAR(estimate.relmse_trimmed.error.value, 0.0, 1e-9);
}

TEST(ErrorEstimate, LooksAreAnEighthApart) {
    std::vector<std::uint32_t> looks;
    for (std::uint32_t i = 0; i < 100; ++i) {
        if (is_look(i)) looks.push_back(i);
    }
    EXPECT_EQ(looks, (std::vector<std::uint32_t>{32, 36, 40, 45, 50, 56, 63, 70, 78, 87, 97}));
}

TEST(ErrorChannels, BlocksKnowWhatPixelsShare) {
    // Half of the variance is shared by all pixels: the mean over all has at least that.
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0.0, 0.2);
    constexpr std::uint32_t iterations = 64;
    std::vector<double> shared(iterations);
    for (double& value : shared) value = noise(random);
    const ErrorSums sums = sums_of(iterations, [&](std::size_t, std::uint32_t i) {
        return glm::dvec4(glm::dvec3(0.5 + noise(random) + shared[i]), 0.01);
    });
    const auto channels = error_channels(sums);
    const auto root_mean_square = [&](const std::vector<float>& values) {
        double squares = 0.0;
        for (const float value : values) squares += double(value) * value / double(values.size());
        return std::sqrt(squares);
    };
    const double of_pixel = 0.2 * std::sqrt(2.0 / iterations), of_all = 0.2 * std::sqrt(1.0 / iterations);
    EXPECT_NEAR(root_mean_square(channels.at("StdErr")), of_pixel, 0.25 * of_pixel);
    // One spread of 8 groups: 27 % of itself.
    EXPECT_NEAR(root_mean_square(channels.at("StdErr.64")), of_all, 0.7 * of_all);
    EXPECT_EQ(channels.count("StdErr.8"), 1u);
    EXPECT_NEAR(channels.at("Bias")[0], 0.01, 1e-6);
    for (std::size_t i = 0; i < extent.pixels(); ++i) {
        EXPECT_NEAR(channels.at("Bound")[i], 1.894579 * channels.at("StdErr")[i] + channels.at("Bias")[i], 1e-5);
    }
}

}  // namespace
}  // namespace vkcppm::test
