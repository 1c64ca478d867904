// Materials, media, alpha, environment and lens in the path tracer in double precision, against closed forms and
// quadratures.

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "oracle/dispersion.h"
#include "oracle/fresnel.h"
#include "oracle/path_tracer.h"
#include "oracle/surface.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"
#include "support/statistics/picture_mean.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;
using test::expect_mean;

constexpr double narrow = 1e-5;  // rad, the view of a camera that looks at a point
const glm::dvec3 origin(0.0);

std::uint32_t add(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return std::uint32_t(scene.materials.size() - 1);
}

/// A square of half side `half` in a plane of constant z; its front is up or down.
void add_level(Scene& scene, double z, double half, std::uint32_t material, bool up = true) {
    const glm::dvec3 x(2.0 * half, 0, 0), y(0, 2.0 * half, 0);
    test::add_quad(scene, {-half, -half, z}, up ? x : y, up ? y : x, material);
}

void set_constant_environment(Scene& scene, const glm::vec3& radiance) {
    scene.environment = Environment{{4, 2}, std::vector<glm::vec3>(8, radiance)};
}

Material plastic() {
    Material material;
    material.base_color = {0.8f, 0.5f, 0.2f};
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    return material;
}

Material rough_metal() {
    Material material;
    material.base_color = {0.9f, 0.6f, 0.3f};
    material.roughness = 0.5f;
    return material;
}

Material coated() {
    Material material = plastic();
    material.clearcoat = 0.8f;
    material.clearcoat_roughness = 0.3f;
    return material;
}

Material frosted_pane() {
    Material material = plastic();
    material.transmission = 1.0f;
    return material;
}

PathTracing look(const Scene& scene, std::uint32_t samples) {
    return path_trace(scene, {.size = {8, 8}, .samples = samples});
}

/// The surface at the origin of a scene whose only camera looks there.
Surface surface_of(const Scene& scene) {
    const Ray ray = camera_ray(scene.cameras[0], {1, 1}, 0.5, 0.5);
    return surface_at(scene, *nearest_hit(scene, ray), ray.direction);
}

const glm::dvec3 slanted_eye(1.2, 0.3, 0.9);

TEST(OracleMaterials, ConvexWhiteLambertIsTheEnvironment) {
    Scene scene;
    test::add_sphere(scene, origin, 1.0, 2, test::add_material(scene, test::lambert(glm::vec3(1.0f))), false);
    test::add_camera(scene, {0, 0, 4}, origin, 0.4);
    set_constant_environment(scene, {0.5f, 1.0f, 2.0f});
    expect_mean(look(scene, 1000), {0.5, 1.0, 2.0}, 0.002);
}

TEST(OracleMaterials, PlanesInAConstantEnvironmentShowTheirAlbedo) {
    for (const Material& material : {plastic(), rough_metal(), coated(), frosted_pane()}) {
        Scene scene;
        add_level(scene, 0.0, 1.0, add(scene, material));
        test::add_camera(scene, slanted_eye, origin, narrow);
        set_constant_environment(scene, glm::vec3(2.0f));
        SCOPED_TRACE(scene.materials[0].transmission + 10.0f * scene.materials[0].clearcoat);
        const glm::dvec3 albedo = surface_of(scene).bsdf.directional_albedo(glm::normalize(slanted_eye), 512);
        expect_mean(look(scene, 2000), 2.0 * albedo, 0.002);
    }
}

TEST(OracleMaterials, SolidGlassVanishesInAConstantEnvironment) {
    Material dispersive = test::glass(1.5f);
    dispersive.dispersion = 1.0f;
    Material rough_air = test::glass(1.0f);
    rough_air.roughness = 0.5f;
    for (const Material& material : {test::glass(1.5f), dispersive, rough_air}) {
        Scene scene;
        test::add_sphere(scene, origin, 1.0, 2, add(scene, material), false);
        test::add_camera(scene, {0, 0, 4}, origin, 0.4);
        set_constant_environment(scene, glm::vec3(1.0f));
        SCOPED_TRACE(material.dispersion);
        // Total reflection keeps one path in a thousand inside the facets for more than 64 bounces.
        expect_mean(path_trace(scene, {.size = {8, 8}, .samples = 400, .max_depth = 1000}), glm::dvec3(1.0), 0.01);
    }
}

TEST(OracleMaterials, EnvironmentFacesItsDirections) {
    Scene scene;
    scene.environment = Environment{{4, 2}, {}};
    for (int i = 0; i < 8; ++i) scene.environment->radiance.emplace_back(float(i + 1));
    const auto seen = [&](const glm::dvec3& direction) {
        scene.cameras.clear();
        test::add_camera(scene, origin, direction, narrow);
        return path_trace(scene, {.size = {1, 1}, .samples = 2}).mean.at(0, 0).x;
    };
    // Columns start at -x; -z, +x and +z are at 1/4, 1/2 and 3/4 of the width.
    EXPECT_EQ(seen({-1.0, 0.3, -0.2}), 1.0f);
    EXPECT_EQ(seen({1.0, 0.3, -0.2}), 2.0f);
    EXPECT_EQ(seen({1.0, 0.3, 0.2}), 3.0f);
    EXPECT_EQ(seen({-1.0, 0.3, 0.2}), 4.0f);
    EXPECT_EQ(seen({-1.0, -0.3, -0.2}), 5.0f) << "the lower row";
    EXPECT_EQ(seen({1.0, -0.3, 0.2}), 7.0f);
}

TEST(OracleMaterials, OnePixelOfTheEnvironmentLightsAPlane) {
    // Row 1 of 8: polar angles of 22.5 to 45 degrees from +y; irradiance on y = 0 of one of 16 columns:
    // 2 pi / 16 (sin^2 45 - sin^2 22.5) / 2.
    Scene scene;
    test::add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, test::add_material(scene, test::lambert(glm::vec3(0.5f))));
    test::add_camera(scene, {0.5, 1.0, 0.5}, origin, narrow);
    scene.environment = Environment{{16, 8}, std::vector<glm::vec3>(128)};
    scene.environment->radiance[16 + 5] = {100.0f, 50.0f, 25.0f};
    const double irradiance = 2.0 * pi / 16.0 * (0.5 - std::pow(std::sin(pi / 8.0), 2)) / 2.0;
    expect_mean(look(scene, 500), 0.5 / pi * irradiance * glm::dvec3(100.0, 50.0, 25.0), 0.002);
}

TEST(OracleMaterials, ColouredSlabAbsorbsAlongItsLength) {
    // Normal incidence, all reflections within: T = (1 - R)^2 a / (1 - R^2 a^2).
    const glm::dvec3 color(0.8, 0.4, 0.1);
    for (const float ior : {1.0f, 1.5f}) {
        Material material = test::glass(ior);
        material.attenuation_color = glm::vec3(color);
        material.attenuation_distance = 0.5f;
        Scene scene;
        test::add_box(scene, {-1, -1, -0.25}, {1, 1, 0.5}, add(scene, material), false);
        add_level(scene, -1.0, 5.0, add(scene, test::emitter(glm::vec3(2.0f))));
        test::add_camera(scene, {0, 0, 2}, origin, narrow);
        const glm::dvec3 absorbed = glm::pow(color, glm::dvec3(0.75 / 0.5));
        const double r = std::pow((ior - 1.0) / (ior + 1.0), 2);
        SCOPED_TRACE(ior);
        expect_mean(look(scene, 2000), 2.0 * (1.0 - r) * (1.0 - r) * absorbed / (1.0 - r * r * absorbed * absorbed),
                    0.003);
    }
}

TEST(OracleMaterials, MediumAbsorbsBeforeWhatStandsInIt) {
    // A half space of coloured air: the camera outside, an emitter inside at a depth of 0.6, seen at an angle.
    Material material = test::glass(1.0f);
    material.attenuation_color = {0.5f, 0.25f, 0.9f};
    material.attenuation_distance = 1.0f;
    Scene scene;
    add_level(scene, 0.0, 10.0, add(scene, material));
    add_level(scene, -0.6, 10.0, add(scene, test::emitter(glm::vec3(1.0f))));
    test::add_camera(scene, {0.6, 0.0, 0.8}, origin, narrow);
    expect_mean(look(scene, 2), glm::pow(glm::dvec3(material.attenuation_color), glm::dvec3(0.6 / 0.8)), 1e-4);
}

TEST(OracleMaterials, ConnectionsInAMediumAreAbsorbed) {
    // Floor and lamp both inside: radiance from the point below a square lamp by quadrature over it.
    const double half = 0.5, height = 0.8;
    const glm::dvec3 color(0.5, 0.25, 0.9);
    Material material = test::glass(1.0f);
    material.attenuation_color = glm::vec3(color);
    material.attenuation_distance = 1.0f;
    Scene scene;
    add_level(scene, 1.0, 10.0, add(scene, material));
    add_level(scene, 0.0, 10.0, test::add_material(scene, test::lambert(glm::vec3(0.5f))));
    add_level(scene, height, half, add(scene, test::emitter(glm::vec3(3.0f))), false);
    test::add_camera(scene, {2.4, 0.0, 1.8}, origin, narrow);
    glm::dvec3 irradiance(0.0);
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const glm::dvec3 p(half * (2.0 * (i + 0.5) / steps - 1.0), half * (2.0 * (j + 0.5) / steps - 1.0), height);
            const double d2 = glm::dot(p, p), area = std::pow(2.0 * half / steps, 2);
            irradiance += 3.0 * glm::pow(color, glm::dvec3(std::sqrt(d2))) * (height * height / (d2 * d2) * area);
        }
    }
    // From the floor to the eye: 3 m at 0.6, of which 1 / 0.6 inside.
    const glm::dvec3 expected = 0.5 / pi * irradiance * glm::pow(color, glm::dvec3(1.0 / 0.6));
    expect_mean(look(scene, 1000), expected, 0.002);
}

TEST(OracleMaterials, HalfAPlaneHalvesWhatIsBehind) {
    for (const bool mask : {false, true}) {
        Material veil = test::emitter(glm::vec3(0.4f));
        veil.alpha = mask ? Material::Alpha::mask : Material::Alpha::blend;
        veil.opacity = 0.5f;
        veil.alpha_cutoff = 0.6f;
        Scene scene;
        add_level(scene, 0.0, 1.0, add(scene, veil));
        add_level(scene, -1.0, 5.0, add(scene, test::emitter(glm::vec3(2.0f))));
        test::add_camera(scene, {0, 0, 2}, origin, narrow);
        SCOPED_TRACE(mask);
        expect_mean(look(scene, 1000), glm::dvec3(mask ? 2.0 : 1.2), 0.003);
    }
}

TEST(OracleMaterials, BlendedPlanesPassShadowRays) {
    // A lamp over a Lambert floor behind two black veils of 0.5 and one that its mask takes away; the camera is below
    // the veils. The lamp itself is half there.
    Material veil = test::emitter(glm::vec3(0.0f));
    veil.alpha = Material::Alpha::blend;
    veil.opacity = 0.5f;
    Material gone = veil;
    gone.alpha = Material::Alpha::mask;
    gone.alpha_cutoff = 0.75f;
    Material lamp = test::emitter(glm::vec3(6.0f));
    lamp.alpha = Material::Alpha::blend;
    lamp.opacity = 0.5f;
    Scene scene;
    add_level(scene, 0.0, 3.0, test::add_material(scene, test::lambert(glm::vec3(0.5f))));
    add_level(scene, 0.8, 3.0, add(scene, veil));
    add_level(scene, 0.9, 3.0, add(scene, veil));
    add_level(scene, 1.0, 3.0, add(scene, gone));
    const double half = 0.5, height = 1.25;
    add_level(scene, height, half, add(scene, lamp), false);
    test::add_camera(scene, {0.0, 0.4, 0.3}, origin, narrow);
    const double x = half / height, root = std::sqrt(1.0 + x * x);
    const double form_factor = 4.0 / pi * x / root * std::atan(x / root);
    expect_mean(look(scene, 2000), glm::dvec3(0.5 * 0.25 * 0.5 * 6.0 * form_factor), 0.005);
    PunctualLight light;
    light.position = {0.0, 0.0, 2.0};
    scene.lights = {light};
    scene.triangles.resize(scene.triangles.size() - 2);
    expect_mean(look(scene, 2), glm::dvec3(0.5 / pi * 0.25 / 4.0), 1e-6);
}

TEST(OracleMaterials, ThinPanePassesStraightOn) {
    const double angle = 1.0, cosine = std::cos(angle);
    const glm::dvec3 behind(1.0, 1.0, 0.4), front(0.2, 1.0, 1.6);
    Material pane = test::glass(1.5f);
    pane.thickness = 0.0f;
    pane.base_color = {0.5f, 0.9f, 1.0f};
    for (const bool from_front : {true, false}) {
        Scene scene;
        add_level(scene, 0.0, 1.0, add(scene, pane), from_front);
        // Narrow enough that only the straight way ends on it.
        const glm::dvec3 eye(std::sin(angle), 0.0, cosine);
        add_level(scene, 2.0, 50.0, add(scene, test::emitter(glm::vec3(front))), false);
        const std::uint32_t target = add(scene, test::emitter(glm::vec3(behind)));
        test::add_quad(scene, -eye / cosine + glm::dvec3(-0.01, -0.01, 0.0), {0.02, 0, 0}, {0, 0.02, 0}, target);
        test::add_camera(scene, eye, origin, narrow);
        const double r = fresnel_dielectric(cosine, 1.5);
        SCOPED_TRACE(from_front);
        expect_mean(look(scene, 1000), (1.0 - r) * glm::dvec3(pane.base_color) * behind + r * front, 0.005);
    }
}

TEST(OracleMaterials, GlassBlocksPunctualLights) {
    Material pane = test::glass(1.5f);
    pane.thickness = 0.0f;
    Scene scene;
    add_level(scene, 0.0, 1.0, test::add_material(scene, test::lambert(glm::vec3(1.0f))));
    add_level(scene, 1.0, 1.0, add(scene, pane));
    test::add_camera(scene, {0.0, 0.4, 0.3}, origin, narrow);
    scene.lights.emplace_back().position = {0.0, 0.0, 2.0};
    EXPECT_EQ(look(scene, 4).mean.at(0, 0), glm::vec3(0.0f));
}

TEST(OracleMaterials, RoughSurfacesUnderAPointLight) {
    for (const Material& material : {plastic(), rough_metal(), coated(), frosted_pane()}) {
        Scene scene;
        add_level(scene, 0.0, 1.0, add(scene, material));
        test::add_camera(scene, slanted_eye, origin, narrow);
        const glm::dvec3 wo = glm::normalize(slanted_eye);
        PunctualLight light;
        light.intensity = {1.0f, 2.0f, 3.0f};
        for (const double side : {1.0, -1.0}) {
            light.position = {-1.0, -0.5, 0.8 * side};
            scene.lights = {light};
            const glm::dvec3 wi = glm::normalize(light.position);
            const glm::dvec3 expected = surface_of(scene).bsdf.evaluate(wo, wi) * std::abs(wi.z) *
                                        glm::dvec3(light.intensity) / glm::dot(light.position, light.position);
            const glm::dvec3 result(look(scene, 2).mean.at(4, 4));
            EXPECT_LT(glm::distance(result, expected), 1e-3 * glm::length(expected) + 1e-12)
                << "green " << result.y << " instead of " << expected.y;
            EXPECT_EQ(expected.y > 0.0, side > 0.0 || material.transmission > 0.0f);
        }
    }
}

TEST(OracleMaterials, RoughSurfacesUnderASquareLight) {
    const double half = 0.6, height = 1.1;
    for (const Material& material : {plastic(), rough_metal(), coated()}) {
        Scene scene;
        add_level(scene, 0.0, 1.0, add(scene, material));
        const glm::dvec3 corner(-1.3 - half, -0.3 - half, height);
        test::add_quad(scene, corner, {0, 2.0 * half, 0}, {2.0 * half, 0, 0},
                       add(scene, test::emitter(glm::vec3(5.0f))));
        test::add_camera(scene, slanted_eye, origin, narrow);
        const Bsdf bsdf = surface_of(scene).bsdf;
        glm::dvec3 expected(0.0);
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {
                const glm::dvec3 p = corner + 2.0 * half / steps * glm::dvec3(i + 0.5, j + 0.5, 0.0);
                const double d2 = glm::dot(p, p), cosine = height / std::sqrt(d2);
                expected += 5.0 * bsdf.evaluate(glm::normalize(slanted_eye), glm::normalize(p)) *
                            (cosine * cosine / d2 * std::pow(2.0 * half / steps, 2));
            }
        }
        expect_mean(look(scene, 1000), expected, 0.003);
    }
}

TEST(OracleMaterials, HalfOfAnEmitterIsTexturedBlack) {
    const double half = 0.5, height = 1.25;
    Scene scene;
    Material lamp = test::emitter({7.0f, 3.0f, 1.0f});
    lamp.emissive_texture = Texture{};
    lamp.emissive_texture->nearest = true;
    scene.images.push_back({"half", {2, 1}, {255, 255, 255, 255, 0, 0, 0, 255}});
    add_level(scene, 0.0, 3.0, test::add_material(scene, test::lambert(glm::vec3(0.5f))));
    add_level(scene, height, half, add(scene, lamp), false);
    for (const glm::dvec3& p : scene.positions) {
        scene.uv[0].emplace_back(p.x / (2.0 * half) + 0.5, p.y / (2.0 * half) + 0.5);
    }
    test::add_camera(scene, {0.0, 2.0, 1.0}, origin, narrow);
    const double x = half / height, root = std::sqrt(1.0 + x * x);
    const double form_factor = 2.0 / pi * x / root * std::atan(x / root);  // below the edge between the halves
    expect_mean(look(scene, 6000), 0.5 * form_factor * glm::dvec3(7.0, 3.0, 1.0), 0.002);
    for (const double side : {-0.25, 0.25}) {
        scene.cameras.clear();
        test::add_camera(scene, {side, 0.0, 1.0}, {side, 0.001, height}, narrow);
        EXPECT_EQ(look(scene, 2).mean.at(0, 0).x, side < 0.0 ? 7.0f : 0.0f);
    }
}

TEST(OracleMaterials, UnlitIsSeenAndLightsNothing) {
    Material poster;
    poster.unlit = true;
    poster.base_color = {0.2f, 0.4f, 0.8f};
    poster.emission = glm::vec3(9.0f);
    const auto scene_with = [&](const Material& floor) {
        Scene scene;
        add_level(scene, 0.0, 3.0, add(scene, floor));
        add_level(scene, 1.0, 3.0, add(scene, poster), false);
        test::add_camera(scene, {0.5, 0.0, 0.5}, origin, narrow);
        return scene;
    };
    Material mirror;
    mirror.roughness = 0.0f;
    expect_mean(look(scene_with(mirror), 2), glm::dvec3(poster.base_color), 1e-6);
    EXPECT_EQ(look(scene_with(plastic()), 4).mean.at(0, 0), glm::vec3(0.0f)) << "lights no rough surface";
    EXPECT_EQ(look(scene_with(poster), 2).mean.at(0, 0), poster.base_color) << "seen itself";
    Scene shadowed = scene_with(plastic());
    shadowed.lights.emplace_back().position = {0.0, 0.0, 2.0};
    EXPECT_EQ(look(shadowed, 4).mean.at(0, 0), glm::vec3(0.0f)) << "throws a shadow";
}

TEST(OracleMaterials, DispersionSpreadsColoursAtAnEdge) {
    // From the eye at 45 degrees into glass; light of 550 nm meets the floor of the half space at `edge`, shorter waves
    // before it. The floor is lit up to there: all of blue's wavelengths, half of green's, none of red's.
    const double sine = std::sqrt(0.5), depth = 1.0;
    Material material = test::glass(1.5f);
    material.dispersion = 1.0f;
    const double refracted = std::asin(sine / ior_at(1.5, 1.0, 550.0));
    const double edge = -depth * std::tan(refracted);
    Scene scene;
    add_level(scene, 0.0, 5.0, add(scene, material));
    test::add_quad(scene, {edge, -1.0, -depth}, {1.0, 0, 0}, {0, 2.0, 0}, add(scene, test::emitter(glm::vec3(1.0f))));
    test::add_camera(scene, {sine, 0.0, sine}, origin, 1e-6);
    const double transmitted = 1.0 - fresnel_dielectric(sine, 1.5);
    const auto result = path_trace(scene, {.size = {8, 8}, .samples = 4000});
    glm::dvec3 mean(0.0);
    for (const glm::vec3& pixel : result.mean.rgb) mean += glm::dvec3(pixel) / 64.0;
    // 256,000 paths; the weights are at most 3.43, so that the standard error is below 0.003.
    EXPECT_LT(mean.x, 1e-4) << "red";
    EXPECT_NEAR(mean.y, 0.5 * transmitted, 0.01) << "green";
    EXPECT_NEAR(mean.z, transmitted, 0.01) << "blue";
}

TEST(OracleLens, RaysMeetWhereItIsSharp) {
    Scene scene;
    test::add_camera(scene, {1.0, 2.0, 3.0}, {0.0, 1.5, 0.5}, 0.8);
    const Camera& camera = scene.cameras[0];
    const Extent size{40, 20};
    const double focus = 2.5;
    const glm::dvec3 axis = -glm::dvec3(camera.to_world[2]), eye(camera.to_world[3]);
    const auto at_focus = [&](const Ray& ray) {
        const double t = (focus - glm::dot(ray.origin - eye, axis)) / glm::dot(ray.direction, axis);
        return ray.origin + t * ray.direction;
    };
    const glm::dvec3 sharp = at_focus(camera_ray(camera, size, 31.0, 4.0));
    for (const glm::dvec2& lens : {glm::dvec2(0.1, 0.0), glm::dvec2(-0.05, 0.2)}) {
        const Ray ray = lens_ray(camera, size, 31.0, 4.0, lens, focus);
        EXPECT_LT(glm::distance(at_focus(ray), sharp), 1e-12);
        EXPECT_LT(glm::distance(ray.origin, eye + glm::dmat3(camera.to_world) * glm::dvec3(lens, 0.0)), 1e-12);
    }
}

TEST(OracleLens, KeepsAUniformField) {
    Scene scene;
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), add(scene, test::emitter(glm::vec3(1.5f))), true);
    test::add_camera(scene, {0.1, 0.2, 0.5}, origin, 1.0);
    const auto result = path_trace(scene, {.size = {8, 8}, .samples = 16, .aperture = 0.3, .focus_distance = 0.7});
    for (const glm::vec3& pixel : result.mean.rgb) EXPECT_EQ(pixel, glm::vec3(1.5f));
}

TEST(OracleLens, BlursAnEdgeByTheLensItself) {
    // Sharp at 1, an edge at 2: a lens point x sees -x there, so an edge at half the radius leaves the lens's segment
    // beyond it: (acos t - t sqrt(1 - t^2)) / pi, t = 1/2.
    const double aperture = 0.4, edge = aperture / 4.0, t = 0.5;
    Scene scene;
    test::add_quad(scene, {edge, -5.0, -2.0}, {5.0, 0, 0}, {0, 10.0, 0}, add(scene, test::emitter(glm::vec3(1.0f))));
    test::add_camera(scene, origin, {0, 0, -1}, narrow);
    expect_mean(path_trace(scene, {.size = {8, 8}, .samples = 1000, .aperture = aperture, .focus_distance = 1.0}),
                glm::dvec3((std::acos(t) - t * std::sqrt(1.0 - t * t)) / pi), 0.01);
}

}  // namespace
}  // namespace vkcppm::oracle
