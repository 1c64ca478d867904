// KHR_draco_mesh_compression: what the library's own encoder makes of a mesh must load like the mesh.

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "support/files/pictures.h"
#include "support/scenes/draco.h"
#include "support/scenes/loading.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::DracoFormat;
using test::expect_bad_scene;
using test::GltfBuilder;
using test::load;

constexpr const char* draco = "KHR_draco_mesh_compression";

json& extension(GltfBuilder& b) { return b.primitive()["extensions"][draco]; }
json& accessor(GltfBuilder& b, const char* attribute) {
    return b.document["accessors"][b.primitive()["attributes"][attribute].get<std::size_t>()];
}

/// A grid with a texture, so that its texture coordinates are read.
GltfBuilder grid() {
    GltfBuilder b = test::grid(6);
    const int texture = b.texture(test::one_texel_png({1, 2, 3, 255}));
    b.primitive()["material"] =
        b.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    return b;
}

GltfBuilder compressed(const DracoFormat& format = {}) {
    GltfBuilder b = grid();
    test::compress_by_draco(b, 0, format);
    return b;
}

/// A corner of a triangle with all that it has.
using Corner = std::array<float, 12>;

/// The triangles of a scene in an order of their own, each from its least corner on.
std::vector<std::array<Corner, 3>> triangles_of(const Scene& scene) {
    std::vector<std::array<Corner, 3>> triangles;
    for (const Triangle& triangle : scene.triangles) {
        std::array<Corner, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = triangle.vertex[k];
            const glm::vec3 p(scene.positions[v]), n = scene.normals[v];
            const glm::vec4 color = scene.colors.empty() ? glm::vec4(1.0f) : scene.colors[v];
            const glm::vec2 uv = scene.uv[0].empty() ? glm::vec2(0.0f) : scene.uv[0][v];
            corners[k] = {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y, color.r, color.g, color.b, color.a};
        }
        std::ranges::rotate(corners, std::ranges::min_element(corners));
        triangles.push_back(corners);
    }
    std::ranges::sort(triangles);
    return triangles;
}

TEST(Draco, LoadsLikeTheSameMeshUncompressed) {
    const auto twin = triangles_of(load(grid()));
    ASSERT_EQ(twin.size(), 72u);
    for (const bool is_sequential : {false, true}) {
        SCOPED_TRACE(is_sequential);
        const Scene scene = load(compressed({.sequential = is_sequential}));
        EXPECT_EQ(test::warnings_with(scene, {draco}), 0) << test::all_warnings(scene);
        EXPECT_EQ(triangles_of(scene), twin);
    }
}

TEST(Draco, QuantisedPositionsAreWithinHalfAStep) {
    const Scene twin = load(grid()), scene = load(compressed({.sequential = true, .position_bits = 8}));
    ASSERT_EQ(scene.positions.size(), twin.positions.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(scene.positions[i][c] - twin.positions[i][c]));
        }
    }
    EXPECT_LE(largest, 0.5 * 6.0 / 255.0 + 1e-6) << "of a range of 6";
    EXPECT_GT(largest, 0.0) << "nothing was quantised";
}

// Joints and weights of the data; morph targets beside it, in the order of its vertices.
TEST(Draco, SkinsAndMorphTargetsStandOnIt) {
    GltfBuilder twin = test::grid(2);
    std::vector<std::array<std::uint8_t, 4>> joints;
    std::vector<std::array<float, 4>> weights;
    std::vector<test::Float3> moves;
    for (int i = 0; i < 9; ++i) {
        joints.push_back({std::uint8_t(i % 2), 1, 0, 0});
        weights.push_back({0.75f, 0.25f, 0.0f, 0.0f});
        moves.push_back({0.0f, 0.0f, float(i)});
    }
    json& attributes = twin.primitive()["attributes"];
    attributes["JOINTS_0"] = twin.accessor(twin.view(joints), "VEC4", 5121, 9);
    attributes["WEIGHTS_0"] = twin.accessor(twin.view(weights), "VEC4", 5126, 9);
    twin.add("nodes", {{"translation", {0, 0, 2}}});
    twin.add("nodes", {{"scale", {2, 1, 1}}});
    twin.document["nodes"][0]["skin"] = twin.add("skins", {{"joints", {1, 2}}});
    twin.primitive()["targets"] = {{{"POSITION", twin.float3(moves)}}};
    twin.document["meshes"][0]["weights"] = {0.5};
    GltfBuilder b = twin;
    test::compress_by_draco(b, 0, {.sequential = true});
    EXPECT_EQ(triangles_of(load(b)), triangles_of(load(twin)));
}

TEST(Draco, WhatAFileKeepsForOtherProgramsIsNotRead) {
    GltfBuilder b = compressed();
    const auto right = triangles_of(load(b));
    b.document.erase("extensionsRequired");
    json& position = accessor(b, "POSITION");
    position["bufferView"] = b.view(std::vector<float>(3 * position["count"].get<std::size_t>(), 7.0f));
    position["byteOffset"] = 1u << 20;  // the extension asks to ignore it
    EXPECT_EQ(triangles_of(load(b)), right);
    // The same accessor of another primitive means its own data.
    b = compressed();
    b.document["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", b.primitive()["attributes"]["POSITION"]}}}});
    accessor(b, "POSITION")["bufferView"] = b.view(std::vector<float>(3 * 49));
    EXPECT_EQ(triangles_of(load(b)), right) << "49 vertices at the origin, whose triangles are dropped";
}

TEST(Draco, WhatAFileKeepsForOtherProgramsTakesThePlaceOfBrokenData) {
    GltfBuilder b = grid();
    const auto right = triangles_of(load(b));
    extension(b) = {{"bufferView", b.view(std::vector<char>(100, 'x'))}, {"attributes", {{"POSITION", 0}}}};
    b.document["extensionsUsed"] = {draco};
    const Scene scene = load(b);
    EXPECT_EQ(triangles_of(scene), right);
    EXPECT_ONE_WARNING(scene, std::string("meshes[0].primitives[0].extensions.") + draco, "cannot be read");
    b.document["extensionsRequired"] = {draco};
    expect_bad_scene(b.gltf(), {"begin like Draco's"});
}

TEST(Draco, AMeshThatNoNodeShowsIsNotDecoded) {
    GltfBuilder b = compressed();
    json broken = b.document["meshes"][0];
    broken["primitives"][0]["extensions"][draco]["attributes"]["POSITION"] = 77;
    b.document["meshes"].push_back(broken);
    EXPECT_EQ(load(b).triangles.size(), 72u);
}

TEST(Draco, AStripIsTheListThatItWasCompressedAs) {
    GltfBuilder b = compressed();
    const auto right = triangles_of(load(b));
    b.primitive()["mode"] = 5;
    EXPECT_EQ(triangles_of(load(b)), right);
}

// ---- malformed ----

/// The bytes of the compressed data.
std::string data_of(const GltfBuilder& b) {
    const json& view = b.document["bufferViews"].back();
    return b.bytes().substr(view["byteOffset"], view["byteLength"]);
}

GltfBuilder with_data(GltfBuilder b, const std::string& bytes) {
    extension(b)["bufferView"] = b.view(std::vector<char>(bytes.begin(), bytes.end()));
    return b;
}

const std::string object = "meshes[0].primitives[0]";
const std::string extension_object = object + ".extensions." + draco;

TEST(HostileDraco, EveryTruncation) {
    for (const bool is_sequential : {false, true}) {
        const GltfBuilder b = compressed({.sequential = is_sequential});
        const std::string whole = data_of(b);
        for (std::size_t size = 1; size < whole.size(); size += 3) {
            SCOPED_TRACE(fmt::format("{} of {} bytes", size, whole.size()));
            expect_bad_scene(with_data(b, whole.substr(0, size)).gltf(), {extension_object});
        }
    }
}

TEST(HostileDraco, WhatItsHeaderSays) {
    const GltfBuilder b = compressed();
    std::string data = data_of(b);
    expect_bad_scene(with_data(b, "OCARD" + data).gltf(), {extension_object + " is broken", "begin like Draco's"});
    std::string old = data;
    old[6] = 1;
    expect_bad_scene(with_data(b, old).gltf(), {"version of " + extension_object + " is 2.1", "2.2"});
    std::string points = data;
    points[7] = 0;
    expect_bad_scene(with_data(b, points).gltf(), {extension_object + " is points alone", "mesh"});
}

/// A variable-length integer of Draco: 7 bits a byte, the low ones first.
std::string varint(std::uint32_t value) {
    std::string bytes;
    for (; value >= 128; value >>= 7) bytes += char((value & 127) | 128);
    return bytes + char(value);
}

TEST(HostileDraco, CountsThatItsBytesDoNotHold) {
    // The header, then what each method begins with, followed by whatever.
    const std::string header("DRACO\x02\x02\x01", 8), flags("\0\0", 2), rest(100, '\x01');
    const std::string huge = varint(1u << 30);
    const GltfBuilder b = compressed();
    const std::string sequential = header + '\0' + flags + huge + varint(7) + rest;
    expect_bad_scene(with_data(b, sequential).gltf(), {"bytes that Draco decodes to", object, "is 12884901916"});
    const std::string many_points = header + '\0' + flags + varint(1) + huge + rest;
    expect_bad_scene(with_data(b, many_points).gltf(), {"bytes that Draco decodes to", object, "is 4294967308"});
    const std::string edgebreaker =
        header + '\x01' + flags + '\0' + varint(7) + huge + '\x02' + varint(6) + varint(0) + rest;
    expect_bad_scene(with_data(b, edgebreaker).gltf(), {"bytes that Draco decodes to", object, "is 38654705692"});
    const std::string splits = header + '\x01' + flags + '\0' + varint(7) + varint(9) + '\0' + varint(6) + huge + rest;
    expect_bad_scene(with_data(b, splits).gltf(), {extension_object + " is broken"});
}

TEST(HostileDraco, AttributesThatItsDataHasNot) {
    GltfBuilder b = compressed();
    extension(b)["attributes"]["NORMAL"] = 9;
    expect_bad_scene(b.gltf(), {extension_object + ".attributes[\"NORMAL\"] is 9", "no attribute of this number"});
    for (const json& id : {json(-1), json(4294967296), json("x"), json(0.5)}) {
        extension(b)["attributes"]["NORMAL"] = id;
        expect_bad_scene(b.gltf(), {extension_object + ".attributes[\"NORMAL\"] is " + id.dump()});
    }
    b = compressed();
    const std::string odd = "A\n" + std::string(5000, 'B');  // of which a message quotes what fits into a line
    extension(b)["attributes"][odd] = 9;
    b.primitive()["attributes"][odd] = 0;
    expect_bad_scene(b.gltf(), {extension_object + ".attributes[\"A\\nBBB", "BBB...] is 9"});
    b = compressed();
    std::swap(extension(b)["attributes"]["NORMAL"], extension(b)["attributes"]["TEXCOORD_0"]);
    expect_bad_scene(b.gltf(), {".type is \"VEC", "of " + object + " of Draco has "});
}

TEST(HostileDraco, AccessorsThatItsDataIsNot) {
    GltfBuilder b = compressed();
    accessor(b, "NORMAL")["count"] = 50;
    expect_bad_scene(b.gltf(), {".count (\"NORMAL\" of meshes[0].primitives[0]) is 50", "its Draco data has 49"});
    b = compressed();
    json& indices = b.document["accessors"][b.primitive()["indices"].get<std::size_t>()];
    indices["count"] = 219;
    expect_bad_scene(b.gltf(), {".count (indices of meshes[0].primitives[0]) is 219", "its Draco data has 216"});
    b = compressed();
    accessor(b, "POSITION")["componentType"] = 5124;
    expect_bad_scene(b.gltf(), {"componentType is 5124", "no type that holds \"POSITION\" of meshes[0].primitives[0]"});
    b = compressed();
    accessor(b, "POSITION")["type"] = "MAT2";
    expect_bad_scene(b.gltf(), {"accessors[", "].type is \"MAT2\"", "POSITION", "has 3 components"});
    b = compressed();
    b.primitive()["mode"] = 1;
    expect_bad_scene(b.gltf(), {object + ".mode is 1", draco, "needs 4 or 5"});
    b = compressed();
    extension(b)["bufferView"] = 99;
    expect_bad_scene(b.gltf(), {extension_object + ".bufferView is 99"});
}

TEST(HostileDraco, ValuesAreNamedByTheFilesOwnAccessors) {
    GltfBuilder b = test::grid(2);
    const int position = b.primitive()["attributes"]["POSITION"];
    std::vector<test::Float3> positions(9, {0, 0, 0});
    positions[4][1] = std::numeric_limits<float>::infinity();
    b.primitive()["attributes"]["POSITION"] = b.float3(positions);
    const int own = b.primitive()["attributes"]["POSITION"];
    ASSERT_NE(own, position);
    test::compress_by_draco(b, 0, {.sequential = true});
    EXPECT_ONE_WARNING(test::load(b), fmt::format("accessors[{}] (POSITION of {})", own, object), "no finite numbers");
}

// What each of them claims is within the limit, all together are not.
TEST(HostileDraco, ManyPrimitivesOfOneMesh) {
    GltfBuilder b = test::grid(100);
    b.primitive()["attributes"] = {{"POSITION", b.primitive()["attributes"]["POSITION"]}};
    GltfBuilder small = test::one_triangle();  // without the bytes that were compressed
    test::compress_by_draco(b, 0, {.position_bits = 1});
    const std::string data = data_of(b);
    small.document["accessors"] = b.document["accessors"];
    for (json& accessor : small.document["accessors"]) accessor.erase("bufferView");
    small.primitive() = b.primitive();
    small = with_data(small, data);
    EXPECT_FALSE(load(small).triangles.empty());
    small.document["meshes"][0]["primitives"] = std::vector<json>(60, small.primitive());
    expect_bad_scene(small.gltf(), {"bytes that Draco decodes to", "the limit is ", " bytes"});
}

}  // namespace
}  // namespace vkcppm
