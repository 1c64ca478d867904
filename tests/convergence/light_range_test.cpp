// Lights that end at a range, and cameras whose rays are parallel: closed forms, whoever brings the light.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "render/settings.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr double side = 4.0;  // m, of the floor and of what the camera sees
constexpr std::uint32_t pixels = 16;

/// A white floor of 4 m seen straight from above by an orthographic camera, a pixel a quarter of a metre.
Scene floor_from_above(double camera_height) {
    Scene scene;
    add_quad(scene, {-0.5 * side, 0, -0.5 * side}, {0, 0, side}, {side, 0, 0},
             add_material(scene, lambert(glm::vec3(0.5f))));
    Camera camera;
    camera.to_world = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, camera_height, 0, 1}};
    camera.ymag = 0.5 * side;
    scene.cameras = {camera};
    return scene;
}

/// Mean radiance of the floor in a square of a quarter of a metre about (x, z): rho / pi I cos / d^2, windowed by
/// KHR_lights_punctual; over a grid of points.
double expected(double x, double z, double height, double range) {
    constexpr int points = 16;
    double sum = 0.0;
    for (int i = 0; i < points * points; ++i) {
        const double px = x + side / pixels * ((i % points + 0.5) / points - 0.5);
        const double pz = z + side / pixels * ((i / points + 0.5) / points - 0.5);
        const double d2 = px * px + pz * pz + height * height;
        const double window = range > 0.0 ? std::max(0.0, 1.0 - d2 * d2 / std::pow(range, 4)) : 1.0;
        sum += 0.5 / std::numbers::pi * height / std::sqrt(d2) / d2 * window;
    }
    return sum / (points * points);
}

class LightRange : public GpuTest, public testing::WithParamInterface<const char*> {};

// A point light 1 m above the floor ends at 1.6 m, 1.25 m from its foot: beyond is nothing at all. Asked for, every
// pixel is right to a per cent; by photons the sum of rings is, to their noise.
TEST_P(LightRange, WindowsTheLightAndEndsIt) {
    const bool sampled = std::string(GetParam()) == direct_sampled;
    Scene scene = floor_from_above(3.0);
    add_point_light(scene, {0, 1, 0}, glm::vec3(1.0f));
    scene.lights[0].range = 1.6;
    Settings settings;
    settings.size = Extent{pixels, pixels};
    settings.photons = sampled ? 256u : 1u << 18;
    settings.direct = GetParam();
    // Radiance differs by a quarter over a pixel: where its rays are placed is all the noise there is.
    const Image image = valid_picture(scene, settings, sampled ? 512 : 16);
    double got = 0.0, want = 0.0;
    for (std::uint32_t i = 0; i < pixels * pixels; ++i) {
        const double x = side * ((i % pixels + 0.5) / pixels - 0.5), z = side * ((i / pixels + 0.5) / pixels - 0.5);
        const double here = expected(x, z, 1.0, 1.6), value = image.rgb[i].g;
        if (sampled) {
            EXPECT_NEAR(value, here, 0.02 * here + 2e-4) << x << ", " << z;
        }
        // Photons end there; discs of pixels beyond reach back to the nearest of them, until tests make them smaller.
        if (std::hypot(x, z) > 1.6) {
            EXPECT_LE(value, sampled ? 0.0 : 1e-3) << x << ", " << z;
        }
        got += value;
        want += here;
    }
    EXPECT_NEAR(got, want, (sampled ? 0.005 : 0.02) * want);
}

INSTANTIATE_TEST_SUITE_P(, LightRange, testing::Values(direct_sampled, direct_gathered));

// A spot light straight down is a point light within its cone.
TEST_F(GpuTest, ARangeOfASpotLightIsThatOfAPointLight) {
    Scene scene = floor_from_above(3.0);
    add_spot_light(scene, {0, 1, 0}, {0, -1, 0}, 1.5, glm::vec3(1.0f));
    scene.lights[0].inner_cone = 1.49;
    scene.lights[0].range = 1.6;
    Settings settings;
    settings.size = Extent{pixels, pixels};
    settings.photons = 256;
    const Image image = valid_picture(scene, settings, 512);
    for (const std::uint32_t x : {8u, 10u, 12u}) {
        const double at = side * ((x + 0.5) / pixels - 0.5), here = expected(at, 0.125, 1.0, 1.6);
        EXPECT_NEAR(image.at(x, 8).g, here, 0.02 * here + 2e-4) << at;
    }
    EXPECT_EQ(image.at(15, 8).g, 0.0f);
}

// Parallel rays see the same whatever the distance, also from far outside of the scene, and the first radius of a pixel
// is that of its footprint there.
TEST_F(GpuTest, ParallelRaysSeeTheSameFromEveryDistance) {
    const auto half_lit = [](double height) {
        Scene scene = floor_from_above(height);
        Material lamp;
        lamp.emission = {1, 2, 3};
        lamp.base_color = glm::vec3(0.0f);
        // The right half of the picture, half a metre above the floor.
        add_quad(scene, {0, 0.5, -0.5 * side}, {0, 0, side}, {0.5 * side, 0, 0}, add_material(scene, lamp));
        return scene;
    };
    Settings settings;
    settings.size = Extent{pixels, pixels};
    settings.photons = 1024;
    settings.aovs = true;
    for (const double height : {1.0, 3.0, 1e5}) {
        Rig rig(half_lit(height), settings, plain_device());
        rig.integrator.run(1);
        const Image image = rig.integrator.resolve();
        const auto depth = rig.integrator.aovs().at("Z");
        for (std::uint32_t i = 0; i < pixels * pixels; ++i) {
            const bool right = i % pixels >= pixels / 2;
            EXPECT_EQ(image.rgb[i].b, right ? 3.0f : 0.0f) << height << ", pixel " << i;
            EXPECT_NEAR(depth[i], right ? height - 0.5 : height, 1e-4 * height) << height << ", pixel " << i;
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
