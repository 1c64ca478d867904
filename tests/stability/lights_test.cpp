// Lights that are small, narrow, beyond floats, or in a small part of a large scene.

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

class HardLights : public GpuTest {
protected:
    static Image picture(const Scene& scene, std::uint32_t iterations = 16, std::uint32_t photons = 8192) {
        Settings settings;
        settings.size = Extent{16, 16};
        settings.photons = photons;
        return valid_picture(scene, settings, iterations);
    }

    /// A floor of 2 m under a square lamp of that side, which sends out the same flux whatever its side.
    static Scene under_lamp(double side) {
        Scene scene;
        add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
        add_quad(scene, {-0.5 * side, 1, -0.5 * side}, {side, 0, 0}, {0, 0, side},
                 add_material(scene, emitter(glm::vec3(float(1.0 / (side * side))))));
        add_camera(scene, {0, 3, 1.5}, {0, 0, 0}, 0.5);
        return scene;
    }

    /// Corners far away, so that the scene's radius is `radius`.
    static Scene with_corner(Scene scene, double radius) {
        const std::uint32_t black = add_material(scene, lambert(glm::vec3(0.0f)));
        for (const double side : {-1.0, 1.0}) {
            const glm::dvec3 corner = glm::dvec3(0.577, -0.577, 0.577) * (side * radius);
            add_triangle(scene, corner, corner - glm::dvec3(side, 0, 0), corner - glm::dvec3(0, 0, side), black);
        }
        return scene;
    }
};

// Normals by normalize(cross(e1, e2)), whose squared length leaves floats in the large scene: 0.096 there.
TEST_F(HardLights, OfSmallArea) {
    const Image easy = picture(under_lamp(1e-3));
    expect_picture("a light of 1e-8 m^2, against 1e-6 m^2", picture(under_lamp(1e-4)), easy, 0.03);
    expect_picture("a light of 1e-16 m^2", picture(under_lamp(1e-8)), easy, 0.03);
    expect_picture("a light of 1e-16 m^2 in a scene of 1e3 m, against 1e-6 m^2 there",
                   picture(with_corner(under_lamp(1e-8), 1e3)), picture(with_corner(under_lamp(1e-3), 1e3)), 0.03);
}

// Of cones below 1e-3 rad the cosines are 1 but for their last bits. With cosines in place of versines: 1 and 1, all
// photons on the axis.
TEST_F(HardLights, OfNarrowCones) {
    for (const double cone : {1e-2, 1e-4, 1e-6}) {
        Scene scene;
        add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
        add_spot_light(scene, {0, 1, 0}, {0, -1, 0}, cone, glm::vec3(1.0f));
        add_camera(scene, {0, 3, 0.01}, {0, 0, 0}, 0.5);
        Settings settings;
        settings.size = Extent{4, 4};
        settings.photons = 16384;
        settings.direct = direct_gathered;  // photons are looked at
        Rig rig(scene, settings, plain_device());
        rig.integrator.run(1);
        const auto photons = rig.all<gpu::Photon>(Binding::sorted);
        const glm::dvec3 centre = rig.flat.frame.point(glm::dvec3(0.0));
        double sum = 0.0;
        for (std::uint32_t i = 0; i < *settings.photons; ++i) {
            const glm::dvec3 offset = (glm::dvec3(photons[i].position) - centre) / rig.flat.frame.length(1.0);
            sum += offset.x * offset.x + offset.z * offset.z;
        }
        // With an inner cone of 0 the density falls as (1 - v / v_o)^2 over versines v < v_o = cone^2 / 2: E[v] = v_o /
        // 4, and r^2 = 2 v on the floor.
        const double want = cone * cone / 4.0;
        expect_error(fmt::format("mean square radius of a spot of {:g} rad", cone),
                     std::abs(sum / *settings.photons / want - 1.0), cone < 1e-5 ? 0.1 : 0.03);
    }
}

// The lamp's flux is beyond floats.
TEST_F(HardLights, BeyondFloatsAreCountedAndReported) {
    Scene scene = under_lamp(1.0);
    scene.materials.back().emission = glm::vec3(3e38f);
    Settings settings;
    settings.size = Extent{16, 16};
    settings.photons = 1024;
    settings.iterations = 2;
    settings.direct = direct_gathered;  // the sum of photons is beyond floats, what a light sends to a point is not
    const Rendering rendering = render(scene, resolve_settings(settings, scene), device());
    std::size_t bad = 0;
    for (const glm::vec3& rgb : rendering.image.rgb) {
        for (int c = 0; c < 3; ++c) bad += std::isfinite(rgb[c]) ? 0 : 1;
    }
    expect_error("values of the film that are no numbers, light of 3e38", double(bad), 0.0);
    ASSERT_EQ(rendering.warnings.size(), 1u);
    EXPECT_NE(rendering.warnings[0].find("not finite"), std::string::npos) << rendering.warnings[0];

    // Whatever makes them, in any quantity of the path.
    Rig rig(under_lamp(1.0), settings);
    gpu::Params params = rig.integrator.params();
    params.right.x = std::numeric_limits<float>::quiet_NaN();
    rig.integrator.set_params(params);
    rig.integrator.run(1);
    EXPECT_EQ(rig.integrator.invalid(), rig.pixels()) << "eye rays without a direction";
    for (const glm::vec3& rgb : rig.integrator.resolve().rgb) EXPECT_EQ(rgb, glm::vec3(0.0f));
}

}  // namespace
}  // namespace vkcppm::test
