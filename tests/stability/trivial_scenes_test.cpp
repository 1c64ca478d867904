// Scenes with hardly anything in them.

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

class TrivialScenes : public GpuTest {
protected:
    static Image picture(const Scene& scene, Extent size, std::uint32_t iterations = 16) {
        Settings settings;
        settings.size = size;
        settings.photons = 4096;
        return valid_picture(scene, settings, iterations);
    }

    /// Of magnitudes, over all channels.
    static double sum(const Image& image) {
        double total = 0.0;
        for (const glm::vec3& rgb : image.rgb) total += std::abs(rgb.x) + std::abs(rgb.y) + std::abs(rgb.z);
        return total;
    }
};

TEST_F(TrivialScenes, OnePixel) {
    Scene scene = room();
    scene.cameras.clear();
    add_camera(scene, {1.0, 1.0, 1.95}, {1.0, 0.8, 0.0}, 0.6);
    expect_error("a picture of one pixel, against the mean of 24 x 24",
                 mean_difference(scaled(picture(scene, {1, 1}, 64), 576.0), picture(scene, {24, 24}, 8)), 0.1);
}

TEST_F(TrivialScenes, OneTriangle) {
    Scene scene;
    add_triangle(scene, {-50, 0, 50}, {50, 0, 50}, {0, 0, -50}, add_material(scene, lambert(glm::vec3(0.5f))));
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::directional;
    sun.intensity = glm::vec3(2.0f);
    sun.direction = {0, -1, 0};
    scene.lights.push_back(sun);
    add_camera(scene, {0, 40, 0.01}, {0, 0, 0}, 0.3);
    const Image image = picture(scene, {8, 8}, 32);
    // E rho / pi.
    expect_error("one triangle under a sun, against E rho / pi",
                 std::abs(sum(image) / (3.0 * 64.0 * 2.0 * 0.5 / std::numbers::pi) - 1.0), 0.03);
}

TEST_F(TrivialScenes, NothingToSee) {
    Scene scene = room();
    scene.lights.clear();
    for (Material& material : scene.materials) material.emission = glm::vec3(0.0f);
    expect_error("a room without a light", sum(picture(scene, {16, 16})), 0.0);
    for (Material& material : scene.materials) {
        if (material.transmission == 0.0f) material = lambert(glm::vec3(0.0f));
    }
    PunctualLight point;
    point.position = {1.0, 1.5, 1.0};
    scene.lights.push_back(point);
    expect_error("a room that is black", sum(picture(scene, {16, 16})), 0.0);
}

// A convex body under a white sky reflects rho of it, everywhere.
TEST_F(TrivialScenes, OnlyAnEnvironment) {
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(glm::vec3(0.5f))), false);
    scene.environment = Environment{{4, 2}, std::vector<glm::vec3>(8, glm::vec3(1.0f))};
    add_camera(scene, {1, 1.5, 4}, {0, 0, 1}, 0.3);
    const Image image = picture(scene, {8, 8}, 32);
    expect_error("a box under a white sky, against rho", std::abs(sum(image) / (3.0 * 64.0 * 0.5) - 1.0), 0.03);
}

}  // namespace
}  // namespace vkcppm::test
