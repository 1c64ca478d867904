// One room a feature, by photon mapping and by the reference path tracer, in double precision, without photons and
// written from the specification alone: block means agree by Welch's test. Lamps are large, so that paths find them.

#include <string>

#include <gtest/gtest.h>

#include "support/blocks.h"
#include "support/rooms.h"

namespace vkcppm::test {
namespace {

class Materials : public testing::TestWithParam<Case> {};

TEST_P(Materials, AgreeWithPathTracing) {
    Scene scene = make_room();
    Settings settings;
    GetParam().change(scene, settings);
    settings.size = Extent{32, 32};
    settings.iterations = 32;
    settings.photons = 8192;
    const BlockComparison blocks = compare_blocks(render_two_ways(scene, settings, 128, 4), {.side = 8, .bias = 0.012});
    EXPECT_EQ(blocks.differing, 0u) << "photons over paths, a block and channel:\n" << blocks.table;
}

INSTANTIATE_TEST_SUITE_P(Features, Materials, testing::ValuesIn(material_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vkcppm::test
