// EXT_meshopt_compression: what the library's own encoders make of a mesh must load like the mesh.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "support/files/pictures.h"
#include "support/scenes/loading.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::expect_bad_scene;
using test::Float3;
using test::GltfBuilder;
using test::load;

using Bytes = std::vector<std::uint8_t>;
using Short4 = std::array<std::int16_t, 4>;

constexpr const char* name = "EXT_meshopt_compression";

/// A view of `count` elements of `stride` bytes that stand compressed in the buffer, as `mode` and `filter` say. The
/// view itself lies in a fallback buffer without data.
int add_compressed_view(GltfBuilder& builder, const Bytes& encoded, std::size_t count, std::size_t stride,
                        const char* mode, const char* filter = "NONE") {
    const int stored = builder.view(encoded);
    const json where = builder.document["bufferViews"][stored];
    builder.document["bufferViews"][stored] = {{"buffer", 1},
                                               {"byteLength", count * stride},
                                               {"extensions",
                                                {{name,
                                                  {{"buffer", 0},
                                                   {"byteOffset", where["byteOffset"]},
                                                   {"byteLength", where["byteLength"]},
                                                   {"byteStride", stride},
                                                   {"count", count},
                                                   {"mode", mode},
                                                   {"filter", filter}}}}}};
    if (std::strcmp(mode, "ATTRIBUTES") == 0) builder.document["bufferViews"][stored]["byteStride"] = stride;
    return stored;
}

/// The file with its fallback buffer.
std::string with_fallback(const GltfBuilder& builder) {
    json document = json::parse(builder.gltf());
    document["extensionsRequired"] = {name};
    document["buffers"].push_back({{"byteLength", 1000000}, {"extensions", {{name, {{"fallback", true}}}}}});
    return document.dump();
}

template <typename T> Bytes encode_vertices(const std::vector<T>& values) {
    Bytes bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(T)));
    return bytes;
}

Bytes encode_triangles(const std::vector<unsigned>& indices, std::size_t vertices) {
    Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

Bytes encode_sequence(const std::vector<unsigned>& indices, std::size_t vertices) {
    Bytes bytes(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

/// A wavy sheet of side x side vertices.
struct Sheet {
    static constexpr unsigned side = 20;
    std::vector<Float3> positions;
    std::vector<unsigned> triangles;
    Sheet() {
        for (unsigned i = 0; i < side * side; ++i) {
            const float x = float(i % side), y = float(i / side);
            positions.push_back({x, y, std::sin(x) * std::cos(0.5f * y)});
        }
        for (unsigned y = 0; y + 1 < side; ++y) {
            for (unsigned x = 0; x + 1 < side; ++x) {
                const unsigned a = y * side + x, b = a + 1, c = a + side, d = c + 1;
                triangles.insert(triangles.end(), {a, b, c, c, b, d});
            }
        }
    }
};

std::vector<std::array<glm::dvec3, 3>> corners(const Scene& scene) {
    std::vector<std::array<glm::dvec3, 3>> all;
    for (const Triangle& t : scene.triangles) {
        // The codec may turn a triangle's corners round: each begins with its least corner.
        std::array<glm::dvec3, 3> p = {scene.positions[t.vertex[0]], scene.positions[t.vertex[1]],
                                       scene.positions[t.vertex[2]]};
        const auto is_less = [](const glm::dvec3& a, const glm::dvec3& b) {
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        };
        std::rotate(p.begin(), std::min_element(p.begin(), p.end(), is_less), p.end());
        all.push_back(p);
    }
    return all;
}

TEST(GltfMeshopt, CompressedMeshesAreTheMeshes) {
    const Sheet sheet;
    GltfBuilder plain;
    const int plain_positions = plain.float3(sheet.positions);
    plain.mesh({{"attributes", {{"POSITION", plain_positions}}},
                {"indices", plain.accessor(plain.view(sheet.triangles), "SCALAR", 5125, sheet.triangles.size())}});
    plain.add("nodes", {{"mesh", 0}});
    const Scene expected = load(plain);
    ASSERT_EQ(expected.triangles.size(), sheet.triangles.size() / 3);

    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        for (const std::size_t index_size : {2, 4}) {
            SCOPED_TRACE(fmt::format("{} of {} bytes", mode, index_size));
            GltfBuilder builder;
            const std::size_t vertices = sheet.positions.size(), indices = sheet.triangles.size();
            const Bytes encoded = std::string(mode) == "INDICES" ? encode_sequence(sheet.triangles, vertices)
                                                                 : encode_triangles(sheet.triangles, vertices);
            const int position_view =
                add_compressed_view(builder, encode_vertices(sheet.positions), vertices, 12, "ATTRIBUTES");
            const int positions = builder.accessor(position_view, "VEC3", 5126, vertices);
            const int index_view = add_compressed_view(builder, encoded, indices, index_size, mode);
            builder.mesh({{"attributes", {{"POSITION", positions}}},
                          {"indices", builder.accessor(index_view, "SCALAR", index_size == 2 ? 5123 : 5125, indices)}});
            builder.add("nodes", {{"mesh", 0}});
            EXPECT_LT(builder.bytes().size(), plain.bytes().size() / 2);
            EXPECT_EQ(corners(test::load_text(with_fallback(builder))), corners(expected));
        }
    }
}

/// A triangle whose normals are `filtered` data of `stride` bytes an element.
Scene load_filtered_normals(const Bytes& encoded, std::size_t stride, int component, const char* filter) {
    GltfBuilder builder = test::one_triangle();
    const int view = add_compressed_view(builder, encoded, 3, stride, "ATTRIBUTES", filter);
    const int normals = builder.accessor(view, "VEC3", component, 3);
    builder.document["accessors"][normals]["normalized"] = component != 5126;
    builder.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
    return test::load_text(with_fallback(builder));
}

const std::vector<glm::vec3> some_normals = {glm::normalize(glm::vec3(1, 2, 3)),
                                             glm::normalize(glm::vec3(-3, 1, -0.5f)), glm::vec3(0, 0, 1)};

void expect_normals(const Scene& scene, float tolerance) {
    ASSERT_EQ(scene.normals.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_LE(glm::length(scene.normals[i] - some_normals[i]), tolerance)
            << i << ": (" << scene.normals[i].x << ", " << scene.normals[i].y << ", " << scene.normals[i].z << ")";
    }
}

TEST(GltfMeshopt, UndoesTheOctahedralFilter) {
    std::vector<glm::vec4> source;
    for (const glm::vec3& n : some_normals) source.emplace_back(n, 1.0f);
    std::vector<std::array<std::int8_t, 4>> bytes(3);
    meshopt_encodeFilterOct(bytes.data(), 3, 4, 8, &source[0].x);
    expect_normals(load_filtered_normals(encode_vertices(bytes), 4, 5120, "OCTAHEDRAL"), 0.02f);
    std::vector<Short4> shorts(3);
    meshopt_encodeFilterOct(shorts.data(), 3, 8, 16, &source[0].x);
    expect_normals(load_filtered_normals(encode_vertices(shorts), 8, 5122, "OCTAHEDRAL"), 1e-4f);
}

TEST(GltfMeshopt, UndoesTheExponentialFilter) {
    std::vector<std::array<std::uint32_t, 3>> words(3);
#if MESHOPTIMIZER_VERSION >= 190
    meshopt_encodeFilterExp(words.data(), 3, 12, 20, &some_normals[0].x, meshopt_EncodeExpSharedVector);
#else
    meshopt_encodeFilterExp(words.data(), 3, 12, 20, &some_normals[0].x);
#endif
    expect_normals(load_filtered_normals(encode_vertices(words), 12, 5126, "EXPONENTIAL"), 1e-5f);
}

TEST(GltfMeshopt, UndoesTheQuaternionFilter) {
    const float half = float(std::numbers::sqrt2 / 2.0);
    const std::vector<std::array<float, 4>> rotations = {{0, 0, half, half}, {0, 0, 0, 1}};
    std::vector<Short4> encoded(2);
    meshopt_encodeFilterQuat(encoded.data(), 2, 8, 16, rotations[0].data());
    GltfBuilder builder = test::one_triangle();
    const int view = add_compressed_view(builder, encode_vertices(encoded), 2, 8, "ATTRIBUTES", "QUATERNION");
    const int accessor = builder.accessor(view, "VEC4", 5122, 2);
    builder.document["accessors"][accessor]["normalized"] = true;
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = accessor;
    const Scene scene = test::load_text(with_fallback(builder));
    ASSERT_EQ(scene.positions.size(), 6u);
    EXPECT_LE(glm::length(scene.positions[1] - glm::dvec3(0, 1, 0)), 1e-4) << "x turned by 90 degrees about z";
    EXPECT_LE(glm::length(scene.positions[2] - glm::dvec3(-1, 0, 0)), 1e-4) << "y turned by 90 degrees about z";
    EXPECT_LE(glm::length(scene.positions[4] - glm::dvec3(1, 0, 0)), 1e-4) << "not turned";
}

TEST(GltfMeshopt, DecompressesAnImage) {
    std::string png = test::one_texel_png({1, 2, 3, 4});
    png.resize((png.size() + 3) / 4 * 4);
    std::vector<std::array<char, 4>> words(png.size() / 4);
    std::memcpy(words.data(), png.data(), png.size());
    GltfBuilder builder = test::one_triangle();
    const int view = add_compressed_view(builder, encode_vertices(words), words.size(), 4, "ATTRIBUTES");
    builder.document["bufferViews"][view].erase("byteStride");
    builder.add("textures", {{"source", builder.add("images", {{"bufferView", view}, {"mimeType", "image/png"}})}});
    builder.document["meshes"][0]["primitives"][0]["material"] =
        builder.add("materials", {{"normalTexture", {{"index", 0}}}});
    EXPECT_EQ(test::load_text(with_fallback(builder)).images.at(0).rgba, (Bytes{1, 2, 3, 4}));
}

// ---- hostile files ----

/// The one triangle with compressed positions after a change to the extension, of `length` bytes where that is given.
std::string changed(const json& changes, std::optional<std::size_t> length = {}) {
    GltfBuilder builder = test::one_triangle();
    Bytes encoded = encode_vertices(std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    encoded.resize(length.value_or(encoded.size()));
    const int view = add_compressed_view(builder, encoded, 3, 12, "ATTRIBUTES");
    builder.document["bufferViews"][view]["extensions"][name].merge_patch(changes);
    builder.document["accessors"][0]["bufferView"] = view;
    return with_fallback(builder);
}

TEST(HostileMeshopt, IsRefusedByALineThatNamesIt) {
    const std::string object = fmt::format("bufferViews[1].extensions.{}", name);
    EXPECT_EQ(test::load_text(changed(json::object())).triangles.size(), 1u);
    expect_bad_scene(changed({{"mode", "POINTS"}}), {object + ".mode is \"POINTS\"", "TRIANGLES"});
    expect_bad_scene(changed({{"filter", "WAVELET"}}), {object + ".filter is \"WAVELET\"", "OCTAHEDRAL"});
    expect_bad_scene(changed({{"buffer", 7}}), {object + ".buffer is 7", "buffers has 2"});
    expect_bad_scene(changed({{"buffer", 1}}), {"buffers[1] is absent", "fallback"});
    expect_bad_scene(changed({{"byteLength", 100000}}), {object + " is 100000 bytes from", "buffers[0] has"});
    expect_bad_scene(changed({{"count", 2}}), {object + ".count is 2", "they must fill the 36"});
    expect_bad_scene(changed({{"count", 9007199254740992u}}), {object + ".count is 9007199254740992"});
    expect_bad_scene(changed({{"byteStride", 6}}), {object + ".byteStride is 6", "multiple of 4"});
    expect_bad_scene(changed({{"byteStride", 260}}), {object + ".byteStride is 260", "2 to 256"});
    expect_bad_scene(changed({{"filter", "OCTAHEDRAL"}}), {object + ".byteStride is 12", "OCTAHEDRAL needs 4 or 8"});
    expect_bad_scene(changed({{"filter", "QUATERNION"}}), {object + ".byteStride is 12", "QUATERNION needs 8"});
    expect_bad_scene(changed({{"mode", "INDICES"}}), {object + ".byteStride is 12", "2 or 4 bytes"});
    expect_bad_scene(changed({{"mode", "TRIANGLES"}, {"byteStride", 2}, {"count", 17}}),
                     {object + ".count is 17", "3 indices"});
    expect_bad_scene(changed({{"mode", "INDICES"}, {"byteStride", 2}, {"count", 18}, {"filter", "EXPONENTIAL"}}),
                     {object + ".filter is EXPONENTIAL", "ATTRIBUTES"});
    expect_bad_scene(changed({{"mode", "INDICES"}, {"byteStride", 2}, {"count", 18}}),
                     {object + " is broken", "INDICES"});
}

TEST(HostileMeshopt, EveryTruncationIsRefused) {
    const std::size_t size = encode_vertices(std::vector<Float3>(3)).size();
    for (std::size_t length = 1; length < size; ++length) {
        SCOPED_TRACE(length);
        expect_bad_scene(changed(json::object(), length), {"bufferViews[1]"});
    }
}

TEST(HostileMeshopt, ACountThatTheDataCannotHoldIsRefusedBeforeMemoryIsAllocated) {
    GltfBuilder builder = test::one_triangle();
    const std::size_t count = std::size_t(1) << 14;
    const int view = add_compressed_view(builder, Bytes(100), count, 16, "ATTRIBUTES");
    builder.document["accessors"][0]["bufferView"] = view;
    json document = json::parse(with_fallback(builder));
    document["buffers"][1]["byteLength"] = count * 16;
    expect_bad_scene(document.dump(), {"byteLength is 100", "too few for 262144 bytes"});
    document["bufferViews"][view]["byteLength"] = document["buffers"][1]["byteLength"] = std::size_t(1) << 31;
    expect_bad_scene(document.dump(), {"bytes of the compressed bufferViews together is 2147483648; the limit is "});
}

}  // namespace
}  // namespace vkcppm
