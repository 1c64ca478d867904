// Glass: at grazing angles, where all light is reflected, within other glass, against other surfaces, round eye and
// light.

#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "oracle/fresnel.h"
#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

class Dielectrics : public GpuTest {
protected:
    static Image picture(const Scene& scene, std::uint32_t iterations = 16, std::uint32_t photons = 4096,
                         Extent size = {24, 24}) {
        Settings settings;
        settings.size = size;
        settings.photons = photons;
        settings.max_depth = 200;
        return valid_picture(scene, settings, iterations);
    }

    static Environment white_sky() { return {{1, 1}, {glm::vec3(1.0f)}}; }

    /// The largest deviation of a channel from `value`, relative.
    static double deviation(const Image& image, double value) {
        double worst = 0.0;
        for (const glm::vec3& rgb : image.rgb) {
            for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(rgb[c]) / value - 1.0));
        }
        return std::isnan(worst) ? 1.0 : worst;
    }
};

// Nothing absorbs and light comes from everywhere: nothing can be seen, least of all where Fresnel's terms are 0 / 0.
// Where no case is made of total reflection: 0.31 for the plate, 0.062 for nested glasses.
TEST_F(Dielectrics, VanishUnderAWhiteSky) {
    const auto under_sky = [](const std::function<void(Scene&)>& add, const glm::dvec3& eye, const glm::dvec3& target) {
        Scene scene;
        add(scene);
        scene.environment = white_sky();
        add_camera(scene, eye, target, 0.5);
        return scene;
    };
    const auto ball = [](Scene& s) { add_sphere(s, glm::dvec3(0.0), 1.0, 4, add_material(s, glass(1.5f)), true); };
    const auto plate = [](Scene& s) { add_box(s, {-1, -0.01, -1}, {1, 0, 1}, add_material(s, glass(1.5f)), false); };
    const auto mirror = [](Scene& s) {
        add_box(s, {-1, -0.01, -1}, {1, 0, 1}, add_material(s, test::mirror(glm::vec3(1.0f))), false);
    };
    // Its lobe is narrower than directions are known; evaluated as one (lobe_width) all is dropped: 1.
    const auto narrow = [](Scene& s) {
        add_box(s, {-1, -0.01, -1}, {1, 0, 1}, add_material(s, test::mirror(glm::vec3(1.0f))), false);
        s.materials.back().roughness = 1e-10f;
    };
    const auto nested = [](Scene& s) {
        add_sphere(s, glm::dvec3(0.0), 1.0, 4, add_material(s, glass(1.5f)), true);
        add_sphere(s, glm::dvec3(0.0), 0.7, 4, add_material(s, glass(1.33f)), true);
        add_sphere(s, glm::dvec3(0.0), 0.3, 4, add_material(s, glass(1.7f)), true);
    };
    expect_error("a glass ball under a white sky", deviation(picture(under_sky(ball, {0, 0, 4}, {0, 0, 0})), 1.0),
                 1e-4);
    expect_error("glass plate at 1e-5 rad under a white sky",
                 deviation(picture(under_sky(plate, {0, 1e-5, 2}, {0, 0, 0})), 1.0), 1e-4);
    expect_error("mirror at 1e-5 rad under a white sky",
                 deviation(picture(under_sky(mirror, {0, 1e-5, 2}, {0, 0, 0})), 1.0), 1e-4);
    expect_error("metal of roughness 1e-10 under a white sky",
                 deviation(picture(under_sky(narrow, {0, 1, 2}, {0, 0, 0})), 1.0), 1e-4);
    expect_error("three nested glasses under a white sky",
                 deviation(picture(under_sky(nested, {0, 0, 4}, {0, 0, 0})), 1.0), 1e-4);
}

// Radiance within glass is n^2 times that outside.
TEST_F(Dielectrics, RoundTheEye) {
    Scene scene;
    add_sphere(scene, glm::dvec3(0.0), 1.0, 4, add_material(scene, glass(1.5f)), true);
    scene.environment = white_sky();
    add_camera(scene, {0, 0, 0}, {0, 0, -1}, 0.8);
    expect_error("an eye within a glass ball, against n^2", deviation(picture(scene), 2.25), 1e-4);
}

// From the middle of a ball all light leaves it, straight on, however often it is reflected before.
TEST_F(Dielectrics, RoundALight) {
    const auto lit = [](bool with_ball) {
        Scene scene;
        add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambert(glm::vec3(0.2f))));
        if (with_ball) add_sphere(scene, {0, 1, 0}, 0.05, 4, add_material(scene, glass(1.5f)), true);
        add_point_light(scene, {0, 1, 0}, glm::vec3(1.0f));
        add_camera(scene, {0, 2.5, 2.5}, {0, 0, 0}, 0.8);
        return scene;
    };
    expect_error("a light within a glass ball, against none", mean_difference(picture(lit(true)), picture(lit(false))),
                 0.03);
}

// No path from the eye can find the light: photons alone bring it, and eye paths have to go through the glass to meet
// them. The floor is nearly black, so that little comes back from the glass.
TEST_F(Dielectrics, BetweenADeltaLightAndAFloorSeenThroughIt) {
    const auto seen = [](bool with_glass) {
        Scene scene;
        add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.02f))));
        if (with_glass) add_box(scene, {-1, 0.2, -1}, {1, 0.201, 1}, add_material(scene, glass(1.5f)), false);
        add_point_light(scene, {0.1, 3.0, 0.0}, glm::vec3(10.0f));
        add_camera(scene, {0, 2.0, 0.001}, {0, 0, 0}, 0.4);
        return scene;
    };
    constexpr Extent size{16, 16};
    const Image through = picture(seen(true), 64, 16384, size), plain = picture(seen(false), 64, 16384, size);
    // Both sides of a plate, all reflections between them: (1 - R) / (1 + R); angles differ by less than 0.2 rad from
    // 0.
    const double reflectance = 0.04, plate = (1.0 - reflectance) / (1.0 + reflectance);
    expect_error("a delta light through glass, floor seen through glass",
                 mean_difference(through, scaled(plain, plate * plate)), 0.01);
}

// Rounding decides what lies behind a face without part_touching_faces: 0.29, 0.35 and 0.87.
TEST_F(Dielectrics, TouchingOtherSurfaces) {
    const auto block_on_floor = [](double gap) {
        Scene scene;
        // Tilted, so that its plane is one of rounded coordinates.
        add_quad(scene, {-1, 0.1, -1}, {0, 0.3, 2}, {2, 0, 0}, add_material(scene, lambert({0.7f, 0.5f, 0.3f})));
        const std::uint32_t glass = add_material(scene, test::glass(1.5f));
        const glm::dvec3 along = glm::normalize(glm::dvec3(0, 0.3, 2)), up = glm::normalize(glm::dvec3(0, 2, -0.3));
        const glm::dvec3 corner = glm::dvec3(0, 0.1, -1) + 0.6 * along + gap * up, x(0.7, 0, 0), z = 0.8 * along,
                         y = 0.4 * up;
        add_quad(scene, corner, x, z, glass);
        add_quad(scene, corner + y, z, x, glass);
        add_quad(scene, corner, z, y, glass);
        add_quad(scene, corner + x, y, z, glass);
        add_quad(scene, corner, y, x, glass);
        add_quad(scene, corner + z, x, y, glass);
        add_quad(scene, {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(glm::vec3(4.0f))));
        add_camera(scene, {0.3, 1.6, 1.4}, {0.3, 0.3, 0.0}, 0.8);
        return scene;
    };
    expect_picture("a glass block on the floor, against 1e-4 above it", picture(block_on_floor(0.0)),
                   picture(block_on_floor(1e-4)), 0.03);
    const auto two_plates = [](double gap) {
        Scene scene;
        add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert({0.3f, 0.5f, 0.7f})));
        const std::uint32_t glass = add_material(scene, test::glass(1.5f)),
                            water = add_material(scene, test::glass(1.33f));
        add_box(scene, {-0.6, 0.13, -0.6}, {0.6, 0.37, 0.6}, glass, false);
        add_box(scene, {-0.6, 0.37 + gap, -0.6}, {0.6, 0.61 + gap, 0.6}, water, false);
        add_quad(scene, {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(glm::vec3(4.0f))));
        add_camera(scene, {0.0, 1.7, 1.0}, {0, 0.2, 0.0}, 0.7);
        return scene;
    };
    expect_picture("water on glass, against 1e-4 into it", picture(two_plates(0.0)), picture(two_plates(-1e-4)), 0.05);
    const auto filled = [](double gap) {
        Scene scene;
        add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert({0.3f, 0.5f, 0.7f})));
        const std::uint32_t glass = add_material(scene, test::glass(1.5f)),
                            water = add_material(scene, test::glass(1.33f));
        add_sphere(scene, glm::dvec3(0.0), 0.6, 3, glass, true);
        const std::size_t cavity = scene.triangles.size();
        add_sphere(scene, glm::dvec3(0.0), 0.5, 3, glass, true);
        for (std::size_t i = cavity; i < scene.triangles.size(); ++i) {
            std::swap(scene.triangles[i].vertex[1], scene.triangles[i].vertex[2]);
            for (const std::uint32_t v : scene.triangles[i].vertex) scene.normals[v] = -scene.normals[v];
        }
        add_sphere(scene, glm::dvec3(0.0), 0.5 - gap, 3, water, true);
        add_quad(scene, {-0.5, 2, -0.5}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(glm::vec3(4.0f))));
        add_camera(scene, {0.0, 1.5, 1.0}, {0, 0, 0.0}, 0.7);
        return scene;
    };
    expect_picture("a glass filled to its wall, against 1e-4 into it", picture(filled(0.0)), picture(filled(-1e-4)),
                   0.02);
}

}  // namespace
}  // namespace vkcppm::test
