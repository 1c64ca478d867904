// Small files that claim much, by a program that may have little memory: each is refused for what it claims, and not
// because the memory has come to an end.

#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/files/files.h"
#include "support/scenes/gltf_builder.h"

namespace vkcppm {
namespace {

using namespace test;
using nlohmann::json;

class Bombs : public ProgramTest {
protected:
    /// What info says of the file with 256 MiB of address space, of which the program and its libraries take a third.
    ProcessResult info(const std::string& file, const std::string& options = "") const {
        return run_process(
            {"/bin/sh", "-c", "ulimit -v 262144; exec \"$0\" info \"$1\" " + options, test::program(), file},
            folder_.path());
    }

    void expect_refused(const std::string& bytes, const Words& told) const {
        write_bytes(folder_ / "bomb.gltf", bytes);
        expect_failure(info("bomb.gltf"), 65, told, bytes.substr(0, 200));
    }
};

json& accessor(GltfBuilder& b) { return b.document["accessors"][0]; }

TEST_F(Bombs, TheMemoryIsEnoughForAScene) { expect_done(info(scene("caustic"))); }

TEST_F(Bombs, Accessors) {
    GltfBuilder zeros = one_triangle();
    accessor(zeros).erase("bufferView");
    for (const std::uint64_t count : {std::uint64_t(1000000), std::uint64_t(1) << 31, std::uint64_t(1) << 52}) {
        accessor(zeros)["count"] = count;
        expect_refused(zeros.gltf(),
                       {"bomb.gltf: the number of ", fmt::format(" is {}", count / 3).substr(0, 3), "the limit is"});
    }
    GltfBuilder many = one_triangle();
    accessor(many).erase("bufferView");
    accessor(many)["count"] = 200000;
    const json first = accessor(many), primitive = many.document["meshes"][0]["primitives"][0];
    for (int i = 1; i < 100; ++i) {
        json other = primitive;
        other["attributes"]["POSITION"] = many.add("accessors", first);
        other["indices"] = many.add("accessors", {{"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}});
        many.document["meshes"][0]["primitives"].push_back(other);
    }
    expect_refused(many.gltf(), {"bomb.gltf: the number of vectors that the meshes read is ", "the limit is"});
}

TEST_F(Bombs, Instances) {
    GltfBuilder b = one_triangle();
    const int places = b.add("accessors", {{"componentType", 5126}, {"count", 1 << 20}, {"type", "VEC3"}});
    b.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    expect_refused(b.gltf(), {"bomb.gltf: the number of instances of nodes[0] is 1048576; the limit is"});
}

TEST_F(Bombs, Buffers) {
    GltfBuilder b = one_triangle();
    write_bytes(folder_ / "a.bin", std::string(1 << 20, '\0'));
    json document = json::parse(b.gltf_with_uri("a.bin"));
    // Not refused: the file is read once.
    document["buffers"] = std::vector<json>(1000, {{"uri", "a.bin"}, {"byteLength", 1 << 20}});
    write_bytes(folder_ / "shared.gltf", document.dump());
    expect_done(info("shared.gltf"));
    document["buffers"] = {{{"uri", "a.bin"}, {"byteLength", std::uint64_t(1) << 31}}};
    expect_refused(document.dump(), {"buffers[0].byteLength is 2147483648; its data has 1048576 bytes"});
}

TEST_F(Bombs, DepthOfNodesAndOfJson) {
    GltfBuilder b = one_triangle();
    for (int i = 0; i < 20000; ++i) b.add("nodes", {{"children", {i + 2}}});
    b.add("nodes", json::object());
    write_bytes(folder_ / "deep.gltf", b.gltf());
    expect_done(info("deep.gltf"));
    expect_refused("{\"asset\": {\"version\": \"2.0\"}, \"extras\": " + std::string(1000000, '['),
                   {"depth of the JSON is 65"});
}

TEST_F(Bombs, Pictures) {
    // Magic, version, then attributes: name, type, size, value.
    const auto attribute = [](const std::string& name, const std::string& type,
                              const std::vector<std::int32_t>& words) {
        std::string bytes = name + '\0' + type + '\0';
        const auto append = [&](std::int32_t word) { bytes.append(reinterpret_cast<const char*>(&word), 4); };
        append(std::int32_t(4 * words.size()));
        for (const std::int32_t word : words) append(word);
        return bytes;
    };
    const std::string exr("\x76\x2f\x31\x01\2\0\0\0", 8);
    const auto expect_no_environment = [&](const std::string& bytes, const Words& told) {
        write_bytes(folder_ / "sky", bytes);
        expect_failure(info(scene("slab"), "--environment sky"), 65, told, told.front());
    };
    expect_no_environment(exr + attribute("dataWindow", "box2i", {0, 0, 0x7fffffff, 0}),
                          {"sky: ", "2147483648x1 pixels"});
    expect_no_environment(exr + attribute("dataWindow", "box2i", {0, 0, 65535, 32767}),
                          {"sky: ", "65536x32768 pixels"});
    expect_no_environment(exr + attribute("displayWindow", "box2i", {0, 0, 4095, 2047}), {"sky: ", "4096x2048 pixels"});
    std::string huge = exr + attribute("comments", "string", {0});
    huge.replace(huge.size() - 8, 4, "\xff\xff\xff\x7f");
    expect_no_environment(huge, {"sky: ", "'comments'", "has 2147483647 bytes, 4 are left"});
    expect_no_environment("#?RADIANCE\n\n-Y 65536 +X 32768\n", {"sky: ", "32768x65536 pixels"});
    expect_no_environment("#?RADIANCE\n\n-Y 1 +X 4294967296\n", {"sky: ", "+X 4294967296"});
}

}  // namespace
}  // namespace vkcppm
