// The further channels of a picture on a lit plane, where every one of them is known.

#include <algorithm>
#include <cmath>

#include "oracle/path_tracer.h"
#include "support/device/rig.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

class Aovs : public GpuTest {};

TEST_F(Aovs, OfALitPlane) {
    Settings settings;
    settings.size = Extent{32, 32};
    settings.photons = 16384;
    settings.aovs = true;
    settings.direct = direct_gathered;  // photons at the first surface
    constexpr std::uint32_t iterations = 32;
    Rig rig(project_scene("point_plane"), settings);
    rig.integrator.run(iterations);
    const auto channels = rig.integrator.aovs();
    EXPECT_EQ(channels.size(), 22u);

    const Camera& camera = rig.scene.cameras[0];
    const glm::dvec3 axis = -glm::dvec3(camera.to_world[2]);
    const glm::vec3 albedo = rig.scene.materials.at(rig.scene.triangles.at(0).material).base_color;
    std::uint32_t seeded = 0;
    for (std::uint32_t i = 0; i < rig.pixels(); ++i) {
        const auto at = [&](const char* name) { return channels.at(name)[i]; };
        const oracle::Ray ray = oracle::camera_ray(camera, *settings.size, i % 32 + 0.5, i / 32 + 0.5);
        const auto hit = oracle::nearest_hit(rig.scene, ray);
        ASSERT_TRUE(hit);
        const double depth = hit->t * glm::dot(glm::dvec3(ray.direction), axis);
        // The mean over points of the pixel against its centre.
        EXPECT_NEAR(at("Z"), depth, 0.01 * depth) << "pixel " << i;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(channels.at(std::string("Albedo.") + "RGB"[c])[i], albedo[c], 1e-5) << "pixel " << i;
            EXPECT_NEAR(channels.at(std::string("N.") + "XYZ"[c])[i], c == 1 ? 1.0 : 0.0, 1e-4) << "pixel " << i;
        }
        EXPECT_EQ(at("ppm.iterations"), iterations);
        EXPECT_GT(at("ppm.radius"), 0.0);
        EXPECT_LT(at("ppm.radius"), 0.2 * rig.flat.radius / rig.flat.frame.scale);
        EXPECT_NEAR(at("ppm.batch"), 10.0 * std::pow(1.2, at("ppm.rejections")), 1e-3 * at("ppm.batch"));
        seeded += at("ppm.photons") >= 9.0f && at("ppm.statistic") > 0.0f ? 1 : 0;
    }
    EXPECT_GT(seeded, 1000u) << "pixels that saw photons and were tested";
}

}  // namespace
}  // namespace vkcppm::test
