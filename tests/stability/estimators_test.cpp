// Every estimator on a small scene: the same bits for the same seed, however iterations are submitted; finite and
// monotone where its rule says so, for ten thousand iterations.

#include <cmath>

#include "render/estimators.h"
#include "support/device/rig.h"
#include "support/names.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

class Estimators : public GpuTest, public testing::WithParamInterface<EstimatorRow> {
protected:
    Settings settings(std::uint32_t side, std::uint32_t photons) const {
        Settings settings;
        settings.estimator = std::string(GetParam().name);
        settings.size = Extent{side, side};
        settings.photons = photons;
        return settings;
    }
};

std::vector<EstimatorRow> all() { return {estimators().begin(), estimators().end()}; }

std::string test_name(const testing::TestParamInfo<EstimatorRow>& info) { return identifier(info.param.name); }

TEST_P(Estimators, SameSeedSameBits) {
    const Scene scene = project_scene("caustic");
    const Settings wanted = settings(48, 4096);
    Rig one(scene, wanted), two(scene, wanted);
    one.integrator.run(12);
    for (int i = 0; i < 12; ++i) two.integrator.run(1);
    EXPECT_TRUE(one.integrator.resolve() == two.integrator.resolve()) << "one submission against twelve";

    Settings other = wanted;
    other.seed = 2;
    Rig three(scene, other);
    three.integrator.run(12);
    EXPECT_FALSE(one.integrator.resolve() == three.integrator.resolve()) << "another seed must give another picture";
}

// The rule of appm alone may let a radius grow: it follows an estimate of the curvature.
TEST_P(Estimators, TenThousandIterations) {
    const Scene scene = project_scene("caustic");
    Rig run(scene, settings(8, 64), plain_device());
    std::vector<gpu::PixelState> before;
    for (int step = 0; step < 100; ++step) {
        run.integrator.run(100);
        const auto pixels = run.all<gpu::PixelState>(Binding::pixels);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            ASSERT_TRUE(std::isfinite(pixels[i].radius2) && pixels[i].radius2 >= 0.0f && pixels[i].radius2 < 4.0f)
                << "radius^2 " << pixels[i].radius2 << " of pixel " << i << " after " << (step + 1) * 100
                << " iterations";
            ASSERT_TRUE(std::isfinite(pixels[i].batch) && std::isfinite(pixels[i].statistic)) << "pixel " << i;
            if (!before.empty() && before[i].radius2 > 0.0f && GetParam().statistic != Statistic::derivative) {
                ASSERT_LE(pixels[i].radius2, before[i].radius2) << "the radius of pixel " << i << " grew";
            }
        }
        before = pixels;
    }
    EXPECT_EQ(run.integrator.completed(), 10000u);
    EXPECT_EQ(run.integrator.invalid(), 0u);
    for (const glm::vec3& rgb : run.integrator.resolve().rgb) {
        ASSERT_TRUE(std::isfinite(rgb.x) && std::isfinite(rgb.y) && std::isfinite(rgb.z));
        ASSERT_TRUE(rgb.x >= 0.0f && rgb.y >= 0.0f && rgb.z >= 0.0f);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Estimators, testing::ValuesIn(all()), test_name);

}  // namespace
}  // namespace vkcppm::test
