// How many light paths an iteration are taken for a scene.

#include <bit>

#include "render/light_paths.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

class LightPaths : public GpuTest {
protected:
    static std::uint32_t of(const char* name, const Settings& settings) {
        const Scene scene = project_scene(name);
        const Settings resolved = resolve_settings(settings, scene);
        const FlatScene flat = flatten(scene);
        const SceneOnDevice on_device(device(), flat);
        return light_paths(on_device, scene.cameras.at(0), resolved);
    }
};

TEST_F(LightPaths, ArePowersOfTwoThatGrowWithThePicture) {
    std::uint32_t before = 0;
    for (const Extent size : {Extent{64, 48}, Extent{256, 192}, Extent{1024, 768}}) {
        Settings settings;
        settings.size = size;
        const std::uint32_t paths = of("cornell", settings);
        EXPECT_TRUE(std::has_single_bit(paths)) << paths;
        EXPECT_GT(paths, before) << size.width << "x" << size.height;
        before = paths;
    }
}

TEST_F(LightPaths, AreFewerWhereEachIsLongAndStoresMany) {
    Settings settings;
    settings.size = Extent{200, 150};
    EXPECT_LT(of("box", settings), of("torus", settings));
}

TEST_F(LightPaths, DoNotHangOnTheSeedNorOnTheChannels) {
    Settings settings;
    settings.size = Extent{100, 75};
    const std::uint32_t paths = of("caustic", settings);
    settings.seed = 77;
    settings.aovs = true;
    EXPECT_EQ(of("caustic", settings), paths);
}

TEST_F(LightPaths, AreTheUsualNumberWherePhotonsBringDirectLight) {
    Settings settings;
    settings.size = Extent{100, 75};
    settings.direct = direct_gathered;
    EXPECT_EQ(of("caustic", settings), usual_light_paths);
}

}  // namespace
}  // namespace vkcppm::test
