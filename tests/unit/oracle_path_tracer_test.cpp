// The path tracer in double precision against closed forms, on scenes built here.

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "oracle/fresnel.h"
#include "oracle/path_tracer.h"
#include "support/scenes/materials.h"
#include "support/statistics/picture_mean.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;
using test::expect_mean;
using test::glass;
using test::lambert;
using test::mirror;

constexpr double degree = pi / 180.0;

/// Parallelogram center +- u +- v that faces along u x v.
void add_quad(Scene& scene, const Material& material, glm::dvec3 center, glm::dvec3 u, glm::dvec3 v) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.positions.insert(scene.positions.end(), {center - u - v, center + u - v, center + u + v, center - u + v});
    scene.normals.insert(scene.normals.end(), 4, glm::vec3(glm::normalize(glm::cross(u, v))));
    scene.triangles.push_back({{first, first + 1, first + 2}, index});
    scene.triangles.push_back({{first, first + 2, first + 3}, index});
}

/// Closed box around `center`; side 1: fronts outward, -1: inward.
void add_box(Scene& scene, const Material& material, glm::dvec3 center, glm::dvec3 half, double side) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 u(0.0), v(0.0), n(0.0);
        u[(axis + 1) % 3] = half[(axis + 1) % 3];
        v[(axis + 2) % 3] = half[(axis + 2) % 3];
        n[axis] = half[axis];
        add_quad(scene, material, center + n, u, side * v);
        add_quad(scene, material, center - n, u, -side * v);
    }
}

void add_camera(Scene& scene, glm::dvec3 position, glm::dvec3 target, double yfov) {
    const glm::dvec3 back = glm::normalize(position - target);
    const glm::dvec3 other = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 right = glm::normalize(glm::cross(other, back));
    Camera camera;
    camera.to_world = {glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0), glm::dvec4(back, 0.0),
                       glm::dvec4(position, 1.0)};
    camera.yfov = yfov;
    scene.cameras.push_back(camera);
}

Scene furnace(const glm::vec3& rho, const glm::vec3& emission) {
    Scene scene;
    add_box(scene, lambert(rho, emission), glm::dvec3(0.0), glm::dvec3(1.0), -1.0);
    add_camera(scene, {0.3, -0.2, 0.5}, {-0.2, 0.1, -1.0}, 90.0 * degree);
    return scene;
}

TEST(OracleFresnel, Dielectric) {
    EXPECT_NEAR(fresnel_dielectric(1.0, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(fresnel_dielectric(std::cos(1e-5), 1.5), 0.04, 1e-10) << "continuous where the limit takes over";
    EXPECT_EQ(fresnel_dielectric(std::cos(42.0 * degree), 1.0 / 1.5), 1.0) << "total reflection";
    EXPECT_LT(fresnel_dielectric(std::cos(41.0 * degree), 1.0 / 1.5), 1.0);
    const double brewster = std::atan(1.5);  // only the perpendicular half is left: sin^2(i - t), i + t = 90 degrees
    EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.5), std::pow(std::sin(2.0 * brewster - pi / 2.0), 2) / 2.0,
                1e-14);
    const double inside = std::asin(std::sin(50.0 * degree) / 1.5);
    EXPECT_NEAR(fresnel_dielectric(std::cos(50.0 * degree), 1.5), fresnel_dielectric(std::cos(inside), 1.0 / 1.5),
                1e-14)
        << "the same from both sides";
}

TEST(OraclePathTracer, FurnaceHasTheSameRadianceEverywhere) {
    const Scene scene = furnace({0.3f, 0.5f, 0.7f}, {0.35f, 0.3f, 0.3f});
    expect_mean(path_trace(scene, {.size = {16, 16}, .samples = 400}), {0.5, 0.6, 1.0}, 0.002);
}

TEST(OraclePathTracer, GlassAndPerfectMirrorsVanishInAFurnace) {
    Scene scene = furnace({0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f});
    add_box(scene, glass(1.5f), {-0.2, -0.2, -0.3}, {0.3, 0.25, 0.2}, 1.0);
    add_box(scene, mirror(glm::vec3(1.0f)), {0.5, 0.4, -0.4}, {0.2, 0.2, 0.2}, 1.0);
    expect_mean(path_trace(scene, {.size = {16, 16}, .samples = 400}), glm::dvec3(1.0), 0.002);
}

TEST(OraclePathTracer, EmittersAreOneSidedUnlessTheySayOtherwise) {
    for (const bool double_sided : {false, true}) {
        Scene scene;
        Material light = lambert(glm::vec3(0.0f), glm::vec3(2.0f));
        light.double_sided = double_sided;
        add_quad(scene, light, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        add_camera(scene, {0, 0, 1}, {0, 0, 0}, degree);
        add_camera(scene, {0, 0, -1}, {0, 0, 0}, degree);
        EXPECT_EQ(path_trace(scene, {.size = {1, 1}, .samples = 2}).mean.at(0, 0), glm::vec3(2.0f));
        EXPECT_EQ(path_trace(scene, {.size = {1, 1}, .samples = 2, .camera = 1}).mean.at(0, 0),
                  glm::vec3(double_sided ? 2.0f : 0.0f));
    }
}

TEST(OraclePathTracer, TintedMirror) {
    const glm::dvec3 tint(0.9, 0.5, 0.2), emission(0.6, 0.8, 1.0);
    for (const double angle : {5.0, 45.0, 75.0, 85.0}) {
        Scene scene;
        add_box(scene, lambert(glm::vec3(0.0f), emission), glm::dvec3(0.0), glm::dvec3(10.0), -1.0);
        add_quad(scene, mirror(tint), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        add_camera(scene, {std::sin(angle * degree), 0.0, std::cos(angle * degree)}, {0, 0, 0}, 1e-5);
        const auto result = path_trace(scene, {.size = {1, 1}, .samples = 4}).mean.at(0, 0);
        const double grazing = std::pow(1.0 - std::cos(angle * degree), 5);
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(result[channel], (tint[channel] + (1.0 - tint[channel]) * grazing) * emission[channel], 1e-5)
                << angle << " degrees, channel " << channel;
        }
    }
}

TEST(OraclePathTracer, GlassSlabWithAllItsReflections) {
    const glm::dvec3 behind(1.0, 1.0, 0.4), front(0.2, 1.0, 1.6);
    for (const double angle : {0.0, 45.0, 70.0}) {
        Scene scene;
        add_box(scene, glass(1.5f), {0, 0, -0.01}, {2, 2, 0.01}, 1.0);
        add_quad(scene, lambert(glm::vec3(0.0f), behind), {0, 0, -1}, {20, 0, 0}, {0, 20, 0});
        add_quad(scene, lambert(glm::vec3(0.0f), front), {0, 0, 2}, {0, 20, 0}, {20, 0, 0});
        add_camera(scene, {std::sin(angle * degree), 0.0, std::cos(angle * degree)}, {0, 0, 0}, 1e-5);
        const double reflectance = fresnel_dielectric(std::cos(angle * degree), 1.5);
        const double transmitted = (1.0 - reflectance) / (1.0 + reflectance);
        SCOPED_TRACE(angle);
        expect_mean(path_trace(scene, {.size = {8, 8}, .samples = 2000}),
                    transmitted * behind + (1.0 - transmitted) * front, 0.003);
    }
}

TEST(OraclePathTracer, PunctualLightsOverAPlane) {
    const glm::vec3 rho(0.8f, 0.5f, 0.2f), intensity(3.0f, 4.0f, 5.0f);
    Scene scene;
    add_quad(scene, lambert(rho), {0, 0, 0}, {2, 0, 0}, {0, 2, 0});
    add_camera(scene, {0, 0.5, 1}, {0, 0, 0}, 1e-6);
    const auto expect = [&](const PunctualLight& light, double irradiance) {
        scene.lights = {light};
        const auto result = path_trace(scene, {.size = {1, 1}, .samples = 2}).mean.at(0, 0);
        for (int channel = 0; channel < 3; ++channel) {
            const double expected = rho[channel] / pi * intensity[channel] * irradiance;
            EXPECT_NEAR(result[channel], expected, 1e-5 * expected) << "channel " << channel;
        }
    };
    PunctualLight light;
    light.intensity = intensity;
    light.position = {1.2, 0.0, 1.6};
    expect(light, 0.8 / 4.0);
    // 30 degrees off the spot's axis, with cones of 20 and 40 degrees.
    light.kind = PunctualLight::Kind::spot;
    light.inner_cone = 20.0 * degree;
    light.outer_cone = 40.0 * degree;
    const double off_axis = std::atan2(0.6, 0.8) - 30.0 * degree;
    light.direction = {-std::sin(off_axis), 0.0, -std::cos(off_axis)};
    const double falloff =
        (std::cos(30.0 * degree) - std::cos(40.0 * degree)) / (std::cos(20.0 * degree) - std::cos(40.0 * degree));
    expect(light, falloff * falloff * 0.8 / 4.0);
    light.kind = PunctualLight::Kind::directional;
    light.direction = {0.6, 0.0, -0.8};
    expect(light, 0.8);
    light.direction = {0.6, 0.0, 0.8};
    expect(light, 0.0);
}

TEST(OraclePathTracer, SquareLightByItsFormFactor) {
    const double half = 0.5, height = 1.25;
    Scene scene;
    add_quad(scene, lambert(glm::vec3(0.5f)), {0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    add_quad(scene, lambert(glm::vec3(0.0f), glm::vec3(7.0f)), {0, 0, height}, {0, half, 0}, {half, 0, 0});
    add_camera(scene, {0.0, 2.0, 1.0}, {0, 0, 0}, 1e-5);
    const double x = half / height, root = std::sqrt(1.0 + x * x);
    const double form_factor = 4.0 / pi * x / root * std::atan(x / root);  // a point below the centre
    expect_mean(path_trace(scene, {.size = {8, 8}, .samples = 2000}), glm::dvec3(0.5 * 7.0 * form_factor), 0.001);
}

TEST(OraclePathTracer, SeesItsLightThroughGlassAfterADiffuseBounce) {
    // A slab just over the floor: the floor sees the emitter through it at every angle.
    const double height = 1.25;
    Scene scene;
    add_quad(scene, lambert(glm::vec3(0.5f)), {0, 0, 0}, {0.02, 0, 0}, {0, 0.02, 0});
    add_quad(scene, lambert(glm::vec3(0.0f), glm::vec3(7.0f)), {0, 0, height}, {0, 50, 0}, {50, 0, 0});
    add_box(scene, glass(1.5f), {0, 0, 1.0}, {50, 50, 0.001}, 1.0);
    add_camera(scene, {0.0, 0.1, 0.1}, {0, 0, 0}, 1e-5);
    // Irradiance / Le = int T(theta) 2 sin cos: with u = cos^2, int T du over [0, 1], by the midpoint rule.
    double transmitted = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double reflectance = fresnel_dielectric(std::sqrt((i + 0.5) / steps), 1.5);
        transmitted += (1.0 - reflectance) / (1.0 + reflectance) / steps;
    }
    expect_mean(path_trace(scene, {.size = {16, 16}, .samples = 1000}), glm::dvec3(0.5 * 7.0 * transmitted), 0.003);
}

TEST(OraclePathTracer, SameSeedSameBits) {
    const Scene scene = furnace(glm::vec3(0.5f), glm::vec3(0.5f));
    const auto trace = [&](std::uint64_t seed) {
        return path_trace(scene, {.size = {4, 4}, .samples = 4, .seed = seed}).mean;
    };
    EXPECT_TRUE(trace(1) == trace(1));
    EXPECT_FALSE(trace(1) == trace(2));
}

}  // namespace
}  // namespace vkcppm::oracle
