// The oracle's path tracer against a reference picture of another renderer, where that stands beside the project.

#include <algorithm>
#include <cmath>
#include <string>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "oracle/path_tracer.h"
#include "support/scenes/scenes.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t side = 64, block = 8;
constexpr double level = 0.001;    // of the whole picture, Sidak-corrected over blocks and channels
constexpr double noise = 0.02;     // largest standard error of a block against its mean or the picture's
constexpr double rounding = 1e-4;  // relative, of a block: the other renderer computes in floats

/// Mean of a block of `size` x `size` pixels and the variance of that mean.
struct Moments {
    double mean = 0.0, variance = 0.0;
};

Moments block_of(const Image& mean, const Image& standard_error, std::uint32_t bx, std::uint32_t by, std::uint32_t size,
                 int channel) {
    Moments sum;
    for (std::uint32_t y = by * size; y < (by + 1) * size; ++y) {
        for (std::uint32_t x = bx * size; x < (bx + 1) * size; ++x) {
            sum.mean += mean.at(x, y)[channel];
            sum.variance += std::pow(double(standard_error.at(x, y)[channel]), 2);
        }
    }
    const double pixels = double(size) * size;
    return {sum.mean / pixels, sum.variance / (pixels * pixels)};
}

TEST(OracleShared, CornellBoxOfRoughMetal) {
    const auto scene = shared_file("cornell-box.glb"), picture = shared_file("cornell-box_ref.exr"),
               error = shared_file("cornell-box_ref_stderr.exr");
    if (!scene || !picture || !error) GTEST_SKIP() << no_collections;
    const Image other = read_exr(*picture), other_error = read_exr(*error);
    const auto paths = oracle::path_trace(load_gltf(*scene), {.size = {side, side}, .samples = 512, .max_depth = 64});
    ASSERT_EQ(other.extent.width % side, 0u);
    ASSERT_EQ(other.extent.width, other.extent.height);
    const std::uint32_t scale = other.extent.width / side, blocks = side / block;
    const boost::math::normal normal;
    const double limit = quantile(complement(normal, sidak(level, 3 * blocks * blocks) / 2.0));
    glm::dvec3 picture_mean(0.0);
    for (const glm::vec3& pixel : other.rgb) picture_mean += glm::dvec3(pixel) / double(other.rgb.size());
    for (std::uint32_t by = 0; by < blocks; ++by) {
        for (std::uint32_t bx = 0; bx < blocks; ++bx) {
            for (int channel = 0; channel < 3; ++channel) {
                const Moments mine = block_of(paths.mean, paths.standard_error, bx, by, block, channel);
                const Moments theirs = block_of(other, other_error, bx, by, block * scale, channel);
                const double deviation = std::sqrt(mine.variance + theirs.variance);
                EXPECT_NEAR(mine.mean, theirs.mean, limit * deviation + rounding * theirs.mean)
                    << "block (" << bx << ", " << by << ") channel " << channel << ": standard errors "
                    << std::sqrt(mine.variance) << " and " << std::sqrt(theirs.variance);
                EXPECT_LE(deviation, noise * std::max(theirs.mean, picture_mean[channel]))
                    << "block (" << bx << ", " << by << ") channel " << channel << ": too noisy to say anything";
            }
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
