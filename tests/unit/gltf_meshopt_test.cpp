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

#include "scene/gltf/meshopt_v1.h"
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

std::vector<std::array<glm::dvec3, 3>> corners_from_least(const Scene& scene) {
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
            EXPECT_EQ(corners_from_least(test::load_text(with_fallback(builder))), corners_from_least(expected));
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

// ---- KHR_meshopt_compression ----

/// Version 1 of the codec of attributes by its specification (appendix A), of one block: byte b of the elements is
/// stored with control mode control[b], and where that is 0 or 1 with the most bits that it has.
Bytes encode_v1(const Bytes& elements, std::size_t stride, const Bytes& channels, const std::vector<int>& control) {
    const std::size_t count = elements.size() / stride;
    std::vector<Bytes> deltas(stride, Bytes(count));
    Bytes before(elements.begin(), elements.begin() + std::ptrdiff_t(stride));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t channel = 0; channel < stride / 4; ++channel) {
            std::uint32_t was = 0, is = 0, delta = 0;
            std::memcpy(&was, &before[4 * channel], 4);
            std::memcpy(&is, &elements[i * stride + 4 * channel], 4);
            const int mode = channels[channel] & 15, rotation = channels[channel] >> 4;
            if (mode == 2) delta = rotation == 0 ? was ^ is : (was ^ is) >> rotation | (was ^ is) << (32 - rotation);
            for (int b = 0; mode == 0 && b < 4; ++b) {
                const auto step = std::uint8_t((is >> 8 * b) - (was >> 8 * b));
                delta |= std::uint32_t(std::uint8_t(step & 0x80 ? ~(step << 1) : step << 1)) << 8 * b;
            }
            for (int w = 0; mode == 1 && w < 2; ++w) {
                const auto step = std::uint16_t((is >> 16 * w) - (was >> 16 * w));
                delta |= std::uint32_t(std::uint16_t(step & 0x8000 ? ~(step << 1) : step << 1)) << 16 * w;
            }
            for (int b = 0; b < 4; ++b) deltas[4 * channel + b][i] = std::uint8_t(delta >> 8 * b);
        }
        before.assign(elements.begin() + std::ptrdiff_t(i * stride),
                      elements.begin() + std::ptrdiff_t((i + 1) * stride));
    }
    Bytes stream{0xa1};
    for (std::size_t c = 0; c < stride / 4; ++c) {
        stream.push_back(
            std::uint8_t(control[4 * c] | control[4 * c + 1] << 2 | control[4 * c + 2] << 4 | control[4 * c + 3] << 6));
    }
    for (std::size_t b = 0; b < stride; ++b) {
        if (control[b] == 3) stream.insert(stream.end(), deltas[b].begin(), deltas[b].end());
        if (control[b] >= 2) continue;
        const std::size_t groups = (count + 15) / 16;
        deltas[b].resize(16 * groups);
        // Groups in turn: by four or eight bits, the last width of the mode; by the one before it; by the first.
        static constexpr unsigned widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
        Bytes header((groups + 3) / 4), data;
        for (std::size_t g = 0; g < groups; ++g) {
            const Bytes group(deltas[b].begin() + std::ptrdiff_t(16 * g),
                              deltas[b].begin() + std::ptrdiff_t(16 * g + 16));
            const bool is_zero = std::ranges::all_of(group, [](std::uint8_t d) { return d == 0; });
            const std::size_t choice = is_zero && control[b] == 0 ? 0 : 3 - g % 3;
            const unsigned bits = widths[control[b]][choice];
            header[g / 4] |= std::uint8_t(choice << g % 4 * 2);
            if (bits == 0) continue;
            Bytes packed(2 * bits), escaped;
            const unsigned most = (1u << bits) - 1;
            for (unsigned i = 0; i < 16; ++i) {
                const unsigned value = bits == 8 ? group[i] : std::min<unsigned>(group[i], most);
                if (bits < 8 && value == most) escaped.push_back(group[i]);
                const unsigned at = i * bits % 8;
                packed[i * bits / 8] |= std::uint8_t(value << (bits == 1 ? at : 8 - bits - at));
            }
            data.insert(data.end(), packed.begin(), packed.end());
            data.insert(data.end(), escaped.begin(), escaped.end());
        }
        stream.insert(stream.end(), header.begin(), header.end());
        stream.insert(stream.end(), data.begin(), data.end());
    }
    const std::size_t tail = stride + channels.size();
    stream.resize(stream.size() + (tail < 24 ? 24 - tail : 0));
    stream.insert(stream.end(), elements.begin(), elements.begin() + std::ptrdiff_t(stride));
    stream.insert(stream.end(), channels.begin(), channels.end());
    return stream;
}

TEST(KhrMeshopt, DecodesTheGroupOfTheSpecification) {
    // Its example of four bits: 16 deltas, then two that did not fit; here as byte 0 of elements of four bytes.
    const Bytes group = {0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
    const std::vector<int> steps = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    Bytes stream = {0xa1, 0b10101000, 0x03};
    stream.insert(stream.end(), group.begin(), group.end());
    stream.resize(stream.size() + 24 - 5);
    stream.insert(stream.end(), {100, 7, 8, 9, 0});
    Bytes elements(64);
    ASSERT_TRUE(decode_meshopt_v1(stream, 4, elements));
    int value = 100;
    for (std::size_t i = 0; i < 16; ++i) {
        value += steps[i];
        EXPECT_EQ(elements[4 * i], std::uint8_t(value)) << i;
        EXPECT_EQ(elements[4 * i + 2], 8) << i;
    }
    for (std::size_t length = 0; length < stream.size(); ++length) {
        const Bytes cut(stream.begin(), stream.begin() + std::ptrdiff_t(length));
        EXPECT_FALSE(decode_meshopt_v1(cut, 4, elements)) << length;
    }
}

TEST(KhrMeshopt, DecodesEveryModeOfChannelsAndControl) {
    Bytes elements;
    for (std::uint32_t i = 0; i < 100; ++i) {
        for (const std::uint32_t word : {i * 3u, i * i * 40503u, 0x3f800000u + i * 12345u}) {
            for (int b = 0; b < 4; ++b) elements.push_back(std::uint8_t(word >> 8 * b));
        }
    }
    for (const Bytes& channels : {Bytes{0, 1, 2}, Bytes{1, 2 | 5 << 4, 2 | 15 << 4}, Bytes{2 | 8 << 4, 0, 1}}) {
        for (int first = 0; first < 4; ++first) {
            std::vector<int> control(12);
            // Mode 2 holds where nothing changes alone: byte 3 of the first word.
            for (int b = 0; b < 12; ++b) control[b] = (b + first) % 3 == 2 ? 3 : (b + first) % 2;
            if ((channels[0] & 15) < 2) control[3] = 2;
            const Bytes stream = encode_v1(elements, 12, channels, control);
            Bytes decoded(elements.size());
            ASSERT_TRUE(decode_meshopt_v1(stream, 12, decoded)) << first;
            EXPECT_EQ(decoded, elements) << first;
            Bytes longer = stream;
            longer.insert(longer.begin() + 1, 0);
            EXPECT_FALSE(decode_meshopt_v1(longer, 12, decoded) && decoded == elements);
        }
    }
    for (const std::uint8_t bad : {0x03, 0x10, 0x21, 0x0f}) {
        Bytes decoded(elements.size());
        EXPECT_FALSE(decode_meshopt_v1(encode_v1(elements, 12, {0, bad, 0}, std::vector<int>(12, 3)), 12, decoded));
    }
}

TEST(KhrMeshopt, LoadsAMeshOfIt) {
    GltfBuilder builder = test::one_triangle();
    const std::vector<Float3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Bytes elements(36);
    std::memcpy(elements.data(), positions.data(), 36);
    const int view =
        add_compressed_view(builder, encode_v1(elements, 12, {2, 2, 2}, std::vector<int>(12, 3)), 3, 12, "ATTRIBUTES");
    builder.document["accessors"][0]["bufferView"] = view;
    json document = json::parse(with_fallback(builder));
    json& extensions = document["bufferViews"][view]["extensions"];
    extensions["KHR_meshopt_compression"] = extensions[name];
    extensions.erase(name);
    document["extensionsRequired"] = document["extensionsUsed"] = {"KHR_meshopt_compression"};
    document["buffers"][1] = {{"byteLength", 1000000},
                              {"extensions", {{"KHR_meshopt_compression", {{"fallback", true}}}}}};
    const Scene scene = test::load_text(document.dump());
    ASSERT_EQ(scene.positions.size(), 3u);
    EXPECT_EQ(scene.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(test::warnings_with(scene, {"extensions"}), 0);
    // What EXT_meshopt_compression has, it has as well.
    document["bufferViews"][view]["extensions"]["KHR_meshopt_compression"]["filter"] = "OCTAHEDRAL";
    expect_bad_scene(document.dump(), {"KHR_meshopt_compression.byteStride is 12", "OCTAHEDRAL needs 4 or 8"});
    document["bufferViews"][view]["extensions"]["KHR_meshopt_compression"]["filter"] = "COLOR";
    expect_bad_scene(document.dump(), {"KHR_meshopt_compression.byteStride is 12", "COLOR needs 4 or 8"});
}

TEST(KhrMeshopt, TurnsLumaAndChromaIntoColours) {
    // All eight bits: y, co, cg and an alpha of seven bits below the mark;
    // r = y + co - cg, g = y + cg, b = y - co - cg.
    Bytes bytes = {100, 20, 10, 0x80 | 0x7f, 10, std::uint8_t(-4), std::uint8_t(-6), 0x80 | 0x20};
    decode_meshopt_colors(bytes, 4);
    EXPECT_EQ(bytes, (Bytes{110, 110, 70, 255, 12, 4, 20, 64}));
    // Five bits in eight: 31 is white.
    Bytes few = {31, 0, 0, 0x10 | 0x0f};
    decode_meshopt_colors(few, 4);
    EXPECT_EQ(few, (Bytes{255, 255, 255, 255}));
    std::vector<std::uint16_t> shorts = {1000, 200, std::uint16_t(-100), 0x8000 | 0x7fff};
    Bytes wide(8);
    std::memcpy(wide.data(), shorts.data(), 8);
    decode_meshopt_colors(wide, 8);
    std::memcpy(shorts.data(), wide.data(), 8);
    EXPECT_EQ(shorts, (std::vector<std::uint16_t>{1300, 900, 900, 65535}));
    // What is nothing stays within its bytes.
    Bytes nothing = {255, 127, 128, 0};
    decode_meshopt_colors(nothing, 4);
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
