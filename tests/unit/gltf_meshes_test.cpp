// Vertex attributes, morph targets and instances of glTF files against values worked out by hand.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "support/files/pictures.h"
#include "support/scenes/loading.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::all_warnings;
using test::expect_bad_scene;
using test::Float3;
using test::GltfBuilder;
using test::load;
using test::warnings_with;

using Float2 = std::array<float, 2>;
using Float4 = std::array<float, 4>;

/// An attribute of the one primitive: elements of N components of type T, padded to 4 bytes.
template <typename T, std::size_t N>
int add_attribute(GltfBuilder& builder, const char* name, int component, bool normalized,
                  const std::vector<std::array<T, N>>& values) {
    constexpr std::size_t stride = (N * sizeof(T) + 3) / 4 * 4;
    std::vector<char> bytes(values.size() * stride);
    for (std::size_t i = 0; i < values.size(); ++i) std::memcpy(bytes.data() + i * stride, &values[i], N * sizeof(T));
    const int view = builder.view(bytes);
    builder.document["bufferViews"][view]["byteStride"] = stride;
    const int accessor = builder.accessor(view, fmt::format("VEC{}", N).c_str(), component, values.size());
    builder.document["accessors"][accessor]["normalized"] = normalized;
    builder.primitive()["attributes"][name] = accessor;
    return accessor;
}

void add_normals(GltfBuilder& builder) {
    builder.primitive()["attributes"]["NORMAL"] = builder.float3({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
}

/// A material of the primitive with a texture of one set; a normal map where `is_normal`.
void add_texture(GltfBuilder& builder, int set, bool is_normal = false) {
    const json info = {{"index", builder.texture(test::one_texel_png({9, 9, 9, 9}))}, {"texCoord", set}};
    builder.primitive()["material"] =
        builder.add("materials", is_normal ? json{{"normalTexture", info}}
                                           : json{{"pbrMetallicRoughness", {{"baseColorTexture", info}}}});
}

/// The values of a vertex vector at the corners of triangle 0.
template <typename T> std::array<T, 3> at_corners(const Scene& scene, const std::vector<T>& values) {
    EXPECT_EQ(values.size(), scene.positions.size());
    if (values.size() != scene.positions.size()) return {};
    const auto& vertex = scene.triangles.at(0).vertex;
    return {values[vertex[0]], values[vertex[1]], values[vertex[2]]};
}

// ---- what is empty ----

/// Parses what a builder writes, for what it has no way to add.
json document_of(const GltfBuilder& builder) { return json::parse(builder.gltf()); }

// As three.js writes a geometry without vertices.
TEST(GltfEmpty, GeometryWithNothingInItIsSkipped) {
    json document = document_of(test::one_triangle());
    document["buffers"].push_back({{"byteLength", 0}, {"uri", "data:"}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 0}, {"byteStride", 12}});
    document["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 0}, {"min", {nullptr}}});
    document["accessors"].push_back({{"componentType", 5123}, {"type", "SCALAR"}, {"count", 0}});
    const json empty = {{"attributes", {{"POSITION", 1}, {"NORMAL", 1}}}};
    const json without_corners = {{"attributes", {{"POSITION", 0}}}, {"indices", 2}};
    document["meshes"].push_back({{"primitives", {empty, without_corners}}});
    document["meshes"].push_back({{"name", "without primitives"}});
    document["nodes"].push_back({{"mesh", 1}});
    document["nodes"].push_back({{"mesh", 2}});
    const Scene scene = test::load_text(document.dump());
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_ONE_WARNING(scene, "meshes[1].primitives[0] (and 1 more)", "skipped, it has no triangle");
}

TEST(GltfEmpty, ASparseAccessorThatReplacesNothingIsItsBase) {
    GltfBuilder builder = test::one_triangle();
    const int view = builder.view<std::uint8_t>({0});
    builder.document["accessors"][0]["sparse"] = {
        {"count", 0}, {"indices", {{"bufferView", view}, {"componentType", 5121}}}, {"values", {{"bufferView", view}}}};
    EXPECT_EQ(load(builder).positions.at(1), glm::dvec3(1, 0, 0));
}

// ---- texture coordinates ----

template <typename T>
void expect_uv_of_type(int component, bool normalized, const std::vector<std::array<T, 2>>& values,
                       const std::array<glm::vec2, 3>& expected) {
    SCOPED_TRACE(fmt::format("{} {}", component, normalized));
    for (const int set : {0, 1}) {
        GltfBuilder builder = test::one_triangle();
        add_attribute(builder, set == 0 ? "TEXCOORD_0" : "TEXCOORD_1", component, normalized, values);
        add_texture(builder, set);
        const Scene scene = load(builder);
        EXPECT_EQ(at_corners(scene, scene.uv[set]), expected);
        EXPECT_TRUE(scene.uv[1 - set].empty());
    }
}

TEST(GltfUv, ReadsEveryTypeOfBothSets) {
    expect_uv_of_type<float>(5126, false, {{-1.5f, 0}, {2, 0.25f}, {0, 7}},
                             {glm::vec2(-1.5f, 0), glm::vec2(2, 0.25f), glm::vec2(0, 7)});
    expect_uv_of_type<std::uint8_t>(5121, true, {{0, 255}, {51, 0}, {102, 204}},
                                    {glm::vec2(0, 1), glm::vec2(0.2f, 0), glm::vec2(0.4f, 0.8f)});
    expect_uv_of_type<std::uint16_t>(5123, true, {{0, 65535}, {13107, 0}, {26214, 1}},
                                     {glm::vec2(0, 1), glm::vec2(0.2f, 0), glm::vec2(0.4f, float(1.0 / 65535))});
    expect_uv_of_type<std::int8_t>(5120, true, {{-128, 127}, {-127, 0}, {0, 0}},
                                   {glm::vec2(-1, 1), glm::vec2(-1, 0), glm::vec2(0, 0)});
    expect_uv_of_type<std::int8_t>(5120, false, {{-128, 127}, {3, 0}, {0, 0}},
                                   {glm::vec2(-128, 127), glm::vec2(3, 0), glm::vec2(0, 0)});
    expect_uv_of_type<std::int16_t>(5122, true, {{-32768, 32767}, {0, 0}, {0, 0}},
                                    {glm::vec2(-1, 1), glm::vec2(0, 0), glm::vec2(0, 0)});
    expect_uv_of_type<std::uint16_t>(5123, false, {{4096, 0}, {0, 9}, {0, 0}},
                                     {glm::vec2(4096, 0), glm::vec2(0, 9), glm::vec2(0, 0)});
}

TEST(GltfUv, AreReadWhereATextureNeedsThem) {
    GltfBuilder builder = test::one_triangle();
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{0, 0}, {1, 0}, {0, 1}});
    EXPECT_TRUE(load(builder).uv[0].empty());
    add_texture(builder, 1);
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.uv[0].empty());
    EXPECT_TRUE(scene.uv[1].empty());
    EXPECT_ONE_WARNING(scene, "TEXCOORD_1 of meshes[0].primitives[0]", "missing");
}

TEST(GltfUv, AreZeroForPrimitivesThatHaveNone) {
    GltfBuilder builder = test::one_triangle();
    const json bare = builder.primitive();
    builder.document["meshes"][0]["primitives"] = {bare, bare, bare};
    json& textured = builder.document["meshes"][0]["primitives"][1];
    textured["attributes"]["TEXCOORD_0"] =
        builder.accessor(builder.view(std::vector<Float2>{{1, 2}, {3, 4}, {5, 6}}), "VEC2", 5126, 3);
    textured["material"] =
        builder.add("materials", {{"normalTexture", {{"index", builder.texture(test::one_texel_png({0, 0, 0, 0}))}}}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 3u);
    const glm::vec2 none(0);
    EXPECT_EQ(scene.uv[0], (std::vector<glm::vec2>{none, none, none, {1, 2}, {3, 4}, {5, 6}, none, none, none}));
}

TEST(GltfUv, SeparateTheVerticesOfPrimitivesThatShareTheRest) {
    GltfBuilder builder = test::one_triangle();
    add_normals(builder);
    add_texture(builder, 0);
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{0, 0}, {1, 0}, {0, 1}});
    const json one = builder.primitive();
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{5, 5}, {6, 5}, {5, 6}});
    const json other = builder.primitive();
    builder.document["meshes"][0]["primitives"] = {one, other, one};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.uv[0], (std::vector<glm::vec2>{{0, 0}, {1, 0}, {0, 1}, {5, 5}, {6, 5}, {5, 6}}));
    EXPECT_EQ(scene.triangles.at(2).vertex, scene.triangles.at(0).vertex);
}

TEST(GltfUv, AreZeroWithAWarningWhereTheyAreNoNumbers) {
    GltfBuilder builder = test::one_triangle();
    add_texture(builder, 0);
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{test::float_nan, 1}, {1e30f, 2}, {3, 4}});
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.uv[0]), (std::array<glm::vec2, 3>{glm::vec2(0), glm::vec2(0), glm::vec2(3, 4)}));
    EXPECT_ONE_WARNING(scene, "accessors[1]", "texture coordinates");
}

// ---- colours ----

template <typename T, std::size_t N>
void expect_colors_of_type(int component, const std::vector<std::array<T, N>>& values,
                           const std::array<glm::vec4, 3>& expected) {
    SCOPED_TRACE(fmt::format("{} x {}", component, N));
    GltfBuilder builder = test::one_triangle();
    add_attribute(builder, "COLOR_0", component, component != 5126, values);
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.colors), expected);
    EXPECT_EQ(warnings_with(scene, {"colour"}), 0) << all_warnings(scene);
}

TEST(GltfColor, ReadsEveryTypeWithAndWithoutAlpha) {
    const std::array<glm::vec4, 3> opaque = {
        {{0.0f, 0.2f, 1.0f, 1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.4f, 1.0f}}};
    const std::array<glm::vec4, 3> clear = {
        {{0.0f, 0.2f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f, 0.8f}, {0.0f, 0.0f, 0.4f, 1.0f}}};
    expect_colors_of_type<float, 3>(5126, {{0, 0.2f, 1}, {1, 0, 0}, {0, 0, 0.4f}}, opaque);
    expect_colors_of_type<float, 4>(5126, {{0, 0.2f, 1, 0}, {1, 0, 0, 0.8f}, {0, 0, 0.4f, 1}}, clear);
    expect_colors_of_type<std::uint8_t, 3>(5121, {{0, 51, 255}, {255, 0, 0}, {0, 0, 102}}, opaque);
    expect_colors_of_type<std::uint8_t, 4>(5121, {{0, 51, 255, 0}, {255, 0, 0, 204}, {0, 0, 102, 255}}, clear);
    expect_colors_of_type<std::uint16_t, 3>(5123, {{0, 13107, 65535}, {65535, 0, 0}, {0, 0, 26214}}, opaque);
    expect_colors_of_type<std::uint16_t, 4>(5123, {{0, 13107, 65535, 0}, {65535, 0, 0, 52428}, {0, 0, 26214, 65535}},
                                            clear);
}

TEST(GltfColor, WhiteThroughoutIsNone) {
    GltfBuilder builder = test::one_triangle();
    add_attribute<std::uint8_t, 3>(builder, "COLOR_0", 5121, true, {{255, 255, 255}, {255, 255, 255}, {255, 255, 255}});
    EXPECT_TRUE(load(builder).colors.empty());
}

TEST(GltfColor, IsWhiteForPrimitivesThatHaveNone) {
    GltfBuilder builder = test::one_triangle();
    const json bare = builder.primitive();
    add_attribute<float, 3>(builder, "COLOR_0", 5126, false, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    builder.document["meshes"][0]["primitives"] = {bare, builder.primitive(), bare};
    const Scene scene = load(builder);
    const glm::vec4 white(1), black(0, 0, 0, 1);
    EXPECT_EQ(scene.colors, (std::vector<glm::vec4>{white, white, white, black, black, black, white, white, white}));
}

TEST(GltfColor, ClampsWhatIsOutsideWithAWarning) {
    GltfBuilder builder = test::one_triangle();
    add_attribute<float, 3>(builder, "COLOR_0", 5126, false, {{2, 0, 0}, {0, -1, 0}, {0, 0, 0.5f}});
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.colors),
              (std::array<glm::vec4, 3>{glm::vec4(1, 0, 0, 1), glm::vec4(0, 0, 0, 1), glm::vec4(0, 0, 0.5f, 1)}));
    EXPECT_ONE_WARNING(scene, "accessors[1] (and 1 more)", "colours");
}

// ---- tangents ----

/// A triangle with normals (0, 0, 1), a normal map, and these tangents.
GltfBuilder with_tangents(const std::vector<Float4>& tangents) {
    GltfBuilder builder = test::one_triangle();
    add_normals(builder);
    add_texture(builder, 0, true);
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{0, 0}, {1, 0}, {0, 1}});
    add_attribute(builder, "TANGENT", 5126, false, tangents);
    return builder;
}

TEST(GltfTangent, TurnsWithItsNodeAndFlipsItsSignInAMirror) {
    GltfBuilder builder = with_tangents({{1, 0, 0, 1}, {0.6f, 0.8f, 0, -1}, {0, 2, 0, 1}});
    builder.document["nodes"] = {{{"mesh", 0}, {"scale", {2, 1, 1}}}};
    const Scene stretched = load(builder);
    const glm::vec3 slanted = glm::normalize(glm::vec3(1.2f, 0.8f, 0));
    const auto expect_tangents = [](const Scene& scene, const std::array<glm::vec4, 3>& expected) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec4 t = at_corners(scene, scene.tangents)[k];
            EXPECT_LE(glm::length(t - expected[k]), 1e-6f)
                << k << ": (" << t.x << ", " << t.y << ", " << t.z << ", " << t.w << ")";
        }
    };
    expect_tangents(stretched, {glm::vec4(1, 0, 0, 1), glm::vec4(slanted, -1), glm::vec4(0, 1, 0, 1)});
    builder.document["nodes"] = {{{"mesh", 0}, {"scale", {-2, 1, 1}}}};
    const Scene mirrored = load(builder);  // the winding turns over: corners 1 and 2 change places
    expect_tangents(mirrored,
                    {glm::vec4(-1, 0, 0, -1), glm::vec4(0, 1, 0, -1), glm::vec4(-slanted.x, slanted.y, 0, 1)});
    // The bitangent w cross(n, t) is the mirror image of what it was: y stays.
    const glm::vec4 t = at_corners(mirrored, mirrored.tangents)[0];
    EXPECT_EQ(t.w * glm::cross(at_corners(mirrored, mirrored.normals)[0], glm::vec3(t)), glm::vec3(0, 1, 0));
}

TEST(GltfTangent, WithoutDirectionIsNone) {
    const Scene scene = load(with_tangents({{0, 0, 0, 1}, {test::float_nan, 0, 0, 1}, {1, 0, 0, 1}}));
    EXPECT_EQ(at_corners(scene, scene.tangents),
              (std::array<glm::vec4, 3>{glm::vec4(0), glm::vec4(0), glm::vec4(1, 0, 0, 1)}));
}

TEST(GltfTangent, ReadsQuantizedOnes) {
    GltfBuilder builder = with_tangents({{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}});
    add_attribute<std::int8_t, 4>(builder, "TANGENT", 5120, true,
                                  {{127, 0, 0, 127}, {0, -127, 0, -127}, {0, 0, 64, 127}});
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.tangents),
              (std::array<glm::vec4, 3>{glm::vec4(1, 0, 0, 1), glm::vec4(0, -1, 0, -1), glm::vec4(0, 0, 1, 1)}));
}

TEST(GltfTangent, IsLeftOutWithoutANormalMapOrNormals) {
    GltfBuilder builder = with_tangents({{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}});
    EXPECT_FALSE(load(builder).tangents.empty());
    builder.primitive()["attributes"].erase("NORMAL");
    const Scene flat = load(builder);
    EXPECT_TRUE(flat.tangents.empty());
    EXPECT_FALSE(flat.uv[0].empty());
    builder = with_tangents({{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}});
    add_texture(builder, 0);
    EXPECT_TRUE(load(builder).tangents.empty());
}

TEST(GltfTangent, AndAllElseIsCopiedToAVertexOfItsOwnNormal) {
    GltfBuilder builder = with_tangents({{1, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, -1}});
    add_attribute<float, 3>(builder, "COLOR_0", 5126, false, {{0, 0, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}});
    builder.primitive()["attributes"]["NORMAL"] = builder.float3({{0, 0, 1}, {0, 0, 0}, {0, 0, 1}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.positions.size(), 4u);
    EXPECT_EQ(scene.triangles.at(0).vertex[1], 3u);
    EXPECT_EQ(at_corners(scene, scene.normals)[1], glm::vec3(0, 0, 1));
    EXPECT_EQ(at_corners(scene, scene.uv[0])[1], glm::vec2(1, 0));
    EXPECT_EQ(at_corners(scene, scene.colors)[1], glm::vec4(0.5f, 0, 0, 1));
    EXPECT_EQ(at_corners(scene, scene.tangents)[1], glm::vec4(0, 1, 0, 1));
}

// ---- morph targets ----

/// A triangle with normals and two targets: the first lifts by 1, the second moves vertex 1 and bends its normal.
GltfBuilder with_targets() {
    GltfBuilder builder = test::one_triangle();
    add_normals(builder);
    const int lift = builder.float3({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    const int pull = builder.float3({{0, 0, 0}, {4, 0, 0}, {0, 0, 0}});
    const int bend = builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}});
    builder.primitive()["targets"] = {{{"POSITION", lift}}, {{"POSITION", pull}, {"NORMAL", bend}}};
    return builder;
}

TEST(GltfMorph, StandsAtItsDefaultWeights) {
    GltfBuilder builder = with_targets();
    const auto corners = [](const Scene& scene, std::size_t triangle = 0) {
        std::vector<glm::dvec3> p;
        for (const std::uint32_t vertex : scene.triangles.at(triangle).vertex) p.push_back(scene.positions[vertex]);
        return p;
    };
    const std::vector<glm::dvec3> at_rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(corners(load(builder)), at_rest);
    builder.document["meshes"][0]["weights"] = {0, 0};
    EXPECT_EQ(corners(load(builder)), at_rest);
    builder.document["meshes"][0]["weights"] = {0.5, 0.25};
    const Scene scene = load(builder);
    const std::vector<glm::dvec3> moved = {{0, 0, 0.5}, {2, 0, 0.5}, {0, 1, 0.5}};
    EXPECT_EQ(corners(scene), moved);
    const glm::vec3 bent = glm::normalize(glm::vec3(0.25f, 0, 1));
    EXPECT_LE(glm::length(at_corners(scene, scene.normals)[1] - bent), 1e-6f);
    // The node's weights come before the mesh's, for that node alone.
    builder.document["nodes"] = {{{"mesh", 0}, {"weights", {2, 0}}}, {{"mesh", 0}}};
    const Scene both = load(builder);
    EXPECT_EQ(corners(both, 0), (std::vector<glm::dvec3>{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}));
    EXPECT_EQ(corners(both, 1), moved);
}

TEST(GltfMorph, ReadsASparseTargetWithoutABase) {
    GltfBuilder builder = test::one_triangle();
    const int indices = builder.view<std::uint8_t>({2}), values = builder.view<Float3>({{0, 3, 0}});
    const json sparse = {{"count", 1},
                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                         {"values", {{"bufferView", values}}}};
    const int target =
        builder.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}, {"sparse", sparse}});
    builder.primitive()["targets"] = {{{"POSITION", target}}};
    builder.document["meshes"][0]["weights"] = {1};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.positions.at(2), glm::dvec3(0, 4, 0));
}

TEST(GltfMorph, MovesTangentsButNotTheSideOfTheBitangent) {
    GltfBuilder builder = test::one_triangle();
    add_normals(builder);
    add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{0, 0}, {1, 0}, {0, 1}});
    add_attribute<float, 4>(builder, "TANGENT", 5126, false, {{1, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 0, -1}});
    add_texture(builder, 0, true);
    builder.primitive()["targets"] = {{{"TANGENT", builder.float3({{-2, 2, 0}, {0, 0, 0}, {-2, 0, 0}})}}};
    builder.document["meshes"][0]["weights"] = {0.5};
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.tangents),
              (std::array{glm::vec4(0, 1, 0, -1), glm::vec4(1, 0, 0, -1), glm::vec4(0)}));
}

TEST(GltfMorph, SaysWhichTargetsAreIgnored) {
    GltfBuilder builder = with_targets();
    builder.primitive()["targets"][1]["COLOR_0"] = builder.primitive()["targets"][0]["POSITION"];
    builder.primitive()["targets"][1]["_OURS"] = 0;
    builder.document["meshes"][0]["weights"] = {1, 0};
    EXPECT_EQ(warnings_with(load(builder), {"COLOR_0"}), 0);
    builder.document["meshes"][0]["weights"] = {0, 1, 3};
    const Scene scene = load(builder);
    EXPECT_ONE_WARNING(scene, "COLOR_0 of meshes[0].primitives[0]", "morph targets are ignored");
    EXPECT_ONE_WARNING(scene, "meshes[0].primitives[0]", "more weights than morph targets");
    EXPECT_EQ(warnings_with(scene, {"_OURS"}), 0);
    builder.document["meshes"][0]["weights"] = {0, 1};
    EXPECT_EQ(scene.positions, load(builder).positions);
}

TEST(HostileMorph, IsRefusedByALineThatNamesIt) {
    GltfBuilder builder = with_targets();
    builder.document["meshes"][0]["weights"] = {1};
    builder.primitive()["targets"][0]["POSITION"] = 99;
    expect_bad_scene(builder.gltf(), {"targets[0][\"POSITION\"] is 99", "accessors has"});
    builder.primitive()["targets"][0]["POSITION"] = builder.float3({{0, 0, 0}});
    expect_bad_scene(builder.gltf(), {"(POSITION of meshes[0].primitives[0].targets[0]) is 1", "POSITION has 3"});
    builder.primitive()["targets"] = {7};
    expect_bad_scene(builder.gltf(), {"primitives[0].targets[0] is 7", "object"});
}

// ---- corners ----

TEST(GltfCorners, ThoseAtNoPointCostTheirTriangles) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float none : {test::float_nan, infinity, -infinity}) {
        for (const bool has_normals : {false, true}) {
            GltfBuilder builder = test::one_triangle();
            builder.primitive()["attributes"]["POSITION"] =
                builder.float3({{0, none, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
            const std::vector<Float3> normals(5, {0, 0, 1});
            if (has_normals) builder.primitive()["attributes"]["NORMAL"] = builder.float3(normals);
            builder.primitive()["indices"] = builder.u16({1, 2, 3, 0, 1, 2, 2, 4, 3});
            const Scene scene = load(builder);
            EXPECT_EQ(scene.triangles.size(), 2u);
            for (const glm::dvec3& p : scene.positions) EXPECT_LE(glm::length(p), 2.0);
            EXPECT_ONE_WARNING(scene, "(POSITION of meshes[0].primitives[0])", "no finite numbers", "left out");
            builder.primitive()["indices"] = builder.u16({1, 2, 3});
            EXPECT_EQ(warnings_with(load(builder), {"finite"}), 0) << "no triangle has the vertex";
        }
    }
}

TEST(GltfCorners, ThoseThatAMorphTargetMovesToNoPointAreLeftOutWhereItDoes) {
    GltfBuilder builder = with_targets();
    builder.primitive()["targets"][0]["POSITION"] = builder.float3({{0, 0, 0}, {test::float_nan, 0, 0}, {0, 0, 0}});
    builder.document["meshes"][0]["weights"] = {0, 1};
    EXPECT_EQ(load(builder).triangles.size(), 1u);
    builder.document["meshes"][0]["weights"] = {1, 1};
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_ONE_WARNING(scene, "accessors[0] (POSITION of meshes[0].primitives[0])", "no finite numbers");
}

TEST(GltfCorners, RestartBeginsAStripAndAFanAnew) {
    for (const int mode : {5, 6}) {
        GltfBuilder builder = test::one_triangle();
        builder.primitive()["mode"] = mode;
        builder.primitive()["attributes"]["POSITION"] =
            builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}});
        const std::vector<std::uint8_t> indices =
            mode == 5 ? std::vector<std::uint8_t>{255, 0, 1, 2, 3, 255, 7, 255, 255, 4, 5, 6, 255}
                      : std::vector<std::uint8_t>{255, 0, 1, 3, 2, 255, 7, 255, 255, 4, 5, 6, 255};
        builder.primitive()["indices"] = builder.accessor(builder.view(indices), "SCALAR", 5121, indices.size());
        const Scene scene = load(builder);
        ASSERT_EQ(scene.triangles.size(), 3u);
        for (const glm::vec3& n : scene.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
        EXPECT_ONE_WARNING(scene, "meshes[0].primitives[0]", "a new strip or fan");
    }
}

// ---- instances ----

/// One triangle under EXT_mesh_gpu_instancing.
GltfBuilder with_instances(const json& attributes) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    return builder;
}

json& instance_attributes(GltfBuilder& builder) {
    return builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

void expect_near(const glm::dvec3& p, const glm::dvec3& expected, double tolerance) {
    EXPECT_LE(glm::length(p - expected), tolerance) << "(" << p.x << ", " << p.y << ", " << p.z << ")";
}

TEST(GltfInstances, AreScaledTurnedMovedAndThenPlacedByTheNode) {
    const float half = float(std::numbers::sqrt2 / 2.0);
    GltfBuilder builder = with_instances(json::object());
    builder.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const int rotations = builder.view(std::vector<Float4>{{0, 0, 0, 1}, {0, 0, half, half}});
    instance_attributes(builder) = {{"TRANSLATION", builder.float3({{0, 0, 0}, {10, 0, 0}})},
                                    {"ROTATION", builder.accessor(rotations, "VEC4", 5126, 2)},
                                    {"SCALE", builder.float3({{1, 1, 1}, {2, 3, 1}})}};
    builder.document["nodes"][0]["translation"] = {0, 0, 5};
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 2u) << all_warnings(scene);
    expect_near(scene.positions.at(1), {1, 0, 5}, 1e-12);
    // Instance 1: x to 2x to the y axis, y to 3y to -x, then 10 along x.
    expect_near(scene.positions.at(3), {10, 0, 5}, 1e-6);
    expect_near(scene.positions.at(4), {10, 2, 5}, 1e-6);
    expect_near(scene.positions.at(5), {7, 0, 5}, 1e-6);
}

TEST(GltfInstances, ReadNormalizedRotations) {
    for (const bool is_short : {false, true}) {
        SCOPED_TRACE(is_short);
        GltfBuilder builder = with_instances(json::object());
        const int view = is_short ? builder.view(std::vector<std::array<std::int16_t, 4>>{{0, 0, 32767, 0}})
                                  : builder.view(std::vector<std::array<std::int8_t, 4>>{{0, 0, 127, 0}});
        const int rotation = builder.accessor(view, "VEC4", is_short ? 5122 : 5120, 1);
        builder.document["accessors"][rotation]["normalized"] = true;
        instance_attributes(builder) = {{"ROTATION", rotation}};
        const Scene scene = load(builder);
        ASSERT_EQ(scene.triangles.size(), 1u);
        expect_near(scene.positions.at(1), {-1, 0, 0}, 1e-12);  // half a turn about z
        expect_near(scene.positions.at(2), {0, -1, 0}, 1e-12);
    }
}

TEST(GltfInstances, DropsSingularOnesWithAWarning) {
    GltfBuilder builder = with_instances(json::object());
    instance_attributes(builder) = {{"SCALE", builder.float3({{0, 1, 1}, {1, 1, 1}, {1, 0, 1}})}};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_ONE_WARNING(scene, "nodes[0] (and 1 more)", "singular");
}

TEST(GltfInstances, AQuaternionOfZerosTurnsNothing) {
    GltfBuilder builder = with_instances(json::object());
    const int zeros = builder.accessor(builder.view(std::vector<Float4>(1)), "VEC4", 5126, 1);
    instance_attributes(builder) = {{"ROTATION", zeros}};
    builder.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.positions, load(test::one_triangle()).positions);
    EXPECT_ONE_WARNING(scene, "nodes[0].rotation (and 1 more)", "taken for no rotation");
}

TEST(HostileInstances, AreRefusedByALineThatNamesThem) {
    GltfBuilder builder = with_instances(json::object());
    const int one = builder.float3({{0, 0, 0}}), two = builder.float3({{0, 0, 0}, {1, 1, 1}});
    instance_attributes(builder) = {{"SCALE", two}, {"TRANSLATION", one}};
    expect_bad_scene(builder.gltf(), {"accessors[1].count (TRANSLATION of nodes[0]", "is 1", "have 2"});
    instance_attributes(builder) = {{"ROTATION", two}};
    expect_bad_scene(builder.gltf(), {"accessors[2].type is of 3 components", "ROTATION needs 4"});
    const std::vector<Float4> infinite{{0, 0, std::numeric_limits<float>::infinity(), 0}};
    instance_attributes(builder) = {{"ROTATION", builder.accessor(builder.view(infinite), "VEC4", 5126, 1)}};
    expect_bad_scene(builder.gltf(), {"element 0 of nodes[0].extensions.EXT_mesh_gpu_instancing", "unit quaternion"});
    instance_attributes(builder) = {{"TRANSLATION", builder.float3({{0, test::float_nan, 0}})}};
    expect_bad_scene(builder.gltf(), {"world transform of element 0 of nodes[0]", "nan", "finite"});
    instance_attributes(builder) = {{"TRANSLATION", 99}};
    expect_bad_scene(builder.gltf(), {"[\"TRANSLATION\"] is 99", "accessors has"});
    builder.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"].erase("attributes");
    expect_bad_scene(builder.gltf(), {"EXT_mesh_gpu_instancing.attributes is missing"});
}

TEST(HostileInstances, AreLimitedBeforeAnyIsRead) {
    GltfBuilder builder = with_instances(json::object());
    const auto zeros = [&](std::uint64_t count) {
        return builder.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", count}});
    };
    instance_attributes(builder) = {{"TRANSLATION", zeros(std::uint64_t(1) << 50)}};
    expect_bad_scene(builder.gltf(), {"number of instances of nodes[0] is 1125899906842624; the limit is ", " bytes"});
    builder.document["nodes"].push_back(builder.document["nodes"][0]);
    instance_attributes(builder) = {{"TRANSLATION", zeros(1 << 18)}};
    builder.document["nodes"][1] = builder.document["nodes"][0];
    expect_bad_scene(builder.gltf(), {"number of instances is 524288; the limit is ", " bytes"});
    builder.document["nodes"].erase(1);
    builder.primitive()["indices"] =
        builder.add("accessors", {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3000}});
    EXPECT_TRUE(load(builder).triangles.empty()) << "the mesh is stored once, and its triangles have no area";
    builder.primitive()["material"] = builder.add("materials", {{"emissiveFactor", {1, 1, 1}}});  // a lamp is copied
    expect_bad_scene(builder.gltf(), {"number of triangles is 262144000; the limit is ", " bytes"});
}

TEST(HostileAttribute, IsRefusedByALineThatNamesIt) {
    GltfBuilder builder = test::one_triangle();
    add_texture(builder, 0);
    const int one = add_attribute<float, 2>(builder, "TEXCOORD_0", 5126, false, {{0, 0}});
    expect_bad_scene(builder.gltf(),
                     {fmt::format("accessors[{}].count (TEXCOORD_0 of meshes[0].primitives[0]) is 1", one)});
    builder.primitive()["attributes"]["TEXCOORD_0"] = 0;
    expect_bad_scene(builder.gltf(), {"accessors[0].type is of 3 components", "TEXCOORD_0 needs 2"});
    builder.primitive()["attributes"].erase("TEXCOORD_0");
    builder.primitive()["attributes"]["COLOR_0"] = one;
    expect_bad_scene(builder.gltf(), {"(COLOR_0 of meshes[0].primitives[0]) is 1", "POSITION has 3"});
    add_attribute<float, 2>(builder, "COLOR_0", 5126, false, {{0, 0}, {0, 0}, {0, 0}});
    expect_bad_scene(builder.gltf(), {"type is of 2 components", "COLOR_0 needs 4"});
    add_attribute<float, 3>(builder, "COLOR_0", 5126, false, {{0, 0, 0}, {0, test::float_nan, 0}, {0, 0, 0}});
    const Scene scene = load(builder);
    EXPECT_EQ(at_corners(scene, scene.colors),
              (std::array{glm::vec4(0, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(0, 0, 0, 1)}));
    EXPECT_ONE_WARNING(scene, "vertex colours that are no numbers");
}

}  // namespace
}  // namespace vkcppm
