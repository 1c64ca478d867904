// A few small pictures as they were when somebody last looked at them. The tolerance is a relMSE far below the noise of
// another seed (about 1e-2) and above what another driver's rounding does to single paths.

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "io/exr.h"
#include "study/check.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
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
    const Image golden_picture = read_exr(folder / (name + ".exr"));
    CheckSettings bounds;
    bounds.bounds = {{"relmse", golden["tolerance"].get<double>()}};
    const Check found = check({image}, {golden_picture}, bounds);
    EXPECT_TRUE(found.passes()) << found.why();
    if (HasFailure()) leave_pictures(image, golden_picture);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(cases()),
                         [](const auto& info) { return identifier(name_of(info.param)); });

}  // namespace
}  // namespace vkcppm::test
