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
    EXPECT_EQ(channels.size(), 23u);

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
        EXPECT_EQ(at("A"), 1.0f) << "pixel " << i;
        EXPECT_EQ(at("ppm.iterations"), iterations);
        EXPECT_GT(at("ppm.radius"), 0.0);
        EXPECT_LT(at("ppm.radius"), 0.2 * rig.flat.radius / rig.flat.frame.scale);
        EXPECT_NEAR(at("ppm.batch"), 10.0 * std::pow(1.2, at("ppm.rejections")), 1e-3 * at("ppm.batch"));
        seeded += at("ppm.photons") >= 9.0f && at("ppm.statistic") > 0.0f ? 1 : 0;
    }
    EXPECT_GT(seeded, 1000u) << "pixels that saw photons and were tested";
}

TEST_F(Aovs, AlphaIsTheShareOfThePixelThatASurfaceCovers) {
    Settings settings;
    settings.size = Extent{32, 24};
    settings.photons = 64;
    settings.aovs = true;
    Scene scene = project_scene("point_plane");
    glm::dvec3 centre(0.0);
    for (const glm::dvec3& p : scene.positions) centre += p / double(scene.positions.size());
    for (glm::dvec3& p : scene.positions) p = glm::mix(centre, p, 0.3);
    constexpr std::uint32_t iterations = 64;
    Rig rig(std::move(scene), settings);
    rig.integrator.run(iterations);
    const std::vector<float> alpha = rig.integrator.aovs().at("A");
    double got = 0.0, want = 0.0;
    std::uint32_t none = 0, all = 0;
    for (std::uint32_t i = 0; i < rig.pixels(); ++i) {
        constexpr int side = 16;
        double covered = 0.0;
        for (int s = 0; s < side * side; ++s) {
            const double x = i % 32 + (s % side + 0.5) / side, y = i / 32 + (s / side + 0.5) / side;
            const auto ray = oracle::camera_ray(rig.scene.cameras[0], *settings.size, x, y);
            covered += oracle::nearest_hit(rig.scene, ray) ? 1.0 / (side * side) : 0.0;
        }
        // Five standard deviations of as many points at random.
        EXPECT_NEAR(alpha[i], covered, 5.0 * std::sqrt(covered * (1.0 - covered) / iterations) + 0.02) << "pixel " << i;
        none += covered == 0.0 ? 1 : 0;
        all += covered == 1.0 ? 1 : 0;
        got += alpha[i] / rig.pixels();
        want += covered / rig.pixels();
    }
    EXPECT_GT(none, 50u);
    EXPECT_GT(all, 50u);
    EXPECT_NEAR(got, want, 2e-3);
}

}  // namespace
}  // namespace vkcppm::test
