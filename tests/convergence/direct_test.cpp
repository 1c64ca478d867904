// Direct light that eye paths ask for: right to their noise where nothing else lights a plane, and the same picture as
// where photons bring it.

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/metrics.h"
#include "render/settings.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/expectation.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

/// A plane that one light shines on, with a closed form.
class LitPlane : public testing::TestWithParam<std::string> {};

// Two seeds differ by sqrt(2) of the noise of one: a relMSE of 1e-4 is an error of 1 % a pixel, where photons leave
// two to three.
TEST_P(LitPlane, IsRightToTheNoiseOfItsSamples) {
    const Scene scene = project_scene(GetParam());
    const nlohmann::json expected = expectation_of(GetParam());
    Settings settings;
    settings.size = Extent{64, 64};
    settings.iterations = 128;
    settings.photons = 16384;
    const Image one = valid_picture(scene, settings, settings.iterations);
    settings.seed = 2;
    const Image other = valid_picture(scene, settings, settings.iterations);
    EXPECT_LT(compare(one, other).relmse.all, 1e-4);
    for (const auto& region : expected["regions"]) {
        glm::dvec3 sum(0.0);
        std::size_t count = 0;
        for_each_pixel(region, [&](std::uint32_t x, std::uint32_t y) {
            sum += glm::dvec3(one.at(x, y));
            ++count;
        });
        for (int channel = 0; channel < 3; ++channel) {
            const double want = region["rgb"][channel];
            EXPECT_NEAR(sum[channel] / double(count), want, 1e-3 * want) << region["name"] << ", channel " << channel;
        }
    }
    if (HasFailure()) leave_pictures(one, other, "two seeds");
}

INSTANTIATE_TEST_SUITE_P(Scenes, LitPlane,
                         testing::Values("point_plane", "spot_plane", "directional_plane", "square_light"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace vkcppm::test
