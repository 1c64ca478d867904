// The same scene by photon mapping and by the reference path tracer, in double precision and without photons: block
// means agree by Welch's test. Blocks are large against the radii, so that the bias of the kernel averages out but at
// edges, which the tolerance of the mean allows for.

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

#include "reference/path_tracer.h"
#include "support/rig.h"
#include "support/scenes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t side = 64, block = 16, seeds = 6;
constexpr double level = 0.001;          // of the whole picture, Sidak-corrected over blocks and channels
constexpr double kernel_bias = 0.004;    // relative, of a block: boundary bias of the photon estimate

class PathTracing : public GpuTest, public testing::WithParamInterface<const char*> {};

glm::dvec3 block_mean(const Image& image, std::uint32_t bx, std::uint32_t by) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t y = by * block; y < (by + 1) * block; ++y) {
        for (std::uint32_t x = bx * block; x < (bx + 1) * block; ++x) sum += glm::dvec3(image.at(x, y));
    }
    return sum / double(block * block);
}

TEST_P(PathTracing, BlocksAgree) {
    const Scene scene = project_scene(GetParam());
    std::vector<Image> photons, paths;
    for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
        Settings settings;
        settings.size = Extent{side, side};
        settings.iterations = 48;
        settings.photons = 16384;
        settings.seed = seed;
        Rig run(scene, settings);
        run.integrator.run(settings.iterations);
        photons.push_back(run.integrator.resolve());
        reference::PathTracerSettings reference;
        reference.size = Extent{side, side};
        reference.samples = 64;
        reference.seed = seed;
        paths.push_back(reference::path_trace(scene, reference).mean);
    }
    const double tests = 3.0 * (side / block) * (side / block);
    const double sidak = 1.0 - std::pow(1.0 - level, 1.0 / tests);
    for (std::uint32_t by = 0; by < side / block; ++by) {
        for (std::uint32_t bx = 0; bx < side / block; ++bx) {
            for (int c = 0; c < 3; ++c) {
                const auto moments = [&](const std::vector<Image>& images) {
                    double mean = 0.0, square = 0.0;
                    for (const Image& image : images) mean += block_mean(image, bx, by)[c] / seeds;
                    for (const Image& image : images) square += std::pow(block_mean(image, bx, by)[c] - mean, 2);
                    return std::pair(mean, square / (seeds - 1) / seeds);  // mean, its variance
                };
                const auto [m1, v1] = moments(photons);
                const auto [m2, v2] = moments(paths);
                const double difference = std::max(0.0, std::abs(m1 - m2) - kernel_bias * m2);
                if (difference == 0.0) continue;
                const double freedom = (v1 + v2) * (v1 + v2) / ((v1 * v1 + v2 * v2) / (seeds - 1));
                const boost::math::students_t distribution(freedom);
                const double p = 2.0 * cdf(complement(distribution, difference / std::sqrt(v1 + v2)));
                EXPECT_GT(p, sidak) << "block (" << bx << ", " << by << ") channel " << c << ": photons " << m1
                                    << " +- " << std::sqrt(v1) << ", paths " << m2 << " +- " << std::sqrt(v2);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathTracing, testing::Values("square_light", "mirror", "spot_plane"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vkcppm::test
