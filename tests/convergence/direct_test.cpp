// Direct light that eye paths ask for: right to their noise where nothing else lights a plane, and the same picture as
// where photons bring it.

#include <numbers>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/metrics.h"
#include "render/settings.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/expectation.h"
#include "support/scenes/materials.h"
#include "support/scenes/scenes.h"
#include "support/scenes/shapes.h"

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

// A sun straight down through a pane of index 1.5 onto a plane: rho / pi E tint (1 - F), F = 0.04, at every pixel, and
// it is in the direct layer whoever brings it. By photons to their noise.
TEST(Panes, LetDirectLightPass) {
    const glm::vec3 rho(0.5f, 0.4f, 0.3f), tint(0.9f, 0.8f, 0.7f), irradiance(2.0f, 3.0f, 4.0f);
    Scene scene;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambert(rho)));
    Material pane = glass(1.5f);
    pane.thickness = 0.0f;
    pane.base_color = tint;
    add_quad(scene, {-2, 1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, pane));
    add_directional_light(scene, {0, -1, 0}, irradiance);
    add_camera(scene, {0, 0.9, 0.3}, {0, 0, 0}, 0.6);
    for (const char* direct : {direct_sampled, direct_gathered}) {
        Settings settings;
        settings.size = Extent{16, 16};
        settings.photons = 65536;
        settings.direct = direct;
        settings.aovs = true;
        Rig rig(scene, settings, plain_device());
        rig.integrator.run(16);
        const auto channels = rig.integrator.aovs();
        const bool sampled = std::string(direct) == direct_sampled;
        for (int c = 0; c < 3; ++c) {
            const double want = rho[c] / std::numbers::pi * irradiance[c] * tint[c] * 0.96;
            double sum = 0.0;
            for (const float value : channels.at(std::string("direct.") + "RGB"[c])) {
                if (sampled) {
                    EXPECT_NEAR(value, want, 1e-5 * want) << direct << ", channel " << c;
                }
                sum += value;
            }
            EXPECT_NEAR(sum / double(rig.pixels()), want, 0.01 * want) << direct << ", channel " << c;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, LitPlane,
                         testing::Values("point_plane", "spot_plane", "directional_plane", "square_light"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace vkcppm::test
