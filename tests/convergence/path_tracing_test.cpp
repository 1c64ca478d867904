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
    expect_blocks_agree(render_two_ways(project_scene(GetParam()), settings, 16, 128), {.side = 16, .bias = 0.004});
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathTracing, testing::Values("square_light", "mirror", "spot_plane"),
                         [](const auto& info) { return std::string(info.param); });

class PaperScenes : public testing::TestWithParam<const char*> {};

// A block shows differences of 12 % to 40 % of its radiance, but for the box's: it has to be wrong by half and more.
TEST_P(PaperScenes, AgreeWherePathTracingConverges) {
    const std::string name = GetParam();
    Settings settings;
    settings.size = Extent{48, 36};
    settings.iterations = 12;
    // Light between arches and columns: larger discs reach behind them, which extrapolation does not mend.
    settings.photons = name == "sibenik" || name == "sponza" ? 65536 : 16384;
    Scene scene = project_scene(name);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    // No path tracer sees what a punctual light sends through glass: without it the rest must agree.
    const bool glass = std::ranges::any_of(scene.materials, is_glass);
    if (glass) scene.lights.clear();
    // The box's lamps are too small for paths to meet: there its blocks count with whatever noise they have.
    const bool small_lamps = name == "box";
    const TwoWays pictures = render_two_ways_extrapolated(scene, settings, 12, small_lamps ? 256 : 64);
    const BlockComparison blocks =
        expect_blocks_agree(pictures, {.side = 12, .bias = 0.04, .noise = small_lamps ? 1.0 : 0.05});
    EXPECT_GE(blocks.counted, 6u) << "path tracing has converged hardly anywhere:\n" << blocks.table;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PaperScenes,
                         testing::Values("box", "clocks", "conference", "cornell", "diamond", "dining", "glass",
                                         "sibenik", "sponza", "torus", "water"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vkcppm::test
