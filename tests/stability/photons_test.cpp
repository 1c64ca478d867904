// Photons where they are hard to gather: all in one place, none at all, radii from 1e-6 to 1 side by side.

#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

class HardPhotons : public GpuTest {
protected:
    static Settings settings_of(Extent size, std::uint32_t photons) {
        Settings settings;
        settings.size = size;
        settings.photons = photons;
        settings.direct = direct_gathered;
        return settings;
    }

    /// A white floor under a spot light of that cone, 1 m above it.
    static Scene floor_under_spot(double cone) {
        Scene scene;
        add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(1.0f))));
        add_spot_light(scene, {0, 1, 0}, {0, -1, 0}, cone, {0.1f, 1.0f / 3.0f, 0.7f});
        add_camera(scene, {0, 4, 0.001}, {0, 0, 0}, 0.45);
        return scene;
    }
};

// The flux of a disc as a plain sum of floats: 1.1e-3.
TEST_F(HardPhotons, APixelThatSeesThemAll) {
    constexpr std::uint32_t paths = 1u << 18;
    Rig rig(floor_under_spot(1e-5), settings_of({1, 1}, paths), plain_device());
    rig.integrator.run(1);
    gpu::PixelState state = rig.all<gpu::PixelState>(Binding::pixels).at(0);
    state.radius2 = 1.0f;
    state.seeded = 1;
    rig.integrator.buffer(Binding::pixels).upload(std::vector{state});
    rig.integrator.run(1);
    const gpu::Gathered sum = rig.all<gpu::Gathered>(Binding::gathered).at(0);
    EXPECT_EQ(sum.count, paths);
    double error = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double want = double(paths) * double(rig.flat.lights.at(0).power[c]);
        error = std::max(error, std::abs(double(sum.flux[c]) / want - 1.0));
    }
    expect_error("flux of a pixel that sees all of 262,144 photons, in one cell", error, 1e-6);
}

// The irradiance is the light's intensity, whatever the size of the spot. With cosines in place of versines: 2.2.
TEST_F(HardPhotons, AllInOneCell) {
    const auto spot = [](double cone) {
        Scene scene = floor_under_spot(cone);
        scene.cameras.clear();
        add_camera(scene, {0, 4, 1e-7}, {0, 0, 0}, cone);  // the spot fills half of the picture
        Rig rig(scene, settings_of({16, 16}, 4096), plain_device());
        rig.integrator.run(32);
        return rig.integrator.resolve();
    };
    expect_picture("a spot of 1e-4 rad seen from near, against 0.03 rad", spot(1e-4), spot(0.03), 0.05);
}

TEST_F(HardPhotons, APixelThatNeverSeesOne) {
    Scene scene = floor_under_spot(0.1);
    // A floor in the shade of a wall all round it.
    const std::uint32_t white = add_material(scene, lambert(glm::vec3(1.0f)));
    add_quad(scene, {0.6, 0.01, 0.6}, {0, 0, 0.3}, {0.3, 0, 0}, white);
    Rig rig(scene, settings_of({24, 24}, 1024), plain_device());
    rig.integrator.run(200);
    double dark = 0.0, lit = 0.0;
    std::size_t untouched = 0;
    const Image image = rig.integrator.resolve();
    const auto states = rig.all<gpu::PixelState>(Binding::pixels);
    for (std::size_t i = 0; i < states.size(); ++i) {
        EXPECT_TRUE(std::isfinite(states[i].radius2)) << "pixel " << i;
        if (states[i].photons > 0) {
            lit += image.rgb[i].y;
            continue;
        }
        ++untouched;
        dark += std::abs(double(image.rgb[i].x)) + std::abs(double(image.rgb[i].y)) + std::abs(double(image.rgb[i].z));
    }
    EXPECT_GT(lit, 0.0);
    EXPECT_GT(untouched, 50u);
    expect_error("light of pixels that never saw a photon", dark, 0.0);
    EXPECT_EQ(rig.integrator.invalid(), 0u);
}

TEST_F(HardPhotons, NoneIsStored) {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    add_quad(scene, {-0.1, -1, -0.1}, {0, 0, 0.2}, {0.2, 0, 0}, add_material(scene, emitter(glm::vec3(1.0f))));
    std::swap(scene.triangles[2].vertex[1], scene.triangles[2].vertex[2]);
    std::swap(scene.triangles[3].vertex[1], scene.triangles[3].vertex[2]);  // away from the floor
    add_camera(scene, {0, 2, 2}, {0, 0, 0}, 0.8);
    Rig rig(scene, settings_of({16, 16}, 1024), plain_device());
    rig.integrator.run(50);
    const Report report = rig.report();
    EXPECT_EQ(report.stored_photons, 0u);
    double light = 0.0;
    for (const glm::vec3& rgb : rig.integrator.resolve().rgb) {
        light += std::abs(rgb.x) + std::abs(rgb.y) + std::abs(rgb.z);
    }
    expect_error("light of a floor on which no photon lands", light, 0.0);
    EXPECT_EQ(rig.integrator.invalid(), 0u);
}

// Pixels with radii from 1e-6 to 1 of the scene among photons whose density varies by 1e9: every count is that of all
// photons by double precision.
TEST_F(HardPhotons, RadiiThatDifferByAMillion) {
    Scene scene = floor_under_spot(1e-5);
    PunctualLight wide = scene.lights[0];
    const double narrow_flux = std::pow(1e-5, 2), wide_flux = std::pow(0.5, 2);
    wide.outer_cone = 0.5;
    wide.intensity *= float(narrow_flux / wide_flux);
    scene.lights.push_back(wide);
    Rig rig(scene, settings_of({32, 32}, 8192), plain_device());
    rig.integrator.run(1);
    auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
    auto states = rig.all<gpu::PixelState>(Binding::pixels);
    const glm::dvec3 centre = rig.flat.frame.point(glm::dvec3(0.0));
    std::mt19937 random(5);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const double radius = std::pow(10.0, -6.0 + 6.0 * double(i) / double(hits.size() - 1));
        ASSERT_EQ(hits[i].state & HIT_MASK, HIT_DIFFUSE);
        hits[i].position = glm::vec3(centre + std::min(radius, 0.3) * glm::dvec3(uniform(), 0.0, uniform()));
        states[i].radius2 = float(radius * radius);
        states[i].seeded = 1;
    }
    rig.integrator.buffer(Binding::hit_position).upload(hits);
    rig.integrator.buffer(Binding::pixels).upload(states);
    gather(rig);
    const auto photons = rig.all<gpu::Photon>(Binding::sorted);
    const auto gathered = rig.all<gpu::Gathered>(Binding::gathered);
    double differences = 0.0, counted = 0.0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        std::uint32_t want = 0, doubtful = 0;
        for (std::uint32_t p = 0; p < 8192; ++p) {
            const glm::dvec3 offset = glm::dvec3(photons[p].position) - glm::dvec3(hits[i].position);
            const double q = glm::dot(offset, offset) / double(states[i].radius2);
            want += q < 1.0 ? 1 : 0;
            doubtful += std::abs(q - 1.0) < 1e-6 ? 1 : 0;
        }
        differences += std::max(0.0, std::abs(double(gathered[i].count) - double(want)) - double(doubtful));
        counted += want;
    }
    EXPECT_GT(counted, 100.0 * double(hits.size()));
    expect_error("photons missed or gathered twice, radii from 1e-6 to 1", differences / counted, 0.0);
}

// A box of 1 m on wide ground in the sun at 45 degrees, its shadow in the middle of a picture of 4 m: asked for, it is
// sharp however wide the ground is; photons that fall all over 1 km have discs that hold no shadow, and it is said.
TEST_F(HardPhotons, OnWideGround) {
    const auto ground = [](double half) {
        Scene scene;
        add_quad(scene, {-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0},
                 add_material(scene, lambert(glm::vec3(0.5f))));
        add_box(scene, {-1.5, 0, -0.5}, {-0.5, 1, 0.5}, add_material(scene, lambert(glm::vec3(0.0f))), false);
        add_directional_light(scene, glm::normalize(glm::dvec3(1, -1, 0)), glm::vec3(3.0f));
        add_camera(scene, {0, 8, 0.001}, {0, 0, 0}, 0.5);
        return scene;
    };
    struct Case {
        double half;
        const char* direct;
        bool says;
    };
    for (const Case& c : {Case{10.0, direct_gathered, false},
                          {500.0, direct_gathered, true},
                          {10.0, direct_sampled, false},
                          {500.0, direct_sampled, false}}) {
        Settings settings = settings_of({32, 32}, 65536);
        settings.direct = c.direct;
        settings.iterations = 16;
        const Scene scene = ground(c.half);
        const Rendering got = render(scene, resolve_settings(settings, scene), plain_device());
        EXPECT_EQ(!got.warnings.empty(), c.says) << c.half << " m, " << c.direct;
        for (const std::string& line : got.warnings) {
            EXPECT_NE(line.find("photons an iteration do not suffice"), std::string::npos) << line;
        }
        if (c.says) continue;
        const auto at = [&](int x) { return double(got.image.rgb[std::size_t(16 * 32 + x)].r); };
        const double lit = 0.5 / 3.14159265 * 3.0 * std::sqrt(0.5);
        expect_error(fmt::format("a shadow on ground of {} m, {}, of what is lit", c.half, c.direct), at(15) / lit,
                     0.1);
        expect_error(fmt::format("beside it, {} m, {}", c.half, c.direct), std::abs(at(28) / lit - 1.0), 0.15);
    }
}

}  // namespace
}  // namespace vkcppm::test
