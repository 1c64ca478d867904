// What a render takes, told before it is there, is what it then has; and what cannot fit is refused with a size that
// does.

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "flat/flatten.h"
#include "render/memory.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/rooms.h"
#include "support/scenes/shapes.h"
#include "support/thrown.h"

namespace vkcppm::test {
namespace {

class Memory : public GpuTest {};

void expect_told(const Scene& scene, const Settings& settings, std::uint64_t most_band_pixels = 0) {
    Rig rig(scene, settings, plain_device(), most_band_pixels);
    const Report report = rig.report();
    const std::vector<MemoryReport> told = memory_needed(rig.flat, rig.settings, plain_device());
    ASSERT_EQ(told.size(), report.memory.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
        const MemoryReport &want = report.memory[i], &got = told[i];
        EXPECT_EQ(got.of, want.of);
        if (want.of == "rest") continue;  // buffers of thresholds, which are uploaded
        // Buffers are whole texels.
        EXPECT_NEAR(double(got.count), double(want.count), 16.0) << want.of;
        EXPECT_NEAR(double(got.bytes), double(want.bytes), 16.0 * 16.0) << want.of;
    }
}

TEST_F(Memory, IsToldBeforeItIsThere) {
    for (const char* estimator : {"cppm", "ftest", "appm"}) {
        Settings settings;
        settings.estimator = estimator;
        settings.size = Extent{64, 48};
        settings.photons = 3000;
        settings.aovs = true;
        expect_told(room(), settings);
    }
    for (const Case& change : material_cases()) {
        SCOPED_TRACE(change.name);
        Scene scene = make_room();
        Settings settings;
        settings.size = Extent{32, 32};
        settings.photons = 1000;
        change.change(scene, settings);
        expect_told(scene, settings);
    }
}

TEST_F(Memory, ThatIsNotThereIsRefusedWithASizeThatFits) {
    const Scene scene = room();
    Settings settings;
    settings.size = Extent{65536, 32768};
    const auto error = thrown_by([&] { check_memory(scene, resolve_settings(settings, scene), plain_device()); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::out_of_device_memory);
    const std::string text = error->what();
    const std::size_t at = text.find("--size ");
    ASSERT_NE(at, std::string::npos) << text;
    Extent fits;
    ASSERT_EQ(std::sscanf(text.c_str() + at, "--size %ux%u would fit", &fits.width, &fits.height), 2) << text;
    fits = {fits.width * 9 / 10, fits.height * 9 / 10};  // memory comes and goes
    settings.size = fits;
    EXPECT_FALSE(thrown_by([&] { check_memory(scene, resolve_settings(settings, scene), plain_device()); })) << text;
}

TEST_F(Memory, ThatImagesDoNotFitIsToldFromTheirSizes) {
    Scene scene = room();
    const std::uint64_t most = device().largest_buffer(bound_buffer(Binding::images).access);
    const TextureImage large{"large", {16384, 16384}, {}};  // without a texel
    if (most / 4 / large.size.pixels() > 64) GTEST_SKIP() << "the device takes buffers of " << most << " bytes";
    while (scene.images.size() * 4 * large.size.pixels() <= most) scene.images.push_back(large);
    const auto error = thrown_by([&] { check_memory(scene, resolve_settings({}, scene), device()); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::out_of_device_memory);
    EXPECT_NE(std::string(error->what()).find("images need a buffer of"), std::string::npos) << error->what();
}

}  // namespace
}  // namespace vkcppm::test
