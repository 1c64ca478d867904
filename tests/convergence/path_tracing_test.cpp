// The scenes of the project by photon mapping and by the oracle's path tracer, in double precision and without
// photons. Of the paper's scenes only blocks count where path tracing has converged: it hardly finds their caustics.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "scene/diagnosis/glass.h"
#include "support/scenes/scenes.h"
#include "support/statistics/blocks.h"

namespace vkcppm::test {
namespace {

class PathTracing : public testing::TestWithParam<const char*> {};

TEST_P(PathTracing, BlocksAgree) {
    Settings settings;
    settings.size = Extent{64, 64};
    settings.iterations = 48;
    settings.photons = 16384;
    expect_blocks_agree(render_two_ways(project_scene(GetParam()), settings, 64, 6), {.side = 16, .bias = 0.004});
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathTracing, testing::Values("square_light", "mirror", "spot_plane"),
                         [](const auto& info) { return std::string(info.param); });

class PaperScenes : public testing::TestWithParam<const char*> {};

TEST_P(PaperScenes, AgreeWherePathTracingConverges) {
    Settings settings;
    settings.size = Extent{48, 36};
    settings.iterations = 24;
    settings.photons = 16384;
    Scene scene = project_scene(GetParam());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    // No path tracer sees what a punctual light sends through glass: without it the rest must agree.
    const bool glass = std::ranges::any_of(scene.materials, is_glass);
    if (glass) scene.lights.clear();
    // The box's lamps are too small for paths to meet: there its blocks count with whatever noise they have.
    const double noise = std::string(GetParam()) == "box" ? 1.0 : 0.03;
    const BlockComparison blocks = expect_blocks_agree(render_two_ways_extrapolated(scene, settings, 64, 4),
                                                       {.side = 12, .bias = 0.04, .noise = noise});
    EXPECT_GE(blocks.counted, 6u) << "path tracing has converged hardly anywhere:\n" << blocks.table;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PaperScenes,
                         testing::Values("box", "clocks", "conference", "cornell", "diamond", "dining", "glass",
                                         "sibenik", "sponza", "torus", "water"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vkcppm::test
