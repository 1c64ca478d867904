// Direct light of many lamps, which are asked for by what they bring to the place: closed forms, and the same picture
// as by photons and by path tracing.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/metrics.h"
#include "render/settings.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/lamps.h"
#include "support/scenes/shapes.h"
#include "support/statistics/blocks.h"

namespace vkcppm::test {
namespace {

constexpr double floor_side = 4.0;  // m, of the floor and of what the camera sees
constexpr std::uint32_t floor_pixels = 16;

struct Bulb {
    glm::dvec3 place;
    double intensity;  // W/sr
};

/// A grey floor seen straight from above by an orthographic camera, below bulbs.
Scene floor_below(const std::vector<Bulb>& bulbs) {
    Scene scene;
    add_quad(scene, {-0.5 * floor_side, 0, -0.5 * floor_side}, {0, 0, floor_side}, {floor_side, 0, 0},
             add_material(scene, lambert(glm::vec3(0.5f))));
    Camera camera;
    camera.to_world = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 3, 0, 1}};
    camera.ymag = 0.5 * floor_side;
    scene.cameras = {camera};
    for (const Bulb& bulb : bulbs) add_point_light(scene, bulb.place, glm::vec3(float(bulb.intensity)));
    return scene;
}

/// Mean radiance of each pixel, rho / pi I cos / d^2, over a grid of points.
Image expected(const std::vector<Bulb>& bulbs) {
    constexpr int points = 16;
    Image image;
    image.extent = {floor_pixels, floor_pixels};
    for (std::uint32_t i = 0; i < floor_pixels * floor_pixels; ++i) {
        double sum = 0.0;
        for (int k = 0; k < points * points; ++k) {
            const double x = floor_side * ((i % floor_pixels + (k % points + 0.5) / points) / floor_pixels - 0.5);
            const double z = floor_side * ((i / floor_pixels + (k / points + 0.5) / points) / floor_pixels - 0.5);
            for (const Bulb& bulb : bulbs) {
                const double distance = glm::length(bulb.place - glm::dvec3(x, 0.0, z));
                sum += bulb.intensity * bulb.place.y / std::pow(distance, 3);
            }
        }
        image.rgb.emplace_back(float(0.5 / std::numbers::pi * sum / (points * points)));
    }
    return image;
}

/// Nine bulbs, the strongest eight times as bright as the weakest.
std::vector<Bulb> nine_bulbs() {
    std::vector<Bulb> bulbs;
    for (int i = 0; i < 9; ++i) {
        bulbs.push_back({{1.3 * (i % 3 - 1) + 0.1, 0.5 + 0.1 * i, 1.3 * (i / 3 - 1) - 0.1}, std::pow(8.0, i / 8.0)});
    }
    return bulbs;
}

// What is left of noise is that of the place in the pixel and of the choice of bulbs.
TEST_F(GpuTest, ManyLampsAskedForAreRightInEveryPixel) {
    Settings settings;
    settings.size = Extent{floor_pixels, floor_pixels};
    settings.photons = 256;
    const Image want = expected(nine_bulbs()), got = valid_picture(floor_below(nine_bulbs()), settings, 512);
    EXPECT_LT(compare(got, want).relmse.all, 1e-4);
    if (HasFailure()) leave_pictures(got, want);
}

// A disc of ten photons in each of 16 iterations has a relative variance of 1/160.
TEST_F(GpuTest, ManyLampsGatheredAreRightAsAWhole) {
    Settings settings;
    settings.size = Extent{floor_pixels, floor_pixels};
    settings.photons = 1u << 18;
    settings.direct = direct_gathered;
    const Image want = expected(nine_bulbs()), got = valid_picture(floor_below(nine_bulbs()), settings, 16);
    double sum_of_want = 0.0, sum_of_got = 0.0;
    for (std::size_t i = 0; i < want.rgb.size(); ++i) {
        sum_of_want += want.rgb[i].g;
        sum_of_got += got.rgb[i].g;
    }
    EXPECT_NEAR(sum_of_got, sum_of_want, 0.01 * sum_of_want);
    EXPECT_LT(compare(got, want).relmse.all, 0.0125);
    if (HasFailure()) leave_pictures(got, want);
}

// A bulb on a table beside one that stands for the sun, of a million times its power a kilometre away: they light the
// floor alike, and by power nobody would ask for the first.
TEST_F(GpuTest, ALampBesideAFarOneOfAMillionTimesItsPowerIsSeen) {
    const std::vector<Bulb> bulbs = {{{0.0, 1.0, 0.0}, 1.0}, {{300.0, 1000.0, 0.0}, 1e6}};
    Settings settings;
    settings.size = Extent{floor_pixels, floor_pixels};
    settings.photons = 256;
    const Image want = expected(bulbs), got = valid_picture(floor_below(bulbs), settings, 512);
    EXPECT_LT(compare(got, want).relmse.all, 1e-4);
    if (HasFailure()) leave_pictures(got, want);
}

// Powers from 1e-30 to 1e30 W, and ten thousand lamps in one place, which are one of ten thousand times the power.
TEST_F(GpuTest, LampsOfAnyPowerAndInOnePlaceGiveNumbers) {
    Settings settings;
    settings.size = Extent{floor_pixels, floor_pixels};
    settings.photons = 1024;
    Scene scene = floor_below({});
    const Scene lamps = lamps_of_every_kind(50, 30.0, 2);
    scene.lights = lamps.lights;
    for (const Triangle& triangle : lamps.triangles) {
        const auto at = [&](int c) { return lamps.positions[triangle.vertex[c]] + glm::dvec3(0, 1.1, 0); };
        add_triangle(scene, at(0), at(1), at(2), add_material(scene, lamps.materials[triangle.material]));
    }
    valid_picture(scene, settings, 16);

    const std::vector<Bulb> bulbs(10000, Bulb{{0.2, 1.0, 0.1}, 1e-4});
    const Image want = expected({{{0.2, 1.0, 0.1}, 1.0}}), got = valid_picture(floor_below(bulbs), settings, 512);
    EXPECT_LT(compare(got, want).relmse.all, 1e-4);
}

// Asked for or met after a rough lobe, the weights of the two sum to 1.
TEST_F(GpuTest, LampsThatMetalShowsAreWeighedOnce) {
    for (const float roughness : {0.3f, 0.6f}) {
        SCOPED_TRACE(roughness);
        Settings settings;
        settings.size = Extent{32, 32};
        settings.iterations = 192;
        settings.photons = 1024;
        expect_blocks_agree(render_two_ways(lamps_over_metal(roughness), settings, 12, 1024),
                            {.side = 8, .bias = 0.003});
    }
}

// Lamps of very unequal power in a room: each way brings each light once.
class ManyLampRoom : public testing::TestWithParam<const char*> {};

TEST_P(ManyLampRoom, AgreesWithPathTracing) {
    Settings settings;
    settings.size = Extent{32, 32};
    settings.iterations = 48;
    settings.photons = 32768;
    settings.direct = GetParam();
    expect_blocks_agree(render_two_ways(many_lamp_room(40), settings, 12, 512), {.side = 8, .bias = 0.012});
}

INSTANTIATE_TEST_SUITE_P(, ManyLampRoom, testing::Values(direct_sampled, direct_gathered),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vkcppm::test
