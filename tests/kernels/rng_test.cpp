// Random numbers: the same bits as the paper's definition, uniform, and unrelated between neighbours.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "oracle/rng.h"
#include "support/device/gpu.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t rng_words[] = {
#include "rng.spv.inc"
};

constexpr std::size_t samples = 1 << 17;
constexpr std::uint32_t stratified_dimensions = 8;  // of an eye path, documented in shaders/include/rng.glsl
constexpr double family = 1e-4;                     // chance of a false alarm, over all tests of one TEST

class Rng : public GpuTest {
protected:
    std::vector<gpu::RngSample> draw(const std::vector<gpu::RngKey>& keys) {
        probe_.input(PROBE_INPUT, keys);
        probe_.output<gpu::RngSample>(PROBE_OUTPUT, keys.size());
        probe_.run(keys.size(), {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(keys.size())});
        return probe_.result<gpu::RngSample>(PROBE_OUTPUT, keys.size());
    }

    /// Keys whose field `varied` counts from `first`; the others stay.
    static std::vector<gpu::RngKey> keys_along(std::uint32_t gpu::RngKey::*varied, gpu::RngKey key,
                                               std::uint32_t first) {
        std::vector<gpu::RngKey> keys(samples, key);
        for (std::size_t i = 0; i < samples; ++i) keys[i].*varied = first + std::uint32_t(i);
        return keys;
    }

    Probe probe_{"rng", rng_words};
};

/// Counts of pairs (a, b) in [0, 1)^2 over 16 x 16 bins.
template <typename Pair> std::vector<std::uint64_t> bins_of_pairs(std::size_t count, Pair pair) {
    std::vector<std::uint64_t> bins(256);
    for (std::size_t i = 0; i < count; ++i) {
        const auto [a, b] = pair(i);
        ++bins.at(std::size_t(a * 16.0) * 16 + std::size_t(b * 16.0));
    }
    return bins;
}

TEST_F(Rng, GivesTheBitsOfThePaper) {
    std::mt19937 engine(1);
    const auto random = [&] { return std::uint32_t(engine()); };
    std::vector<gpu::RngKey> keys(samples);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        // Full range for half of the keys, the small numbers of a real render for the others.
        const std::uint32_t shift = i % 2 == 0 ? 0 : 18;
        keys[i] = {random(), random() >> shift, random() >> shift, random() >> shift, random() >> shift};
    }
    const auto drawn = draw(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const auto& k = keys[i];
        const auto hash = oracle::pcg4d({k.seed, k.iteration, k.stream, k.path});
        const auto bits = oracle::pcg4d({k.path, k.dimension, k.iteration * 4 + k.stream, k.seed});
        for (int c = 0; c < 4; ++c) {
            ASSERT_EQ(drawn[i].hash[c], hash[c]) << "key " << i << " component " << c;
            ASSERT_EQ(drawn[i].random[c], float(bits[c] >> 8) / 16777216.0f) << "key " << i << " component " << c;
            ASSERT_LT(drawn[i].random[c], 1.0f);
        }
        ASSERT_TRUE(drawn[i].stratified >= 0.0f && drawn[i].stratified < 1.0f) << drawn[i].stratified;
    }
}

TEST_F(Rng, IsUniformAndUncorrelatedBetweenNeighbours) {
    struct Axis {
        const char* name;
        std::uint32_t gpu::RngKey::*field;
    };
    const Axis axes[] = {{"path", &gpu::RngKey::path},
                         {"iteration", &gpu::RngKey::iteration},
                         {"dimension", &gpu::RngKey::dimension},
                         {"seed", &gpu::RngKey::seed}};
    const double level = sidak(family, 4 * (4 + 4 + 3));
    for (const Axis& axis : axes) {
        const auto drawn = draw(keys_along(axis.field, {1, 3, 1, 5, 2}, 0));
        for (int c = 0; c < 4; ++c) {
            std::vector<std::uint64_t> bins(1024);
            for (const auto& sample : drawn) ++bins.at(std::size_t(sample.random[c] * 1024.0f));
            expect_density(fmt::format("component {} along {}", c, axis.name), chi_squared_uniform(bins), level);
            const auto pairs = bins_of_pairs(samples / 2, [&](std::size_t i) {
                return std::pair(drawn[2 * i].random[c], drawn[2 * i + 1].random[c]);
            });
            expect_density(fmt::format("component {} of neighbours along {}", c, axis.name), chi_squared_uniform(pairs),
                           level);
        }
        for (const auto& [a, b] : {std::pair(0, 1), std::pair(2, 3), std::pair(0, 2)}) {
            const auto pairs = bins_of_pairs(samples, [&, a = a, b = b](std::size_t i) {
                return std::pair(drawn[i].random[a], drawn[i].random[b]);
            });
            expect_density(fmt::format("components {} and {} along {}", a, b, axis.name), chi_squared_uniform(pairs),
                           level);
        }
    }
}

TEST_F(Rng, StreamsAreUnrelated) {
    const double level = sidak(family, 3);
    const auto eye = draw(keys_along(&gpu::RngKey::path, {1, 3, 0, 0, 2}, 0));
    for (const std::uint32_t stream : {1u, 2u, 3u}) {
        const auto other = draw(keys_along(&gpu::RngKey::path, {1, 3, stream, 0, 2}, 0));
        const auto pairs =
            bins_of_pairs(samples, [&](std::size_t i) { return std::pair(eye[i].random[0], other[i].random[0]); });
        expect_density(fmt::format("streams 0 and {}", stream), chi_squared_uniform(pairs), level);
    }
}

/// Largest difference between the share of `values` below x and x, over all x: the one-dimensional star discrepancy.
double star_discrepancy(std::vector<float> values) {
    std::sort(values.begin(), values.end());
    double worst = 0.0;
    const double n = double(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        worst = std::max(
            {worst, std::abs(double(values[i]) - double(i) / n), std::abs(double(i + 1) / n - double(values[i]))});
    }
    return worst;
}

TEST_F(Rng, StratifiedNumbersAreEquidistributedOverIterations) {
    // Of n random numbers n times the star discrepancy is about 0.87 sqrt(n) (Kolmogorov); of a good additive
    // recurrence it grows as log n. A tenth of random at n = 2^17 is 31; at n = 64, a short render, it is half.
    std::vector<std::vector<gpu::RngSample>> drawn;
    for (std::uint32_t dimension = 0; dimension < stratified_dimensions; ++dimension) {
        drawn.push_back(draw(keys_along(&gpu::RngKey::iteration, {1, 0, 0, 77, dimension}, 0)));
        for (const auto& [n, bound] :
             {std::pair<std::size_t, double>(64, 0.5), std::pair<std::size_t, double>(samples, 0.1)}) {
            std::vector<float> values(n);
            for (std::size_t i = 0; i < n; ++i) values[i] = drawn.back()[i].stratified;
            const double random = 0.87 * std::sqrt(double(n));
            EXPECT_LT(double(n) * star_discrepancy(values), bound * random)
                << "dimension " << dimension << ", " << n << " iterations; random numbers reach " << random;
        }
    }
    // Every pair of dimensions is more even than random numbers, whose statistic is about the degrees of
    // freedom, after few iterations and after many; and so do all dimensions together the orthants of the cube.
    for (std::size_t a = 0; a < drawn.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            for (const auto& [n, side] : {std::pair<std::size_t, std::size_t>(64, 4),
                                          {256, 8},
                                          {1024, 16},
                                          {4096, 16},
                                          {16384, 16},
                                          {samples, 16}}) {
                std::vector<std::uint64_t> bins(side * side);
                for (std::size_t i = 0; i < n; ++i) {
                    ++bins[std::size_t(drawn[a][i].stratified * float(side)) * side +
                           std::size_t(drawn[b][i].stratified * float(side))];
                }
                const ChiSquared test = chi_squared_uniform(bins);
                EXPECT_LT(test.statistic, test.freedom)
                    << "dimensions " << a << " and " << b << ", " << n << " iterations; " << test.worst;
            }
        }
    }
    std::vector<std::uint64_t> orthants(std::size_t(1) << stratified_dimensions);
    for (std::size_t i = 0; i < samples; ++i) {
        std::size_t index = 0;
        for (const auto& dimension : drawn) index = 2 * index + (dimension[i].stratified >= 0.5f ? 1 : 0);
        ++orthants[index];
    }
    EXPECT_LT(chi_squared_uniform(orthants).statistic, chi_squared_uniform(orthants).freedom)
        << chi_squared_uniform(orthants).worst;
}

TEST_F(Rng, StratifiedNumbersAreIndependentBetweenPixels) {
    // One iteration over many pixels: the shifts must be random, and so must pairs of dimensions and of neighbours,
    // beyond the stratified dimensions too.
    constexpr std::uint32_t dimensions = stratified_dimensions + 2;
    const double level = sidak(family, 2 * dimensions);
    std::vector<gpu::RngSample> before;
    for (std::uint32_t dimension = 0; dimension < dimensions; ++dimension) {
        const auto drawn = draw(keys_along(&gpu::RngKey::path, {1, 9, 0, 0, dimension}, 0));
        const auto neighbours = bins_of_pairs(samples / 2, [&](std::size_t i) {
            return std::pair(drawn[2 * i].stratified, drawn[2 * i + 1].stratified);
        });
        expect_density(fmt::format("neighbouring pixels in dimension {}", dimension), chi_squared_uniform(neighbours),
                       level);
        if (!before.empty()) {
            const auto pairs = bins_of_pairs(
                samples, [&](std::size_t i) { return std::pair(before[i].stratified, drawn[i].stratified); });
            expect_density(fmt::format("dimensions {} and {}", dimension - 1, dimension), chi_squared_uniform(pairs),
                           level);
        }
        before = drawn;
    }
}

}  // namespace
}  // namespace vkcppm::test
