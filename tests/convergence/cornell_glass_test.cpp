// The Cornell box with a mirror and a glass sphere against its reference by bidirectional path tracing.

#include "core/metrics.h"
#include "io/exr.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

struct Case {
    const char* estimator;
    double limit;  // of relMSE without the worst 0.1 % of pixels
};

class CornellGlass : public GpuTest, public testing::WithParamInterface<Case> {};

TEST_P(CornellGlass, SixtyFourIterations) {
    const auto scene = shared_file("cornell_glass.glb");
    const auto reference = shared_file("cornell_glass_ref.exr");
    if (!scene || !reference) GTEST_SKIP() << no_collections;
    Settings settings;
    settings.estimator = GetParam().estimator;
    settings.size = Extent{256, 256};
    Rig run(load_gltf(*scene), settings);
    run.integrator.run(64);
    const Image got = run.integrator.resolve(), wanted = read_exr(*reference);
    const Comparison found = compare(got, wanted);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.mean_ratio[c], 1.0, 0.007) << "channel " << c;
    EXPECT_LE(found.relmse.trimmed, GetParam().limit);
    if (HasFailure()) leave_pictures(got, wanted);
    RecordProperty("relmse_trim", std::to_string(found.relmse.trimmed));
}

INSTANTIATE_TEST_SUITE_P(Peers, CornellGlass, testing::Values(Case{"cppm", 0.0035}, Case{"sppm", 0.0072}),
                         [](const auto& info) { return std::string(info.param.estimator); });

}  // namespace
}  // namespace vkcppm::test
