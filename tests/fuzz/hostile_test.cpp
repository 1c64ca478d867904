// The readers of scenes and pictures over thousands of files that are nearly right, the same ones every day. The fuzzer
// (README.md) looks for new ones; what it finds stays in regressions/.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/files/files.h"
#include "support/files/places.h"
#include "support/files/temporary_folder.h"
#include "support/hostile/faults.h"
#include "support/hostile/hostile_input.h"
#include "support/hostile/mutation.h"
#include "support/scenes/draco.h"
#include "support/scenes/everything.h"
#include "support/scenes/sample_models.h"
#include "support/scenes/scenes.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using test::misbehaviour;

const fs::path source = test::source_folder();

std::vector<fs::path> files_of(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// Puts `count` mutations of each file through the readers. Where one misbehaves, the seed says which it was.
void expect_no_misbehaviour(const std::vector<fs::path>& files, std::uint32_t count) {
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) {
        const std::string bytes = test::read_bytes(file);
        ASSERT_EQ(misbehaviour(bytes), "") << file;
        for (std::uint32_t seed = 0; seed < count; ++seed) {
            ASSERT_EQ(misbehaviour(test::mutation(bytes, seed)), "") << "mutation " << seed << " of " << file;
        }
    }
}

TEST(Hostile, WhatTheFuzzerFoundBehaves) {
    for (const fs::path& file : files_of(source / "tests/fuzz/regressions")) {
        SCOPED_TRACE(file);
        EXPECT_EQ(misbehaviour(test::read_bytes(file)), "");
    }
}

TEST(Hostile, MutationsOfScenes) {
    std::vector<fs::path> files = test::gltf_files_in(source / "scenes");
    std::erase_if(files, [](const fs::path& file) { return fs::file_size(file) > 12000; });
    expect_no_misbehaviour(files, 100);
}

TEST(Hostile, MutationsOfASceneWithEverything) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "everything.glb", test::everything().glb());
    const Scene scene = load_gltf(folder / "everything.glb");
    EXPECT_EQ(scene.triangles.size(), 10u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    expect_no_misbehaviour({folder / "everything.glb"}, 1500);
}

TEST(Hostile, MutationsOfPictures) { expect_no_misbehaviour(files_of(source / "tests/fuzz/pictures"), 100); }

/// One malformed file of each kind, which a change may also make right.
TEST(Hostile, MutationsOfFaults) {
    const test::TemporaryFolder folder;
    std::vector<fs::path> files;
    for (const test::Fault& fault : test::faults()) {
        test::GltfBuilder builder = test::one_triangle();
        fault.make(builder);
        files.push_back(folder / (std::string(fault.name) + ".gltf"));
        test::write_bytes(files.back(), builder.gltf());
    }
    std::erase_if(files, [](const fs::path& file) { return fs::file_size(file) > 12000; });
    expect_no_misbehaviour(files, 12);
}

TEST(Hostile, MutationsOfSampleModels) {
    const test::TemporaryFolder folder;
    std::vector<fs::path> files;
    for (const test::SampleModel& model : test::sample_models()) {
        files.push_back(folder / (model.name + ".glb"));
        test::write_bytes(files.back(), model.file.glb());
    }
    expect_no_misbehaviour(files, 20);
}

/// Bytes of Draco's data alone, as what is around it is changed above.
TEST(Hostile, MutationsOfCompressedMeshes) {
    for (const bool is_sequential : {false, true}) {
        test::GltfBuilder builder = test::grid(5);
        test::compress_by_draco(builder, 0, {.sequential = is_sequential, .position_bits = 10});
        const nlohmann::json view = builder.document["bufferViews"].back();
        const std::string whole = builder.bytes().substr(view["byteOffset"], view["byteLength"]);
        for (std::uint32_t seed = 0; seed < 1500; ++seed) {
            test::GltfBuilder changed = builder;
            const std::string bytes = test::mutation(whole, seed);
            if (bytes.empty()) continue;
            changed.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
                changed.view(std::vector<char>(bytes.begin(), bytes.end()));
            ASSERT_EQ(misbehaviour(changed.glb()), "") << "mutation " << seed << (is_sequential ? " in order" : "");
        }
    }
}

TEST(Hostile, MutationsOfHostileFiles) {
    const auto folder = test::shared_file("hostile");
    if (!folder) GTEST_SKIP() << test::no_collections;
    std::vector<fs::path> files = test::gltf_files_in(*folder);
    std::erase_if(files, [](const fs::path& file) { return fs::file_size(file) > 12000; });
    expect_no_misbehaviour(files, 6);
}

}  // namespace
}  // namespace vkcppm
