// Every scene of scenes/ with an <name>.expect.json reaches the value that its formula gives.

#include <filesystem>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/render.h"
#include "render/slices.h"
#include "scene/gltf/gltf.h"
#include "support/device/gpu.h"
#include "support/files/evidence.h"
#include "support/files/places.h"
#include "support/scenes/expectation.h"

namespace vkcppm::test {
namespace {

const std::filesystem::path scenes = source_folder() / "scenes";

std::vector<std::string> expectations() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
        const std::string name = entry.path().filename().string();
        const auto suffix = name.find(".expect.json");
        if (suffix != std::string::npos) names.push_back(name.substr(0, suffix));
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// A scene, and who brings direct light.
using NameAndWay = std::tuple<std::string, const char*>;

Settings settings_of(const nlohmann::json& expected, const char* direct) {
    Settings settings;
    settings.size = Extent{expected["size"][0], expected["size"][1]};
    settings.iterations = expected[direct]["iterations"];
    settings.photons = expected[direct]["photons"].get<std::uint32_t>();
    settings.direct = direct;
    return settings;
}

void expect_regions(const Image& image, const nlohmann::json& expected) {
    const double tolerance = expected["tolerance"];
    Image wanted = image;
    for (const auto& region : expected["regions"]) {
        glm::dvec3 sum(0.0);
        std::size_t count = 0;
        for_each_pixel(region, [&](std::uint32_t x, std::uint32_t y) {
            sum += glm::dvec3(image.at(x, y));
            ++count;
            wanted.rgb[std::size_t(y) * wanted.extent.width + x] = {region["rgb"][0], region["rgb"][1],
                                                                    region["rgb"][2]};
        });
        for (int channel = 0; channel < 3; ++channel) {
            const double want = region["rgb"][channel], got = sum[channel] / double(count);
            EXPECT_NEAR(got, want, tolerance * want)
                << region["name"] << " channel " << channel << ": ratio " << got / want << "; " << expected["formula"];
        }
    }
    if (testing::Test::HasFailure()) leave_pictures(image, wanted);
}

class ClosedForm : public GpuTest, public testing::WithParamInterface<NameAndWay> {};

TEST_P(ClosedForm, MeanRadianceOfEveryRegion) {
    const auto& [name, direct] = GetParam();
    const nlohmann::json expected = expectation_of(name);
    const Scene scene = load_gltf(scenes / expected["scene"].get<std::string>());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const Settings settings = resolve_settings(settings_of(expected, direct), scene);
    const Rendering rendering = render(scene, settings, device());
    EXPECT_TRUE(rendering.warnings.empty()) << rendering.warnings.front();

    expect_regions(rendering.image, expected);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForm,
                         testing::Combine(testing::ValuesIn(expectations()),
                                          testing::Values(direct_sampled, direct_gathered)),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param); });

class ClosedFormInSlices : public ClosedForm {};

// The same of a pilot and slices, which are rendered from the last to the first.
TEST_P(ClosedFormInSlices, MeanRadianceOfEveryRegion) {
    const auto& [name, direct] = GetParam();
    const nlohmann::json expected = expectation_of(name);
    const Scene scene = load_gltf(scenes / expected["scene"].get<std::string>());
    const auto always = [](const Progress&) { return true; };
    constexpr std::uint32_t count = 16;  // iterations of the pilot, and of a slice
    SliceRenderer renderer(scene, resolve_settings(settings_of(expected, direct), scene), device());
    PilotOfSlices pilot = renderer.render_pilot(count, always).value();
    IterationSums& sums = pilot.slice.sums;
    for (std::uint32_t end = renderer.settings().iterations; end > count; end -= count) {
        const Slice slice = renderer.render_slice(pilot.pilot, end - count, count, always).value();
        sums.iterations += count;
        for (std::size_t i = 0; i < sums.film.size(); ++i) sums.film[i] += slice.sums.film[i];
    }
    expect_regions(picture_of(sums), expected);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedFormInSlices,
                         testing::Combine(testing::Values("furnace"), testing::Values(direct_sampled, direct_gathered)),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace vkcppm::test
