// The same scene, smaller, larger, elsewhere, seen from far away, brighter, darker: the same picture. Paths get the
// same random numbers, so pictures differ by the few paths that rounding sends elsewhere.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

class SimilarScenes : public GpuTest {
protected:
    static Image picture(const Scene& scene, const std::string& estimator = "cppm", std::uint32_t photons = 4096,
                         std::uint32_t iterations = 8) {
        Settings settings;
        settings.estimator = estimator;
        settings.size = Extent{32, 24};
        settings.photons = photons;
        settings.iterations = iterations;
        return valid_picture(scene, settings, iterations);
    }

    /// Positions times `scale`, then moved. Radiance stays; what punctual lights are known by goes with the area.
    static Scene similar(Scene scene, double scale, const glm::dvec3& offset) {
        for (glm::dvec3& p : scene.positions) p = p * scale + offset;
        for (PunctualLight& light : scene.lights) {
            light.position = light.position * scale + offset;
            light.intensity = glm::vec3(glm::dvec3(light.intensity) * (scale * scale));
        }
        for (Material& material : scene.materials) material.attenuation_distance *= float(scale);
        for (Camera& camera : scene.cameras) {
            camera.to_world[3] = glm::dvec4(glm::dvec3(camera.to_world[3]) * scale + offset, 1.0);
        }
        return scene;
    }

    static Scene tinted_room() {
        Scene scene = room();
        for (Material& material : scene.materials) {
            if (material.transmission == 0.0f) continue;
            material.attenuation_color = {0.9f, 0.5f, 0.2f};
            material.attenuation_distance = 0.5f;
        }
        return scene;
    }
};

// Without the frame of the kernels (centre 0, scale 1 in make_frame) it does not end within a minute.
TEST_F(SimilarScenes, OfAnySizeAndAnywhere) {
    const Image easy = picture(tinted_room());
    const glm::dvec3 far(1e6, -1e6, 1e6);
    expect_picture("a room of 2e-4 m", picture(similar(tinted_room(), 1e-4, glm::dvec3(0.0))), easy, 0.02);
    expect_picture("a room of 2e6 m", picture(similar(tinted_room(), 1e6, glm::dvec3(0.0))), easy, 0.02);
    expect_picture("a room 1e6 m from the origin", picture(similar(tinted_room(), 1.0, far)), easy, 0.02);
    expect_picture("a room of 2e6 m, 1e12 m from the origin", picture(similar(tinted_room(), 1e6, 1e6 * far)), easy,
                   0.02);
}

// Eye rays that begin at the eye (start 0 in set_camera): 0.24.
TEST_F(SimilarScenes, SeenThroughATelescope) {
    const auto seen_from = [](double distance) {
        Scene scene = room();
        // Without the wall in front of the eye.
        std::erase_if(scene.triangles, [&](const Triangle& t) {
            return scene.positions[t.vertex[0]].z == 2.0 && scene.positions[t.vertex[1]].z == 2.0 &&
                   scene.positions[t.vertex[2]].z == 2.0;
        });
        scene.cameras.clear();
        const glm::dvec3 centre(1.0, 1.0, 1.0), towards = glm::normalize(glm::dvec3(0.13, 0.17, 1.0));
        add_camera(scene, centre + distance * towards, centre, 2.0 * std::atan(1.0 / distance));
        return scene;
    };
    expect_picture("a room seen from 2e6 m, against 2e4 m", picture(seen_from(2e6)), picture(seen_from(2e4)), 0.03);
}

// Squares of fluxes in W (flux_unit 1): 1.5 for appm at 1e-24 and 1e24, 0.036 and 0.064 for ftest.
TEST_F(SimilarScenes, LitByAnything) {
    const auto lit = [](const char* estimator, double factor) {
        Scene scene = bare_room(0.5f);
        for (Material& material : scene.materials) material.emission *= float(factor);
        return scaled(picture(scene, estimator, 1024, 20), 1.0 / factor);
    };
    // Those that keep numbers of photons alone do not see what they carry.
    for (const auto& [estimator, factors] :
         {std::pair("cppm", std::vector{1e-6, 1e6}), {"appm", {1e-6, 1e6, 1e-24, 1e24}}, {"ftest", {1e-24, 1e24}}}) {
        const Image easy = lit(estimator, 1.0);
        for (const double factor : factors) {
            expect_picture(fmt::format("lights of {:g} W m^-2 sr^-1, {}", factor, estimator), lit(estimator, factor),
                           easy, 1e-3);
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
