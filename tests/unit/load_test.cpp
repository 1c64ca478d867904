#include "app/load.h"

#include <string>

#include <gtest/gtest.h>

#include "io/exr.h"
#include "scene/gltf/gltf.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/gltf_builder.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

/// A tetrahedron of glass without a volume.
std::string thin_tetrahedron() {
    test::GltfBuilder builder;
    const int positions = builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    const int indices = builder.u16({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    builder.document["extensionsUsed"] = {"KHR_materials_transmission"};
    builder.add("materials", {{"name", "crystal"},
                              {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                              {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    builder.add(
        "nodes",
        {{"name", "gem"},
         {"mesh", builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}})}});
    return builder.gltf();
}

int lines_with(const Scene& scene, const std::string& part) {
    int lines = 0;
    for (const std::string& line : scene.warnings) lines += line.find(part) != line.npos;
    return lines;
}

TEST(Load, EndsTheWarningsWithTheDiagnosis) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "gem.gltf", thin_tetrahedron());
    const Scene scene = load_scene({.file = folder / "gem.gltf"});
    EXPECT_FALSE(scene.environment);
    EXPECT_EQ(scene.hash, load_gltf(folder / "gem.gltf").hash);
    EXPECT_EQ(scene.materials[0].thickness, 0.0f);
    EXPECT_EQ(lines_with(scene, "nodes[0] 'gem', materials[0] 'crystal'"), 1);
    EXPECT_EQ(lines_with(scene, "no light"), 1);
}

TEST(Load, MakesThinGlassSolidBeforeTheDiagnosis) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "gem.gltf", thin_tetrahedron());
    const Scene scene = load_scene({.file = folder / "gem.gltf", .thin_glass = ThinGlass::solid});
    EXPECT_GT(scene.materials[0].thickness, 0.0f);
    EXPECT_EQ(lines_with(scene, "crystal"), 0);
}

TEST(Load, PutsTheEnvironmentRoundTheSceneAndIntoItsHash) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "gem.gltf", thin_tetrahedron());
    const Image sky{{2, 1}, {{1, 2, 3}, {4, 5, 6}}};
    write_exr(folder / "sky.exr", sky);
    const Scene scene = load_scene({.file = folder / "gem.gltf", .environment = folder / "sky.exr"});
    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->size, sky.extent);
    EXPECT_EQ(scene.environment->radiance, sky.rgb);
    EXPECT_EQ(lines_with(scene, "no light"), 0);
    EXPECT_NE(scene.hash, load_gltf(folder / "gem.gltf").hash);
    EXPECT_TRUE(test::thrown_by([&] { load_scene({.file = folder / "gem.gltf", .environment = folder / "no.exr"}); }));
}

TEST(Load, TurnsAndScalesTheEnvironment) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "gem.gltf", thin_tetrahedron());
    write_exr(folder / "sky.exr", Image{{2, 1}, {{1, 2, 3}, {4, 5, 6}}});
    SceneOptions options{.file = folder / "gem.gltf", .environment = folder / "sky.exr"};
    const std::uint64_t plain = load_scene(options).hash;
    options.environment_rotation = 180.0;
    options.environment_strength = 0.5;
    const Scene scene = load_scene(options);
    EXPECT_EQ(scene.environment->radiance, (std::vector<glm::vec3>{{2, 2.5, 3}, {0.5, 1, 1.5}}));
    EXPECT_NE(scene.hash, plain);
    EXPECT_EQ(scene.inputs.back(), folder / "sky.exr");
    options.environment_strength = 3e38;
    const auto error = test::thrown_by([&] { load_scene(options); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
}

TEST(Load, StrictRunsAllowNoWarning) {
    Scene scene;
    EXPECT_FALSE(test::thrown_by([&] { tell_warnings(scene, {.file = "a.gltf", .strict = true}); }));
    scene.warnings = {"a.gltf: odd", "a.gltf: odder"};
    EXPECT_FALSE(test::thrown_by([&] { tell_warnings(scene, {.file = "a.gltf"}); }));
    const auto error = test::thrown_by([&] { tell_warnings(scene, {.file = "a.gltf", .strict = true}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::bad_input);
    EXPECT_EQ(std::string(error->what()), "a.gltf: 2 warnings; with --strict there must be none");
}

}  // namespace
}  // namespace vkcppm
