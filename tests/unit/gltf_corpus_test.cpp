// The loader over collections of files beside the project: sample models must load, hostile files must not crash it.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scene/gltf/gltf.h"
#include "support/files/files.h"
#include "support/files/places.h"
#include "support/hostile/soundness.h"
#include "support/scenes/scenes.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path scenes = test::source_folder() / "../shared/scenes";

#define SKIP_WITHOUT(file) \
    if (!fs::exists(file)) GTEST_SKIP() << test::no_collections

/// What loading a file says: its warnings, or the error that refuses it, without the file's name.
std::vector<std::string> lines_of(const fs::path& file) {
    std::vector<std::string> lines;
    const auto error = test::thrown_by([&] {
        const Scene scene = load_gltf(file);
        EXPECT_EQ(test::unsoundness(scene), "");
        lines = scene.warnings;
    });
    if (error) lines = {error->what()};
    for (std::string& line : lines) {
        EXPECT_TRUE(line.starts_with(file.string() + ": ")) << line;
        line.erase(0, std::min(line.size(), file.string().size() + 2));
    }
    if (error) lines.front().insert(0, "error: ");
    return lines;
}

/// Every file below the folder must load, sound and with the lines that are on record for it, or be refused with its.
void expect_recorded_lines(const fs::path& folder) {
    std::map<fs::path, std::vector<std::string>> recorded;
    const fs::path record = test::source_folder() / "tests/unit/gltf_corpus_lines.json";
    for (const json& group : json::parse(test::read_bytes(record))) {
        for (const json& file : group["files"]) recorded[scenes / file.get<std::string>()] = group["lines"];
    }
    const std::vector<fs::path> files = test::gltf_files_in(folder);
    EXPECT_FALSE(files.empty());
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const auto found = recorded.find(file);
        ASSERT_NE(found, recorded.end()) << "not on record";
        EXPECT_EQ(lines_of(file), found->second);
    }
}

TEST(GltfCorpus, KhronosSampleModelsLoadWithTheirWarnings) {
    SKIP_WITHOUT(scenes / "khronos");
    expect_recorded_lines(scenes / "khronos");
}

TEST(GltfCorpus, AssetGeneratorModelsLoadWithTheirWarnings) {
    SKIP_WITHOUT(scenes / "asset-generator");
    expect_recorded_lines(scenes / "asset-generator");
}

TEST(GltfCorpus, KhronosSampleModelsHaveTheTrianglesTheyShould) {
    SKIP_WITHOUT(scenes / "khronos");
    // Models that the index counts once a mesh, not once an instance, or in which it counts lines.
    const std::map<std::string, std::size_t> instanced = {
        {"GlassVaseFlowers.glb", 14036},
        {"SimpleMeshes.gltf", 2},
        {"SimpleInstancing.glb", 125 * 12},
        {"TextureTransformTest.gltf", 24},
        {"MeshPrimitiveModes.gltf", 16},
        {"MetalRoughSpheresNoTextures.glb", 1040409 - 196},  // 196 at the poles of spheres have no area
    };
    const json index = json::parse(test::read_bytes(scenes / "khronos/index.json"));
    std::size_t compared = 0;
    for (const json& entry : index["files"]) {
        const fs::path file = scenes / entry["path"].get<std::string>();
        SCOPED_TRACE(file);
        Scene scene;
        if (test::thrown_by([&] { scene = load_gltf(file); })) continue;
        const auto found = instanced.find(file.filename().string());
        const auto expected = found == instanced.end() ? entry["triangles"].get<std::size_t>() : found->second;
        EXPECT_EQ(scene.triangles.size(), expected);
        ++compared;
    }
    EXPECT_GE(compared, 50u);
}

TEST(GltfCorpus, TextureTransformTestPointsItsArrowAtTheMark) {
    const fs::path file = scenes / "khronos/TextureTransformTest/glTF/TextureTransformTest.gltf";
    SKIP_WITHOUT(file);
    const Scene scene = load_gltf(file);
    const auto turned = std::ranges::find(scene.materials, "Rotation", &Material::name);
    ASSERT_NE(turned, scene.materials.end());
    ASSERT_TRUE(turned->base_color_texture);
    // The arrow runs along u = v. Its mark for "correct" stands at (-0.0790, -0.5163) on a square of side 1 whose first
    // row is on top, the mark for "not supported" at (0.2778, -0.2778): one must look up what the other shows.
    const glm::vec2 uv = turned->base_color_texture->matrix * glm::vec2(0.5f - 0.0790482f, 0.5f + 0.5162675f) +
                         turned->base_color_texture->offset;
    EXPECT_NEAR(uv.x, 0.5f + 0.2778175f, 1e-5f);
    EXPECT_NEAR(uv.y, 0.5f + 0.2778175f, 1e-5f);
}

TEST(GltfCorpus, NegativeScaleKeepsFrontsAndNormalsOnOneSide) {
    SKIP_WITHOUT(scenes / "asset-generator/Node_NegativeScale");
    for (const fs::path& file : test::gltf_files_in(scenes / "asset-generator/Node_NegativeScale")) {
        const Scene scene = load_gltf(file);
        std::size_t opposed = 0;
        for (const Triangle& triangle : scene.triangles) {
            const glm::dvec3 p = scene.positions[triangle.vertex[0]];
            const glm::dvec3 geometric =
                glm::cross(scene.positions[triangle.vertex[1]] - p, scene.positions[triangle.vertex[2]] - p);
            for (const std::uint32_t vertex : triangle.vertex) {
                opposed += !(glm::dot(geometric, glm::dvec3(scene.normals[vertex])) > 0.0);
            }
        }
        EXPECT_EQ(opposed, 0u) << file << ": corners whose shading normal is behind the front, of "
                               << 3 * scene.triangles.size();
    }
}

TEST(GltfCorpus, HostileFilesGiveASceneOrAnError) {
    SKIP_WITHOUT(scenes / "hostile");
    std::size_t refused = 0;
    const std::vector<fs::path> files = test::gltf_files_in(scenes / "hostile");
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const auto error =
            test::thrown_by([&] { EXPECT_EQ(test::unsoundness(load_gltf(file)), ""); });  // anything else ends the test
        if (!error) continue;
        ++refused;
        EXPECT_EQ(error->code(), ExitCode::bad_input) << error->what();
        EXPECT_TRUE(std::string(error->what()).starts_with(file.string() + ": ")) << error->what();
    }
    EXPECT_GE(refused, files.size() / 4) << "of " << files.size();
}

TEST(GltfCorpus, CornellGlassIsWhatItsDescriptionSays) {
    const fs::path file = scenes / "cornell_glass.glb";
    SKIP_WITHOUT(file);
    const Scene scene = load_gltf(file);
    EXPECT_EQ(scene.triangles.size(), 40980u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const auto named = [&](const char* name) { return *std::ranges::find(scene.materials, name, &Material::name); };
    EXPECT_FLOAT_EQ(named("light").emission.x, 25.033299f);
    EXPECT_FLOAT_EQ(named("glass").ior, 1.6f);
    EXPECT_GT(named("glass").thickness, 0.0f);
    EXPECT_EQ(named("white").specular, 0.0f);
    EXPECT_EQ(named("mirror").metallic, 1.0f);
}

}  // namespace
}  // namespace vkcppm
