// A few small pictures as they were when somebody last looked at them. The tolerance is a relMSE far below the noise of
// another seed (about 1e-2) and above what another driver's rounding does to single paths.

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/metrics.h"
#include "io/exr.h"
#include "io/png.h"
#include "support/device/rig.h"
#include "support/files/places.h"
#include "support/names.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

const std::filesystem::path folder = source_folder() / "tests" / "golden";

std::vector<nlohmann::json> cases() {
    std::ifstream file(folder / "golden.json");
    return nlohmann::json::parse(file).get<std::vector<nlohmann::json>>();
}

std::string name_of(const nlohmann::json& golden) {
    return golden["scene"].get<std::string>() + "_" + golden["estimator"].get<std::string>();
}

class Golden : public GpuTest, public testing::WithParamInterface<nlohmann::json> {};

Image absolute_difference(const Image& a, const Image& b) {
    Image difference = a;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) difference.rgb[i] = glm::abs(a.rgb[i] - b.rgb[i]);
    return difference;
}

TEST_P(Golden, Picture) {
    const nlohmann::json& golden = GetParam();
    const std::string name = name_of(golden);
    Settings settings;
    settings.estimator = golden["estimator"];
    settings.size = Extent{golden["size"][0], golden["size"][1]};
    settings.iterations = golden["iterations"];
    settings.photons = golden["photons"];
    Rig rig(project_scene(golden["scene"]), settings);
    rig.integrator.run(settings.iterations);
    const Image image = rig.integrator.resolve();
    const Image reference = read_exr(folder / (name + ".exr"));
    const Comparison found = compare(image, reference);
    EXPECT_LE(found.relmse.all, golden["tolerance"].get<double>());
    if (HasFailure()) {
        const auto written = std::filesystem::temp_directory_path() / ("golden_" + name);
        write_exr(written.string() + ".exr", image);
        write_png(written.string() + ".png", image, 0.0f);
        write_png(written.string() + "_reference.png", reference, 0.0f);
        write_png(written.string() + "_difference.png", absolute_difference(image, reference), 0.0f);
        ADD_FAILURE() << "wrote " << written.string() << ".exr, .png, _reference.png and _difference.png";
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(cases()),
                         [](const auto& info) { return identifier(name_of(info.param)); });

}  // namespace
}  // namespace vkcppm::test
