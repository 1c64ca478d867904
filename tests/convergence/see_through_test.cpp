// Light straight through what is not there, what only colours it and solids that touch, against closed forms: for eye
// paths, for photons and for the path tracer.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "oracle/fresnel.h"
#include "render/path_tracer.h"
#include "study/batch_mean.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

glm::dvec3 mean_of(const Image& image) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& rgb : image.rgb) sum += glm::dvec3(rgb);
    return sum / double(image.rgb.size());
}

Settings small_settings(const char* direct = direct_sampled) {
    Settings settings;
    settings.size = Extent{32, 32};
    settings.photons = 256;
    settings.direct = direct;
    return settings;
}

Settings with_photons(const char* direct = direct_sampled) {
    Settings settings = small_settings(direct);
    settings.size = Extent{16, 16};
    settings.photons = 32768;
    return settings;
}

Image traced(const Scene& scene, const Settings& wanted) {
    const Settings settings = resolve_settings(wanted, scene);
    const FlatScene flat = flatten(scene);
    const SceneOnDevice on_device(plain_device(), flat);
    PathTracer tracer(on_device, scene.cameras.at(0), settings, PathTracer::Light::all);
    BatchMean batches(*settings.size);
    for (int i = 0; i < 8; ++i) batches.add(tracer.trace());
    EXPECT_EQ(tracer.invalid(), 0u);
    Image image{*settings.size, {}};
    for (std::size_t i = 0; i < settings.size->pixels(); ++i) image.rgb.emplace_back(batches.mean()[i]);
    return image;
}

void expect_mean(const Image& image, const glm::dvec3& want, double relative, const std::string& what) {
    const glm::dvec3 got = mean_of(image);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], relative * want[c] + 2e-4) << what << ", channel " << c;
}

// Each needs more than five seconds, for scenes whose kernels no other test has: each is compiled for it, three times.
class SeeThrough : public GpuTest {
protected:
    /// The mean of the picture, which is to be of one colour all over, by photon mapping and by path tracing.
    static void expect_seen(const Scene& scene, const glm::dvec3& want, double relative, const std::string& what,
                            std::uint32_t iterations = 32) {
        expect_mean(valid_picture(scene, small_settings(), iterations), want, relative, what + ", photons");
        expect_mean(traced(scene, small_settings()), want, 2.0 * relative, what + ", paths");
    }
};

/// Looks down the z axis, from z = 4 to a lamp of 1 at z = -1 that fills the picture, through what `add` puts there.
Scene before_a_lamp(const std::function<void(Scene&)>& add) {
    Scene scene;
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, add_material(scene, emitter(glm::vec3(1.0f))));
    add(scene);
    add_camera(scene, {0.011, 0.013, 4.0}, {0.011, 0.013, 0.0}, 0.05);
    return scene;
}

/// The ground z = 0 of albedo 0.02 in the sun that comes straight down, seen from below what `add` puts between 0.5 and
/// 2. The sun brings pi across its direction, so that the ground shows the albedo times what gets through.
Scene in_the_sun(const std::function<void(Scene&)>& add) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(glm::vec3(0.02f))));
    add(scene);
    add_directional_light(scene, {0, 0, -1}, glm::vec3(3.14159265f));
    add_camera(scene, {0, -0.6, 0.45}, {0, 0, 0}, 0.6);
    return scene;
}

void add_sheets(Scene& scene, int count, const Material& material) {
    const std::uint32_t sheet = add_material(scene, material);
    for (int i = 0; i < count; ++i)
        add_quad(scene, {-1.2, -1.2, 0.5 + 1.5 * i / count}, {2.4, 0, 0}, {0, 2.4, 0}, sheet);
}

Material partly_there(Material::Alpha alpha, float opacity) {
    Material sheet = lambert(glm::vec3(0.0f));
    sheet.alpha = alpha;
    sheet.opacity = opacity;
    return sheet;
}

// A path of four bounces gets through any number of surfaces that are not there.
TEST_F(SeeThrough, WhatIsNotThereIsNoBounce) {
    const Material cut = partly_there(Material::Alpha::mask, 0.2f), clear = partly_there(Material::Alpha::blend, 0.0f);
    const Material faint = partly_there(Material::Alpha::blend, 0.01f);
    const double left = std::pow(0.99, 30);
    const auto few_bounces = [](const char* direct) {
        Settings settings = with_photons(direct);
        settings.max_depth = 4;
        return settings;
    };
    const std::vector<std::tuple<const char*, Material, int, double>> cases = {
        {"cut away", cut, 20, 1.0}, {"clear", clear, 20, 1.0}, {"faint", faint, 30, left}};
    for (const auto& [name, material, count, want] : cases) {
        const auto add = [&](Scene& scene) { add_sheets(scene, count, material); };
        const Scene seen = before_a_lamp(add), lit = in_the_sun(add);
        SCOPED_TRACE(name);
        const double noise = want < 1.0 ? 0.03 : 1e-5;
        expect_mean(valid_picture(seen, few_bounces(direct_sampled), 32), glm::dvec3(want), noise, "seen");
        expect_mean(traced(seen, few_bounces(direct_sampled)), glm::dvec3(want), noise, "seen by paths");
        expect_mean(valid_picture(lit, few_bounces(direct_sampled), 8), glm::dvec3(0.02 * want), 0.03,
                    "lit, asked for");
        expect_mean(valid_picture(lit, few_bounces(direct_gathered), 8), glm::dvec3(0.02 * want), 0.05,
                    "lit, gathered");
        expect_mean(traced(lit, few_bounces(direct_sampled)), glm::dvec3(0.02 * want), 0.03, "lit, paths");
    }
}

// Random numbers go on beyond the thousandth surface.
TEST_F(SeeThrough, ThousandsOfSheetsArePassed) {
    const Material cut = partly_there(Material::Alpha::mask, 0.2f), faint = partly_there(Material::Alpha::blend, 5e-4f);
    const auto sheets = [](const Material& material) {
        return before_a_lamp([&](Scene& scene) { add_sheets(scene, 1500, material); });
    };
    expect_mean(valid_picture(sheets(cut), small_settings(), 1), glm::dvec3(1.0), 1e-5, "cut away");
    expect_mean(valid_picture(sheets(faint), small_settings(), 2), glm::dvec3(std::pow(1.0 - 5e-4, 1500)), 0.1,
                "faint");
}

// The same of panes without a surface to speak of, and of a body that does not refract; photons of both directions.
TEST_F(SeeThrough, WhatLightGoesStraightThroughIsNoBounce) {
    Material pane = glass(1.0f);
    pane.thickness = 0.0f;
    pane.base_color = glm::vec3(0.99f, 1.0f, 1.0f);
    Settings settings = with_photons();
    settings.max_depth = 4;
    const glm::dvec3 want(std::pow(0.99, 50), 1.0, 1.0);
    const auto panes = [&](Scene& scene) { add_sheets(scene, 50, pane); };
    expect_mean(valid_picture(before_a_lamp(panes), settings, 8), want, 1e-4, "panes");
    expect_mean(traced(before_a_lamp(panes), settings), want, 1e-4, "panes, paths");
    settings.direct = direct_gathered;
    expect_mean(valid_picture(in_the_sun(panes), settings, 16), 0.02 * want, 0.05, "lit through panes");
    const auto bodies = [](Scene& scene) {
        const std::uint32_t body = add_material(scene, glass(1.0f));
        for (int i = 0; i < 8; ++i)
            add_box(scene, {-1.2, -1.2, 0.5 + 0.1 * i}, {1.2, 1.2, 0.55 + 0.1 * i}, body, false);
    };
    expect_mean(valid_picture(before_a_lamp(bodies), settings, 8), glm::dvec3(1.0), 1e-4, "bodies");
    expect_mean(valid_picture(in_the_sun(bodies), settings, 16), glm::dvec3(0.02), 0.05, "lit through bodies");
}

// glTF 2.0, 3.9.6. Only the camera's own rays pass a back: what it hides from a lamp stays dark.
TEST_F(SeeThrough, TheCameraDoesNotSeeBacks) {
    for (const bool double_sided : {false, true}) {
        Material wall = lambert(glm::vec3(0.0f));
        wall.double_sided = double_sided;
        const auto add_back = [&](Scene& s) {
            add_quad(s, {-1.2, -1.2, 1}, {0, 2.4, 0}, {2.4, 0, 0}, add_material(s, wall));
        };
        const double seen = double_sided ? 0.0 : 1.0;
        expect_seen(before_a_lamp(add_back), glm::dvec3(seen), 1e-5, "a back before a lamp", 4);
        // A pane before it does not make it appear.
        const auto with_pane = [&](Scene& s) {
            add_back(s);
            Material pane = glass(1.0f);
            pane.thickness = 0.0f;
            add_quad(s, {-1.2, -1.2, 2}, {0, 2.4, 0}, {2.4, 0, 0}, add_material(s, pane));
        };
        expect_seen(before_a_lamp(with_pane), glm::dvec3(seen), 1e-5, "a back behind a pane", 4);
        const auto in_shadow = [&](Scene& s) {
            add_quad(s, {-1.2, -1.2, 1}, {0, 2.4, 0}, {2.4, 0, 0}, add_material(s, wall));
        };
        for (const char* direct : {direct_sampled, direct_gathered}) {
            expect_mean(valid_picture(in_the_sun(in_shadow), with_photons(direct), 4), glm::dvec3(0.0), 0.0,
                        "the shadow of a back");
        }
        expect_mean(traced(in_the_sun(in_shadow), small_settings()), glm::dvec3(0.0), 0.0, "the same, paths");
    }
    // The inside of a closed body is there, and keeps out the light.
    Scene inside;
    inside.environment = Environment{{1, 1}, {glm::vec3(1.0f)}};
    add_box(inside, {-1, -1, -1}, {1, 1, 1}, add_material(inside, lambert(glm::vec3(0.5f))), false);
    add_camera(inside, {0.1, 0.2, 0.3}, {0.1, 0.2, -1.0}, 0.5);
    expect_seen(inside, glm::dvec3(0.0), 0.0, "in a closed box", 4);
    // The back of glass is its inside, and is there.
    const auto block = [](Scene& s) {
        add_box(s, {-1.2, -1.2, 0.5}, {1.2, 1.2, 1}, add_material(s, glass(1.5f)), false);
    };
    expect_seen(before_a_lamp(block), glm::dvec3(0.96 / 1.04), 0.01, "a block of glass", 64);
}

// c^(x / d) of c = 0: nothing, however short the way; T = (1 - F)^2 a / (1 - F^2 a^2).
TEST_F(SeeThrough, AColourOfZeroLeavesNothing) {
    Material tinted = glass(1.5f);
    tinted.attenuation_color = {0.0f, 0.5f, 1.0f};
    tinted.attenuation_distance = 1e4f;
    const auto block = [&](Scene& s) { add_box(s, {-1.2, -1.2, 0.5}, {1.2, 1.2, 1}, add_material(s, tinted), false); };
    const double a = std::pow(0.5, 0.5 / 1e4), f = 0.04;
    const auto through = [&](double t) { return (1.0 - f) * (1.0 - f) * t / (1.0 - f * f * t * t); };
    const glm::dvec3 want(0.0, through(a), through(1.0));
    expect_seen(before_a_lamp(block), want, 0.01, "seen", 64);
    expect_mean(valid_picture(in_the_sun(block), with_photons(), 16), 0.02 * want, 0.05, "lit");
}

// KHR_materials_clearcoat: of what is emitted below it what it does not reflect gets out, by Schlick at f0 = 0.04 and
// the angle to the coat's own normal, here that of tilted vertices.
TEST_F(SeeThrough, AClearcoatDimsWhatIsEmittedBelowIt) {
    for (const auto& [angle, tilt] :
         {std::pair(0.0, 0.0), std::pair(std::numbers::pi / 3.0, 0.0), std::pair(std::numbers::pi / 3.0, -0.4)}) {
        Material coated = emitter(glm::vec3(1.0f, 0.5f, 0.0f));
        coated.clearcoat = 0.5f;
        Scene scene;
        add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, coated));
        for (auto& normal : scene.normals) normal = {std::sin(tilt), 0.0, std::cos(tilt)};
        add_camera(scene, {4.0 * std::sin(angle), 0.013, 4.0 * std::cos(angle)}, {0.0, 0.0, 0.0}, 0.05);
        const double out = 1.0 - 0.5 * (0.04 + 0.96 * std::pow(1.0 - std::cos(angle - tilt), 5));
        expect_seen(scene, {out, 0.5 * out, 0.0}, 0.002, fmt::format("at {}, tilted by {}", angle, tilt), 4);
    }
}

// KHR_materials_specular at 45 degrees: F of the glass times the strength, and of a colour of 0 Schlick's (1 - cos)^5.
TEST_F(SeeThrough, SpecularFactorsScaleWhatGlassReflects) {
    const double exact = oracle::fresnel_dielectric(std::sqrt(0.5), 1.5), edge = std::pow(1.0 - std::sqrt(0.5), 5);
    struct Case {
        float strength;
        glm::vec3 color;
        glm::dvec3 reflected;
    };
    const Case cases[] = {{1.0f, glm::vec3(1.0f), glm::dvec3(exact)},
                          {0.0f, glm::vec3(1.0f), glm::dvec3(0.0)},
                          {0.5f, glm::vec3(1.0f), glm::dvec3(0.5 * exact)},
                          {0.8f, glm::vec3(1.0f, 0.0f, 0.0f), 0.8 * glm::dvec3(exact, edge, edge)}};
    for (const Case& c : cases) {
        Material pane = glass(1.5f);
        pane.thickness = 0.0f;
        pane.specular = c.strength;
        pane.specular_color = c.color;
        const auto add = [&](Scene& s) {
            add_quad(s, {-1.2, -1.2, -1.2}, {2.4, 0, 2.4}, {0, 2.4, 0}, add_material(s, pane));
        };
        SCOPED_TRACE(fmt::format("strength {}, {} in green", c.strength, c.color.y));
        expect_seen(before_a_lamp(add), glm::dvec3(1.0 - std::max(c.reflected.x, c.reflected.y)), 0.01, "through", 64);
        // Light goes through panes to where it is asked for, too, and photons do.
        for (const char* direct : {direct_sampled, direct_gathered}) {
            Scene lit;
            add_quad(lit, {-0.5, -0.5, -3}, {1, 0, 0}, {0, 1, 0}, add_material(lit, lambert(glm::vec3(0.02f))));
            add(lit);
            add_directional_light(lit, {0, 0, -1}, glm::vec3(3.14159265f));
            add_camera(lit, {0, -0.4, -2.6}, {0, 0, -3}, 0.4);
            const double through = 1.0 - std::max(c.reflected.x, c.reflected.y);
            expect_mean(valid_picture(lit, with_photons(direct), 16), glm::dvec3(0.02 * through), 0.05, direct);
        }
        Scene mirrored;  // a lamp to the left of the pane
        add_quad(mirrored, {-3, -1, -1}, {0, 2, 0}, {0, 0, 2}, add_material(mirrored, emitter(glm::vec3(1.0f))));
        add_quad(mirrored, {1.2, -1.2, 1.2}, {-2.4, 0, -2.4}, {0, 2.4, 0}, add_material(mirrored, pane));
        add_camera(mirrored, {0.011, 0.013, 3.5}, {0.011, 0.013, 0.0}, 0.05);
        expect_seen(mirrored, c.reflected, 0.01, "mirrored", 64);
    }
    // Nothing is reflected at a solid without strength, on the way in and on the way out.
    Material solid = glass(1.5f);
    solid.specular = 0.0f;
    const auto block = [&](Scene& s) { add_box(s, {-1.2, -1.2, 0.5}, {1.2, 1.2, 1}, add_material(s, solid), false); };
    expect_seen(before_a_lamp(block), glm::dvec3(1.0), 1e-4, "a solid without specular", 8);
    expect_mean(valid_picture(in_the_sun(block), with_photons(), 16), glm::dvec3(0.02), 0.05, "lit through it");
}

/// What gets through parallel faces of these reflectances with all reflections between them: (1 - T) / T adds up.
double through_faces(const std::vector<double>& reflectances) {
    double sum = 0.0;
    for (const double r : reflectances) sum += r / (1.0 - r);
    return 1.0 / (1.0 + sum);
}

double head_on(double ratio) { return std::pow((ratio - 1.0) / (ratio + 1.0), 2); }

// Glass, water, glass: where they touch or overlap light meets their relative index, not air.
TEST_F(SeeThrough, LiquidsInGlassMeetItByTheRelativeIndex) {
    const double glass_air = head_on(1.5), water_air = head_on(1.33), glass_water = head_on(1.5 / 1.33);
    const double apart = through_faces({glass_air, glass_air, water_air, water_air, glass_air, glass_air});
    const double together = through_faces({glass_air, glass_water, glass_water, glass_air});
    struct Case {
        const char* name;
        double gap;     // between the water and the glass
        double margin;  // of the water over the glass, sideways
        double want;
    };
    const Case cases[] = {{"with gaps", 0.01, 0.0, apart},
                          {"touching", 0.0, 0.0, together},
                          {"touching in part", 0.0, 0.2, together},
                          {"overlapping", -0.02, -0.1, together},
                          {"overlapping, flush", -0.02, 0.0, together},
                          {"overlapping, larger", -0.02, 0.2, together}};
    for (const Case& c : cases) {
        const auto slabs = [&](Scene& s) {
            const std::uint32_t clear = add_material(s, glass(1.5f)), water = add_material(s, glass(1.33f));
            const double side = 1.2 + c.margin;
            add_box(s, {-1.2, -1.2, 0.5}, {1.2, 1.2, 0.7}, clear, false);
            add_box(s, {-side, -side, 0.7 + c.gap}, {side, side, 1.3 - c.gap}, water, false);
            add_box(s, {-1.2, -1.2, 1.3}, {1.2, 1.2, 1.5}, clear, false);
        };
        const bool nested = !flatten(before_a_lamp(slabs)).nested.empty();
        EXPECT_EQ(nested, c.gap <= 0.0) << c.name;
        // Without any reflection between them 0.923 instead of 0.917.
        expect_seen(before_a_lamp(slabs), glm::dvec3(c.want), 0.004, c.name, 64);
        // Radiance that is not scaled at one of the faces is off by the squared ratio of two indices.
        Scene furnace;
        furnace.environment = Environment{{1, 1}, {glm::vec3(1.0f)}};
        slabs(furnace);
        add_camera(furnace, {0.0, -1.5, 3.0}, {0, 0, 1}, 0.3);
        expect_mean(valid_picture(furnace, small_settings(), 8), glm::dvec3(1.0), 0.03,
                    fmt::format("{}, under a white sky", c.name));
        expect_mean(valid_picture(in_the_sun(slabs), with_photons(), 32), glm::dvec3(0.02 * c.want), 0.03,
                    fmt::format("{}, lit", c.name));
    }
}

// A solid in a solid, without contact: each of its faces parts the two, and of the way in each the own colour counts.
TEST_F(SeeThrough, SolidsInSolidsTintByTheirOwnWays) {
    Material outer = glass(1.5f), inner = glass(1.5f);
    outer.attenuation_color = {0.5f, 1.0f, 1.0f};
    inner.attenuation_color = {1.0f, 0.5f, 1.0f};
    outer.attenuation_distance = inner.attenuation_distance = 1.0f;
    for (const double reach : {0.0, 0.8}) {  // inside, or out of the far side of the other
        const auto add = [&](Scene& s) {
            add_box(s, {-1.2, -1.2, 0.5}, {1.2, 1.2, 1.5}, add_material(s, outer), false);
            add_box(s, {-1, -1, 0.7 - reach}, {1, 1, 1.0}, add_material(s, inner), false);
        };
        const double f = 0.04, in_inner = 0.3 + reach, in_outer = 0.5 + (reach > 0.0 ? 0.0 : 0.2);
        const glm::dvec3 a(std::pow(0.5, in_outer), std::pow(0.5, in_inner), 1.0);
        expect_seen(before_a_lamp(add), (1.0 - f) * (1.0 - f) * a / (1.0 - f * f * a * a), 0.015,
                    fmt::format("reach {}", reach), 64);
    }
}

// Radiance within a medium is n^2 times that outside: the eye knows that it is in water, and that glass is about it.
TEST_F(SeeThrough, TheEyeMayBeInALiquid) {
    Scene scene;
    scene.environment = Environment{{1, 1}, {glm::vec3(1.0f)}};
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, glass(1.33f)), false);
    // A wall of glass that the water reaches into, all round.
    const std::uint32_t wall = add_material(scene, glass(1.5f));
    add_box(scene, {-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2}, wall, false);
    add_box(scene, {-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}, wall, true);
    add_camera(scene, {0.1, 0.2, 0.3}, {0.1, 0.2, -1.0}, 0.5);
    expect_seen(scene, glm::dvec3(1.33 * 1.33), 0.01, "an eye in water in glass", 64);
}

}  // namespace
}  // namespace vkcppm::test
