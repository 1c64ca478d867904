// The layers of a picture: what each holds where it is known, and the same by both ways to bring direct light, which
// find most of it by other paths.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/sums.h"
#include "support/device/rig.h"
#include "support/scenes/materials.h"
#include "support/scenes/rooms.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

using Channels = std::map<std::string, std::vector<float>>;

const std::vector<std::string> layers{"direct", "caustic", "rest"};

double mean_of(const Channels& channels, const std::string& name) {
    double sum = 0.0;
    for (const float value : channels.at(name)) sum += value;
    return sum / double(channels.at(name).size());
}

Settings settings_of(Extent size) {
    Settings settings;
    settings.size = size;
    settings.photons = 16384;
    settings.aovs = true;
    return settings;
}

class Layers : public GpuTest {};

TEST_F(Layers, SumToThePicture) {
    Rig rig(project_scene("caustic"), settings_of({32, 24}));
    rig.integrator.run(4);
    const Image image = rig.integrator.resolve();
    const Channels channels = rig.integrator.aovs();
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (const std::string& layer : layers) sum += channels.at(layer + "." + "RGB"[c])[i];
            EXPECT_NEAR(sum, image.rgb[i][c], 1e-6 * (1.0 + image.rgb[i][c])) << "pixel " << i << ", channel " << c;
        }
    }
}

// Reciprocals of areas are unbiased and may be negative (kernels/area.comp), and so may be a sum of few of them.
TEST_F(Layers, SumToNothingWhereNoiseLeavesThePictureBelowIt) {
    Rig rig(project_scene("point_plane"), settings_of({4, 4}));
    rig.integrator.run(1);
    auto film = rig.all<gpu::Film>(Binding::film);
    film.at(5).sum = {-0.25f, std::nanf(""), 0.5f};
    rig.integrator.buffer(Binding::film).upload(film);
    const glm::vec3 pixel = rig.integrator.resolve().rgb.at(5);
    EXPECT_EQ(pixel.x, 0.0f);
    EXPECT_TRUE(std::isnan(pixel.y));
    EXPECT_EQ(pixel.z, 0.5f);
    const glm::vec3 merged = picture_of(rig.integrator.sums()).rgb.at(5);
    EXPECT_EQ(merged.x, 0.0f);
    EXPECT_TRUE(std::isnan(merged.y));
    EXPECT_EQ(merged.z, 0.5f);
    const Channels channels = rig.integrator.aovs();
    double sum = 0.0;
    for (const std::string& layer : layers) sum += channels.at(layer + ".R")[5];
    EXPECT_NEAR(sum, 0.0, 1e-6);
}

TEST_F(Layers, OfAPlaneUnderAPointLightIsDirectAlone) {
    for (const char* direct : {direct_sampled, direct_gathered}) {
        Settings settings = settings_of({16, 16});
        settings.direct = direct;
        Rig rig(project_scene("point_plane"), settings);
        rig.integrator.run(8);
        const Image image = rig.integrator.resolve();
        const Channels channels = rig.integrator.aovs();
        for (std::size_t i = 0; i < image.rgb.size(); ++i) {
            EXPECT_NEAR(channels.at("direct.G")[i], image.rgb[i].g, 1e-5 * image.rgb[i].g) << direct << ", pixel " << i;
            EXPECT_EQ(channels.at("caustic.G")[i], 0.0f) << direct << ", pixel " << i;
        }
    }
}

// A closed sphere that emits Le and reflects rho: Le is seen, rho Le has come straight, the rest is rho^2 Le / (1 -
// rho).
TEST_F(Layers, OfAFurnace) {
    constexpr double rho[] = {0.3, 0.5, 0.7}, emitted[] = {0.35, 0.3, 0.3};
    Rig rig(project_scene("furnace"), settings_of({16, 16}));
    rig.integrator.run(24);
    const Channels channels = rig.integrator.aovs();
    for (int c = 0; c < 3; ++c) {
        const std::string channel = std::string(".") + "RGB"[c];
        const double direct = (1.0 + rho[c]) * emitted[c], rest = rho[c] * rho[c] * emitted[c] / (1.0 - rho[c]);
        EXPECT_NEAR(mean_of(channels, "direct" + channel), direct, 0.005 * direct);
        EXPECT_NEAR(mean_of(channels, "rest" + channel), rest, 0.01 * rest);
        EXPECT_EQ(mean_of(channels, "caustic" + channel), 0.0);
    }
}

// A ball of glass on a floor of rough plastic before a rough mirror: every way to bring light has its share in every
// layer. Means of independent renders: two-sided, at five standard errors of their difference.
TEST_F(Layers, AreTheSameWhoeverBringsDirectLight) {
    Scene scene = make_room();
    scene.materials[2] = glass(1.5f);
    scene.materials[1].specular = 1.0f;
    scene.materials[1].roughness = 0.3f;
    scene.materials[3].metallic = 1.0f;
    scene.materials[3].roughness = 0.2f;
    constexpr int renders = 6;
    std::map<std::string, std::vector<double>> means[2];
    for (int way = 0; way < 2; ++way) {
        for (int r = 0; r < renders; ++r) {
            Settings settings = settings_of({32, 24});
            settings.direct = way == 0 ? direct_sampled : direct_gathered;
            settings.seed = std::uint32_t(1 + renders * way + r);
            Rig rig(scene, settings, plain_device());
            rig.integrator.run(12);
            const Channels channels = rig.integrator.aovs();
            for (const std::string& layer : layers) means[way][layer].push_back(mean_of(channels, layer + ".G"));
        }
    }
    for (const std::string& layer : layers) {
        double mean[2] = {}, variance = 0.0;
        for (int way = 0; way < 2; ++way) {
            for (const double m : means[way][layer]) mean[way] += m / renders;
            for (const double m : means[way][layer])
                variance += (m - mean[way]) * (m - mean[way]) / (renders - 1.0) / renders;
        }
        // What remains of the kernels' bias after so few iterations: light leaks about edges into other pixels alone.
        const double allowed = 5.0 * std::sqrt(variance) + 0.005 * mean[0];
        EXPECT_NEAR(mean[0], mean[1], allowed) << layer;
        EXPECT_GT(mean[0], 0.001) << layer << ": nothing to compare";
    }
}

}  // namespace
}  // namespace vkcppm::test
