// Every scene of scenes/ with an <name>.expect.json reaches the value that its formula gives.

#include <filesystem>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/render.h"
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

class ClosedForm : public GpuTest, public testing::WithParamInterface<NameAndWay> {};

TEST_P(ClosedForm, MeanRadianceOfEveryRegion) {
    const auto& [name, direct] = GetParam();
    const nlohmann::json expected = expectation_of(name);
    const Scene scene = load_gltf(scenes / expected["scene"].get<std::string>());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    Settings settings;
    settings.size = Extent{expected["size"][0], expected["size"][1]};
    settings.iterations = expected[direct]["iterations"];
    settings.photons = expected[direct]["photons"].get<std::uint32_t>();
    settings.direct = direct;
    const Rendering rendering = render(scene, settings, device(), [](const Progress&) { return true; });
    EXPECT_TRUE(rendering.warnings.empty()) << rendering.warnings.front();

    const double tolerance = expected["tolerance"];
    Image wanted = rendering.image;
    for (const auto& region : expected["regions"]) {
        glm::dvec3 sum(0.0);
        std::size_t count = 0;
        for_each_pixel(region, [&](std::uint32_t x, std::uint32_t y) {
            sum += glm::dvec3(rendering.image.at(x, y));
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
    if (HasFailure()) leave_pictures(rendering.image, wanted);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForm,
                         testing::Combine(testing::ValuesIn(expectations()),
                                          testing::Values(direct_sampled, direct_gathered)),
                         [](const auto& info) { return std::get<0>(info.param) + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace vkcppm::test
