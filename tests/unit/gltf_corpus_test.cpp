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

#include "scene/gltf.h"
#include "support/files.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path scenes = fs::path(VKCPPM_SOURCE_DIR) / "../shared/scenes";

std::vector<fs::path> gltf_files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

#define SKIP_WITHOUT(folder) \
    if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is not there"

/// Whether every vertex, normal and index of a scene is what Scene promises.
void expect_sound(const Scene& scene) {
    ASSERT_EQ(scene.positions.size(), scene.normals.size());
    EXPECT_GE(scene.cameras.size(), 1u);
    std::size_t unsound = 0;
    for (const Triangle& triangle : scene.triangles) {
        ASSERT_LT(triangle.material, scene.materials.size());
        for (const std::uint32_t vertex : triangle.vertex) {
            ASSERT_LT(vertex, scene.positions.size());
            const glm::dvec3& p = scene.positions[vertex];
            const bool is_finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            unsound += !is_finite || !(std::abs(glm::length(scene.normals[vertex]) - 1.0f) < 1e-5f);
        }
    }
    EXPECT_EQ(unsound, 0u) << "corners without a finite position or a unit normal";
}

/// Loads every file; an Error must say one of `reasons`.
void expect_all_load(const fs::path& folder, const std::vector<std::string>& reasons) {
    const std::vector<fs::path> files = gltf_files_in(folder);
    EXPECT_FALSE(files.empty());
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const auto error = test::thrown_by([&] { expect_sound(load_gltf(file)); });
        if (!error) continue;
        const std::string message = error->what();
        EXPECT_TRUE(std::ranges::any_of(reasons, [&](const std::string& reason) {
            return message.find(reason) != std::string::npos;
        })) << message;
    }
}

TEST(GltfCorpus, KhronosSampleModelsLoad) {
    SKIP_WITHOUT(scenes / "khronos");
    expect_all_load(scenes / "khronos", {"extensionsRequired is \"KHR_draco_mesh_compression\"",
                                         "extensionsRequired is \"KHR_materials_iridescence\"",
                                         "extensionsRequired is \"KHR_materials_unlit\""});
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

TEST(GltfCorpus, AssetGeneratorModelsLoad) {
    SKIP_WITHOUT(scenes / "asset-generator");
    expect_all_load(scenes / "asset-generator", {"asset.minVersion is \"2.1\"",
                                                 "extensionsRequired is \"FAKE_materials_quantumRendering\""});
}

TEST(GltfCorpus, NegativeScaleKeepsFrontsAndNormalsOnOneSide) {
    SKIP_WITHOUT(scenes / "asset-generator/Node_NegativeScale");
    for (const fs::path& file : gltf_files_in(scenes / "asset-generator/Node_NegativeScale")) {
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
    const std::vector<fs::path> files = gltf_files_in(scenes / "hostile");
    for (const fs::path& file : files) {
        SCOPED_TRACE(file);
        const auto error = test::thrown_by([&] { expect_sound(load_gltf(file)); });  // anything else ends the test
        if (!error) continue;
        ++refused;
        EXPECT_TRUE(error->code() == ExitCode::bad_scene || error->code() == ExitCode::no_input) << error->what();
        EXPECT_TRUE(std::string(error->what()).starts_with(file.string() + ": ")) << error->what();
    }
    EXPECT_GE(refused, files.size() / 4) << "of " << files.size();
}

TEST(GltfCorpus, CornellGlassIsWhatItsDescriptionSays) {
    const fs::path file = scenes / "cornell_glass.glb";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_gltf(file);
    EXPECT_EQ(scene.triangles.size(), 40980u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const auto named = [&](const char* name) {
        return *std::ranges::find(scene.materials, name, &Material::name);
    };
    EXPECT_FLOAT_EQ(named("light").emission.x, 25.033299f);
    EXPECT_FLOAT_EQ(named("glass").ior, 1.6f);
    EXPECT_GT(named("glass").thickness, 0.0f);
    EXPECT_EQ(named("white").specular, 0.0f);
    EXPECT_EQ(named("mirror").metallic, 1.0f);
}

}  // namespace
}  // namespace vkcppm
