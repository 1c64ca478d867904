// Compiled kernels of an earlier run.

#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "app/pipeline_cache.h"
#include "render/render.h"
#include "support/device/gpu.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/files/variable.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::size_t header = 32;  // bytes that what a driver gives begins with; lavapipe of Mesa 26.2 gives 20 in all

Rendering tiny_render(Device& on) {
    Settings settings;
    settings.size = Extent{8, 8};
    settings.photons = 256;
    settings.iterations = 2;
    const Scene scene = room();
    return render(scene, resolve_settings(settings, scene), on);
}

/// Whether both pictures have the same bits.
bool same(const Image& a, const Image& b) {
    return a.rgb.size() == b.rgb.size() &&
           std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(a.rgb[0])) == 0;
}

class Pipelines : public GpuTest {
protected:
    Device fresh_{Device::Options{.select = "", .validate = false}};
};

TEST_F(Pipelines, ThoseOfAnotherRunGiveTheSamePicture) {
    const Image first = tiny_render(fresh_).image;
    const std::vector<std::byte> kept = fresh_.pipelines();
    if (kept.size() < header) GTEST_SKIP() << "the driver gives " << kept.size() << " bytes, less than a header";
    Device again({.select = "", .validate = false});
    EXPECT_TRUE(again.reuse_pipelines(kept));
    EXPECT_TRUE(same(tiny_render(again).image, first));
    RecordProperty("bytes kept", int(kept.size()));
}

TEST_F(Pipelines, ThoseOfAnotherDriverAreRefused) {
    const std::vector<std::byte> kept = fresh_.pipelines();
    if (kept.size() < header) GTEST_SKIP() << "the driver gives " << kept.size() << " bytes, less than a header";
    for (std::size_t i = 0; i < header; ++i) {
        std::vector<std::byte> foreign = kept;
        foreign[i] ^= std::byte(1);
        EXPECT_FALSE(fresh_.reuse_pipelines(foreign)) << "byte " << i << " of the header";
        EXPECT_FALSE(fresh_.reuse_pipelines(std::span(kept).first(i))) << i << " bytes";
    }
    EXPECT_GT(tiny_render(fresh_).report.rays, 0u);
}

TEST_F(Pipelines, AFileThatIsDamagedOrCannotBeMadeIsNoError) {
    const TemporaryFolder folder;
    const Variable cache_home("XDG_CACHE_HOME", folder.path().c_str());
    const auto file = *pipeline_file(fresh_.info());
    std::filesystem::create_directories(file.parent_path());
    for (const std::string& text : {std::string("rubbish"), sealed({}), sealed(std::vector<std::byte>(100))}) {
        std::ofstream(file, std::ios::binary) << text;
        Device fresh({.select = "", .validate = false});  // which has compiled nothing
        const PipelineCache cache(fresh, true);
        EXPECT_GT(tiny_render(fresh).report.rays, 0u);
    }
    std::ofstream(folder / "a file") << "";
    const Variable no_folder("XDG_CACHE_HOME", (folder / "a file").c_str());
    { const PipelineCache cache(fresh_, true); }
}

TEST_F(Pipelines, AreWrittenWhereTheDriverKeepsAny) {
    const TemporaryFolder folder;
    const Variable cache_home("XDG_CACHE_HOME", folder.path().c_str());
    const auto file = *pipeline_file(fresh_.info());
    {
        const PipelineCache off(fresh_, false);
        tiny_render(fresh_);
    }
    EXPECT_FALSE(std::filesystem::exists(file)) << "the cache is off";
    { const PipelineCache on(fresh_, true); }
    const std::vector<std::byte> kept = fresh_.pipelines();
    ASSERT_EQ(std::filesystem::exists(file), kept.size() > 32) << kept.size() << " bytes are kept";
    if (kept.size() > 32) {
        EXPECT_EQ(unsealed(read_bytes(file)), kept);
    }
}

}  // namespace
}  // namespace vkcppm::test
