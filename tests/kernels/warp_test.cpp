// Maps of the unit square against the densities they are to have.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "support/device/gpu.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

constexpr std::uint32_t warp_words[] = {
#include "warp.spv.inc"
};

constexpr std::size_t samples = 200000;

/// Pairs of cosines of the inner and the outer cone: glTF's defaults, wide, narrow, equal, nearly equal, beyond 90 deg.
const std::vector<std::pair<float, float>> cones = {{1.0f, float(std::cos(pi / 4.0))},
                                                    {0.9f, 0.2f},
                                                    {float(std::cos(0.02)), float(std::cos(0.03))},
                                                    {0.7f, 0.7f},
                                                    {0.8f, 0.7999f},
                                                    {0.5f, -0.5f}};
const double level = sidak(1e-4, 4 + 6);

class Warp : public GpuTest {
protected:
    std::vector<gpu::WarpOutput> map(const std::vector<gpu::WarpInput>& inputs) {
        probe_.input(PROBE_INPUT, inputs);
        probe_.output<gpu::WarpOutput>(PROBE_OUTPUT, inputs.size());
        probe_.run(inputs.size(),
                   {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(inputs.size())});
        return probe_.result<gpu::WarpOutput>(PROBE_OUTPUT, inputs.size());
    }

    /// Multiples of 2^-24 in [0, 1), as random4 gives.
    static std::vector<gpu::WarpInput> random_inputs(std::uint32_t seed, float inner, float outer) {
        std::mt19937 random(seed);
        const auto next = [&] { return float(random() >> 8) / 16777216.0f; };
        std::vector<gpu::WarpInput> inputs(samples);
        for (auto& input : inputs) input = {{next(), next()}, inner, outer};
        return inputs;
    }

    Probe probe_{"warp", warp_words};
};

/// Bin of the azimuth of (x, y), of 16.
std::size_t azimuth_bin(float x, float y) {
    const double turn = std::atan2(double(y), double(x)) / (2.0 * pi);
    return std::min<std::size_t>(15, std::size_t(16.0 * (turn < 0.0 ? turn + 1.0 : turn)));
}

TEST_F(Warp, DirectionsDiscsAndTrianglesFollowTheirDensities) {
    const auto outputs = map(random_inputs(4, 0.9f, 0.5f));
    constexpr std::size_t rows = 12;
    // Rows of equal polar angle: P = sin^2(b) - sin^2(a) for cos / pi, (cos(a) - cos(b)) / 2 on the sphere.
    std::vector<double> cosine_density, sphere_density, disc_density;
    for (std::size_t row = 0; row < rows; ++row) {
        const double a = 0.5 * pi * double(row) / rows, b = 0.5 * pi * double(row + 1) / rows;
        const double r0 = double(row) / rows, r1 = double(row + 1) / rows;
        cosine_density.insert(cosine_density.end(), 16, (std::pow(std::sin(b), 2) - std::pow(std::sin(a), 2)) / 16.0);
        sphere_density.insert(sphere_density.end(), 16, (std::cos(2.0 * a) - std::cos(2.0 * b)) / 2.0 / 16.0);
        disc_density.insert(disc_density.end(), 16, (r1 * r1 - r0 * r0) / 16.0);
    }
    std::vector<std::uint64_t> cosine(rows * 16), sphere(rows * 16), disc(rows * 16), triangle(64);
    for (const auto& out : outputs) {
        ASSERT_NEAR(glm::length(glm::dvec3(out.cosine)), 1.0, 1e-6);
        ASSERT_GE(out.cosine.z, 0.0f);
        ASSERT_NEAR(glm::length(glm::dvec3(out.sphere)), 1.0, 1e-6);
        ASSERT_LE(glm::length(glm::dvec2(out.disc)), 1.0 + 1e-6);
        ASSERT_TRUE(out.triangle.x >= 0.0f && out.triangle.y >= 0.0f && out.triangle.x + out.triangle.y <= 1.0f + 1e-6f)
            << out.triangle.x << " " << out.triangle.y;
        const auto polar_row = [&](double angle, double range) {
            return std::min(rows - 1, std::size_t(double(rows) * angle / range));
        };
        const double theta = std::atan2(double(glm::length(glm::vec2(out.cosine))), double(out.cosine.z));
        ++cosine[polar_row(theta, 0.5 * pi) * 16 + azimuth_bin(out.cosine.x, out.cosine.y)];
        const double polar = std::atan2(double(glm::length(glm::vec2(out.sphere))), double(out.sphere.z));
        ++sphere[polar_row(polar, pi) * 16 + azimuth_bin(out.sphere.x, out.sphere.y)];
        ++disc[polar_row(glm::length(glm::dvec2(out.disc)), 1.0) * 16 + azimuth_bin(out.disc.x, out.disc.y)];
        // Eight strips a side cut the triangle into 64 equal triangles: squares (i, j), upper halves in between.
        const double x = 8.0 * double(out.triangle.x), y = 8.0 * double(out.triangle.y);
        const auto i = std::min<std::size_t>(7, std::size_t(x)), j = std::min<std::size_t>(7 - i, std::size_t(y));
        const bool upper = i + j < 7 && (x - double(i)) + (y - double(j)) > 1.0;
        // Strip i has 8 - i lower and 7 - i upper triangles.
        ++triangle[i * (16 - i) + (upper ? 8 - i + j : j)];
    }
    expect_density("sample_cosine", chi_squared(cosine, cosine_density), level);
    expect_density("sample_azimuth on the sphere", chi_squared(sphere, sphere_density), level);
    expect_density("sample_disc", chi_squared(disc, disc_density), level);
    expect_density("sample_triangle", chi_squared_uniform(triangle), level);
}

TEST_F(Warp, SpotCosinesFollowTheFalloffOfKhrLightsPunctual) {
    std::uint32_t seed = 5;
    for (const auto& [inner, outer] : cones) {
        const auto outputs = map(random_inputs(seed++, inner, outer));
        const double low = outer, edge = inner, width = edge - low;
        const auto density = [&](double c) {
            return width > 0.0 ? std::pow(std::clamp((c - low) / width, 0.0, 1.0), 2) : 1.0;
        };
        const auto integral = [&](double a, double b) {
            return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(density, a, b, 10, 1e-10);
        };
        // 20 bins in the falloff, 20 inside the inner cone; either may be empty.
        std::vector<double> edges;
        for (int i = 0; i <= 20; ++i) edges.push_back(low + width * i / 20.0);
        for (int i = 1; i <= 20; ++i) edges.push_back(edge + (1.0 - edge) * i / 20.0);
        std::vector<double> probabilities;
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            probabilities.push_back(edges[i + 1] > edges[i] ? integral(edges[i], edges[i + 1]) : 0.0);
        }
        const double total = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
        for (double& p : probabilities) p /= total;
        std::vector<std::uint64_t> counts(probabilities.size());
        for (const auto& out : outputs) {
            ASSERT_TRUE(out.spot >= low - 1e-6 && out.spot <= 1.0 + 1e-6)
                << out.spot << " for cones " << inner << " " << outer;
            const auto above = std::upper_bound(edges.begin(), edges.end(), double(out.spot)) - edges.begin();
            ++counts[std::clamp<std::ptrdiff_t>(above - 1, 0, std::ptrdiff_t(counts.size()) - 1)];
        }
        expect_density(fmt::format("sample_spot_versine between {} and {}", inner, outer),
                       chi_squared(counts, probabilities), level);
    }
}

TEST_F(Warp, CornersOfTheSquareStayInRange) {
    const float last = 1.0f - 1.0f / 16777216.0f;
    std::vector<gpu::WarpInput> inputs;
    for (const float u : {0.0f, last}) {
        for (const float v : {0.0f, last}) {
            for (const auto& [inner, outer] : cones) inputs.push_back({{u, v}, inner, outer});
        }
    }
    for (const auto& out : map(inputs)) {
        EXPECT_NEAR(glm::length(glm::dvec3(out.cosine)), 1.0, 1e-6);
        EXPECT_GE(out.cosine.z, 0.0f);
        EXPECT_NEAR(glm::length(glm::dvec3(out.sphere)), 1.0, 1e-6);
        EXPECT_LE(out.triangle.x + out.triangle.y, 1.0f + 1e-6f);
        EXPECT_LE(std::abs(out.spot), 1.0f + 1e-6f);
    }
}

}  // namespace
}  // namespace vkcppm::test
