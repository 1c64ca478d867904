// The loader over models that are made here, one a feature: sound scenes of the triangles and the warnings that they
// should have. tests/stability/corpus_test.cpp renders them.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "support/hostile/soundness.h"
#include "support/names.h"
#include "support/scenes/loading.h"
#include "support/scenes/sample_models.h"

namespace vkcppm::test {
namespace {

class SampleModels : public testing::TestWithParam<SampleModel> {};

TEST_P(SampleModels, LoadWithTheirTrianglesAndWarnings) {
    const Scene scene = load(GetParam().file);
    EXPECT_EQ(unsoundness(scene), "");
    EXPECT_EQ(scene.triangles.size(), GetParam().triangles);
    for (const std::string& part : GetParam().warnings) EXPECT_ONE_WARNING(scene, part);
    const auto about_the_camera =
        std::size_t(warnings_with(scene, {"the scene: there is no camera, one that frames it is used"}));
    EXPECT_EQ(scene.warnings.size(), GetParam().warnings.size() + about_the_camera) << all_warnings(scene);
}

INSTANTIATE_TEST_SUITE_P(Features, SampleModels, testing::ValuesIn(sample_models()),
                         [](const auto& info) { return identifier(info.param.name); });

}  // namespace
}  // namespace vkcppm::test
