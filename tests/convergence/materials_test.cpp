// One room a feature, by photon mapping and by the oracle's path tracer, in double precision, without photons and
// written from the specification alone: block means agree by Welch's test. Lamps are large, so that paths find them;
// but for the rooms whose lights are small, in which no pixel may stand out either.

#include <string>

#include <gtest/gtest.h>

#include "core/metrics.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/rooms.h"
#include "support/statistics/blocks.h"

namespace vkcppm::test {
namespace {

class Materials : public testing::TestWithParam<Case> {};

// Blocks show differences of 7 % of their radiance at best, half of them of 12 %. Discs at edges and corners take 2 %.
TEST_P(Materials, AgreeWithPathTracing) {
    Scene scene = make_room();
    Settings settings;
    settings.size = Extent{32, 32};
    settings.iterations = 12;
    settings.photons = 32768;
    GetParam().change(scene, settings);
    TwoWays pictures = render_two_ways(scene, settings, 12, 64);
    expect_blocks_agree(pictures, {.side = 8, .bias = 0.012});
    settings.direct = direct_gathered;
    SCOPED_TRACE(settings.direct);
    pictures.photons = render_photons(scene, settings, 12);
    expect_blocks_agree(pictures, {.side = 8, .bias = 0.012});
}

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Features, Materials, testing::ValuesIn(material_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(SmallLights, Materials, testing::ValuesIn(small_light_cases()), name_of);

class SmallLights : public testing::TestWithParam<Case> {};

TEST_P(SmallLights, LeaveNoFireflies) {
    Scene scene = make_room();
    Settings settings;
    settings.iterations = 32;
    settings.photons = 8192;
    GetParam().change(scene, settings);
    settings.size = Extent{96, 96};
    const Image one = valid_picture(scene, settings, settings.iterations);
    settings.seed = 2;
    const Image other = valid_picture(scene, settings, settings.iterations);
    const Measure relmse = compare(one, other).relmse;
    EXPECT_LT(relmse.all, 1.1 * relmse.trimmed) << "between two seeds, and without the worst 9 pixels";
    if (HasFailure()) leave_pictures(one, other, "two seeds");
}

INSTANTIATE_TEST_SUITE_P(Rooms, SmallLights, testing::ValuesIn(small_light_cases()), name_of);

}  // namespace
}  // namespace vkcppm::test
