// Malformed files: each gives an Error whose one line names the file, the object, the value and the limit.

#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/gltf/gltf.h"
#include "scene/gltf/limits.h"
#include "support/files/temporary_folder.h"
#include "support/hostile/faults.h"
#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::expect_bad_scene;
using test::GltfBuilder;

class HostileGltf : public testing::TestWithParam<test::Fault> {};

TEST_P(HostileGltf, IsRefusedByALineThatNamesObjectValueAndLimit) {
    GltfBuilder builder = test::one_triangle();
    GetParam().make(builder);
    expect_bad_scene(builder.gltf(), GetParam().parts);
}

INSTANTIATE_TEST_SUITE_P(Faults, HostileGltf, testing::ValuesIn(test::faults()),
                         [](const auto& info) { return std::string(info.param.name); });

// ---- files and containers ----

TEST(HostileFile, MissingOrIrregularIsNoInput) {
    const test::TemporaryFolder folder;
    const std::filesystem::path device = "/dev/null";
    for (const std::filesystem::path& file : {folder / "missing.gltf", folder.path(), device}) {
        const auto error = test::thrown_by([&] { load_gltf(file); });
        ASSERT_TRUE(error) << file;
        EXPECT_EQ(error->code(), ExitCode::no_input) << error->what();
        EXPECT_NE(std::string(error->what()).find(file.string()), std::string::npos) << error->what();
    }
}

TEST(HostileFile, WhatIsNotGltf) {
    expect_bad_scene("", {"not glTF"});
    expect_bad_scene("solid cube", {"not glTF"});
    expect_bad_scene("[1, 2]", {"the JSON is [1,2]", "object"});
    expect_bad_scene("{\"asset\": {\"version\": \"2.0\"}, \"x\": \"\xff\xfe\"}", {"not glTF"});
    expect_bad_scene("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}", {"not glTF", "1e999"});
}

TEST(HostileFile, DeepJson) {
    const std::string brackets(1000000, '[');
    expect_bad_scene(R"({"asset": {"version": "2.0"}, "extras": )" + brackets, {"depth of the JSON is 65", "64"});
    const std::string quoted_brackets =
        R"({"asset": {"version": "2.0"}, "scene": 0, "extras": "\"[)" + brackets + "\"}";
    expect_bad_scene(quoted_brackets, {"scene is 0"});
}

TEST(HostileFile, EveryTruncationOfAGltf) {
    const std::string whole = test::one_triangle().gltf();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        SCOPED_TRACE(size);
        expect_bad_scene(whole.substr(0, size), {"not glTF"});
    }
}

TEST(HostileFile, EveryTruncationOfAGlb) {
    const std::string whole = test::one_triangle().glb();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        SCOPED_TRACE(size);
        expect_bad_scene(whole.substr(0, size), {});
    }
}

/// The .glb of one triangle with the 32-bit word at byte `offset` replaced.
std::string glb_with_word(std::size_t offset, std::uint32_t word) {
    std::string bytes = test::one_triangle().glb();
    std::memcpy(bytes.data() + offset, &word, sizeof word);
    return bytes;
}

TEST(HostileFile, GlbHeaders) {
    const std::size_t size = test::one_triangle().glb().size();
    const std::size_t binary_header = size - 36 - 8;
    expect_bad_scene(glb_with_word(4, 1), {"GLB version is 1", "reads 2"});
    expect_bad_scene(glb_with_word(8, 0xffffffff), {"GLB length is 4294967295", fmt::format("the file has {}", size)});
    expect_bad_scene(glb_with_word(8, 12), {"GLB length is 12", "no JSON chunk"});
    expect_bad_scene(glb_with_word(12, 0xfffffffc), {"GLB chunk 0 length is 4294967292", "bytes are left"});
    expect_bad_scene(glb_with_word(12, 6), {"GLB chunk 1 length is", "bytes are left"});
    expect_bad_scene(glb_with_word(16, 0x004e4942), {"GLB chunk 0 type is 0x004e4942", "JSON"});
    expect_bad_scene(glb_with_word(binary_header, 40), {"GLB chunk 1 length is 40", "36 bytes are left"});
    expect_bad_scene(glb_with_word(binary_header + 4, 0x12345678), {"buffers[0] is absent", "no binary chunk"});
}

TEST(HostileFile, ScenesOfOtherProgramsAreToldWhatToExport) {
    const test::TemporaryFolder folder;
    const auto refusal = [&](const char* name, const std::string& bytes) {
        test::write_bytes(folder / name, bytes);
        const auto error = test::thrown_by([&] { load_gltf(folder / name); });
        if (!error || error->code() != ExitCode::bad_input) return std::string("no refusal");
        return std::string(error->what());
    };
    for (const auto& [name, bytes, told] :
         std::vector<std::array<const char*, 3>>{{"a.blend", "BLENDER-v400", "Blender"},
                                                 {"a", "BLENDER-v400", "Blender"},
                                                 {"a.OBJ", "v 0 0 0\n", "OBJ"},
                                                 {"a.usd", "#usda 1.0", "USD"},
                                                 {"a.fbx", "; FBX 7.7.0", "FBX"},
                                                 {"a.ply", "ply\nformat", "PLY"},
                                                 {"a.usdz", "PK\3\4", "USD"},
                                                 {"a.stl", "solid cube", "STL"}}) {
        const std::string line = refusal(name, bytes);
        EXPECT_NE(line.find(told), line.npos) << line;
        EXPECT_NE(line.find("export it as .glb"), line.npos) << line;
    }
    EXPECT_NE(refusal("a.gltf", "solid cube").find("not glTF"), std::string::npos);
    test::write_bytes(folder / "b.obj", test::one_triangle().gltf());
    EXPECT_EQ(load_gltf(folder / "b.obj").triangles.size(), 1u) << "what it is counts, not what it is called";
}

TEST(HostileFile, Buffers) {
    GltfBuilder builder = test::one_triangle();
    expect_bad_scene(builder.gltf_with_uri("gone.bin"), {"buffers[0] is absent", "\"gone.bin\": no such file"});
    expect_bad_scene(builder.gltf_with_uri("hostile.gltf/"), {"buffers[0] is absent"});
    for (const char* uri : {"/etc/passwd", "file:///etc/passwd", "http://example.com/x.bin", "C:\\x.bin"}) {
        expect_bad_scene(builder.gltf_with_uri(uri), {"buffers[0] is absent", "not a relative path"});
    }
    for (const char* uri : {"../../../../../../etc/passwd", "%2e%2e/%2e%2e/%2e%2e/%2e%2e/etc/passwd"}) {
        expect_bad_scene(builder.gltf_with_uri(uri), {"buffers[0] is absent", "outside of", "--root"});
    }
    expect_bad_scene(builder.gltf_with_uri("data:;base64,****"), {"buffers[0].uri is", "base64"});
    expect_bad_scene(builder.gltf_with_uri("data:;base64,AAAA"),
                     {"buffers[0].byteLength is 36", "its data has 3 bytes"});

    json document = json::parse(builder.gltf());
    document["buffers"][0]["byteLength"] = 5000000000000u;
    expect_bad_scene(document.dump(), {"byteLength of the buffers together is 5000000000000", "4294967296"});
}

TEST(HostileFile, WhatItStandsForIsInProportionToItsBytes) {
    EXPECT_EQ(max_triangles.of(0), 262144u);
    EXPECT_EQ(max_triangles.of(1000), 262144u + 256000u);
    EXPECT_EQ(max_triangles.of(std::size_t(1) << 32), 134217728u);
}

TEST(HostileFile, LinksOutOfItsRoot) {
    const test::TemporaryFolder outside, folder;
    GltfBuilder builder = test::one_triangle();
    test::write_bytes(outside / "secret.bin", builder.bytes());
    std::filesystem::create_symlink(outside / "secret.bin", folder / "link.bin");
    std::filesystem::create_symlink(outside.path(), folder / "textures");
    std::filesystem::create_directory(folder / "inside");
    test::write_bytes(folder / "inside/real.bin", builder.bytes());
    std::filesystem::create_symlink("inside/real.bin", folder / "near.bin");
    const auto load = [&](const char* uri) {
        test::write_bytes(folder / "scene.gltf", builder.gltf_with_uri(uri));
        return test::thrown_by([&] { load_gltf(folder / "scene.gltf", {.root = folder.path()}); });
    };
    for (const char* uri : {"link.bin", "textures/secret.bin", "%74extures/secret.bin"}) {
        const auto error = load(uri);
        ASSERT_TRUE(error) << uri << " was read";
        const std::string message = error->what();
        EXPECT_EQ(error->code(), ExitCode::bad_input) << message;
        for (const std::string& part : {std::string("buffers[0] is absent"), uri + std::string("\": outside of")}) {
            EXPECT_NE(message.find(part), std::string::npos) << part << " not in: " << message;
        }
    }
    for (const char* uri : {"near.bin", "inside/real.bin", "inside/../near.bin"}) {
        const auto error = load(uri);
        EXPECT_FALSE(error) << uri << ": " << error->what();
    }
}

// A file that many buffers name is read once: eight of these fit into the memory that is there, a million would not.
TEST(HostileFile, ManyBuffersOfOneFileShareItsBytes) {
    const test::TemporaryFolder folder;
    GltfBuilder builder = test::one_triangle();
    test::write_bytes(folder / "a.bin", builder.bytes() + std::string(64, '\0'));
    json document = json::parse(builder.gltf_with_uri("a.bin"));
    for (int i = 1; i <= 8; ++i) document["buffers"].push_back({{"uri", "a.bin"}, {"byteLength", 36 + 8 * i}});
    document["bufferViews"][0]["buffer"] = 8;
    test::write_bytes(folder / "scene.gltf", document.dump());
    const GltfFile file = read_gltf_file(folder / "scene.gltf");
    EXPECT_EQ(file.bytes, document.dump().size() + 100) << "of the scene and of the largest of the buffers";
    for (const GltfBuffer& buffer : file.buffers) EXPECT_EQ(buffer.bytes, file.buffers[0].bytes);
    EXPECT_EQ(load_gltf(folder / "scene.gltf").triangles.size(), 1u);
    document["buffers"].push_back({{"uri", "a.bin"}, {"byteLength", 101}});
    test::write_bytes(folder / "scene.gltf", document.dump());
    const auto error = test::thrown_by([&] { load_gltf(folder / "scene.gltf"); });
    ASSERT_TRUE(error);
    EXPECT_NE(std::string(error->what()).find("buffers[9].byteLength is 101; its data has 100"), std::string::npos)
        << error->what();
}

/// The scene of one triangle with a base colour texture of those bytes.
std::string textured(const std::string& picture) {
    GltfBuilder builder = test::one_triangle();
    builder.document["meshes"][0]["primitives"][0]["material"] = builder.add(
        "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", builder.texture(picture)}}}}}});
    return builder.gltf();
}

/// Signature and header of a PNG of that size, 8-bit grey, and nothing behind them.
std::string png_header(std::uint32_t width, std::uint32_t height) {
    std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    for (const std::uint32_t side : {width, height}) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes += char(side >> shift);
    }
    bytes += std::string("\x08\0\0\0\0", 5);
    std::uint32_t crc = ~0u;  // PNG specification, annex D, of the chunk's name and data
    for (const char c : bytes.substr(12)) {
        crc ^= std::uint8_t(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    for (int shift = 24; shift >= 0; shift -= 8) bytes += char(~crc >> shift);
    return bytes + std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12);
}

// "Start of image", then a frame header: precision, height, width, one component.
std::string jpeg_header(std::uint16_t width, std::uint16_t height) {
    const auto word = [](std::uint16_t value) { return std::string{char(value >> 8), char(value & 0xff)}; };
    return "\xff\xd8\xff\xc0" + word(11) + "\x08" + word(height) + word(width) + std::string("\1\1\x11\0", 4) +
           "\xff\xda" + word(8) + std::string("\1\1\0\0\x3f\0", 6);
}

/// A lossless WebP of that size and of one colour, in a few bytes.
std::string flat_webp(std::uint32_t width, std::uint32_t height) {
    std::string bytes("RIFF\x1a\0\0\0WEBPVP8L\x0e\0\0\0\x2f", 21);
    // Signature, then 14 bits of each side less one; neither alpha nor transforms, one code of one symbol a channel.
    const std::uint32_t sides = (width - 1) | (height - 1) << 14;
    for (int shift = 0; shift < 32; shift += 8) bytes += char(sides >> shift);
    return bytes + std::string("\x88\x88\x08\0\0\0\0\0\0", 9);
}

TEST(HostileFile, PicturesThatClaimMoreThanTheyHold) {
    EXPECT_EQ(test::load_text(textured(flat_webp(4096, 4096))).images.at(0).size, (Extent{4096, 4096}));
    expect_bad_scene(textured(flat_webp(16383, 16383)),
                     {"size of images[0] is 16383 x 16383; its 34 bytes hold 17057920 texels at most"});
    expect_bad_scene(textured(png_header(16385, 1)),
                     {"size of images[0] is 16385 x 1; the limit is 16384 texels a side"});
    expect_bad_scene(textured(png_header(16384, 16384)),
                     {"size of images[0] is 16384 x 16384; its 45 bytes hold 371520 texels at most"});
    expect_bad_scene(textured(png_header(65536, 32768)), {"size of images[0] is 65536 x 32768", "16384"});
    expect_bad_scene(textured(jpeg_header(16384, 16384)), {"size of images[0] is 16384 x 16384", "texels at most"});
    expect_bad_scene(textured(jpeg_header(65500, 65500)), {"size of images[0] is 65500 x 65500", "16384"});
    const std::string no_frame("\xff\xd8\xff\0\0\0\0\0\0\0", 10);
    for (const std::string& bytes : {png_header(0x7fffffff, 1), jpeg_header(0, 16), no_frame}) {
        const Scene scene = test::load_text(textured(bytes));
        EXPECT_TRUE(scene.images.empty());
        EXPECT_ONE_WARNING(scene, "images[0] (broken", "unreadable");
    }
}

}  // namespace
}  // namespace vkcppm
