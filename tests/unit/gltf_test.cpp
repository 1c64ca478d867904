// Every part of the glTF loader against values worked out by hand.

#include "scene/gltf/gltf.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::all_warnings;
using test::Float3;
using test::GltfBuilder;
using test::load;
using test::load_text;
using test::warnings_with;

std::string text_of(const glm::dvec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance, const std::string& what) {
    EXPECT_LE(glm::length(value - expected), tolerance)
        << what << ": " << text_of(value) << " not " << text_of(expected);
}

/// The corners of every triangle, in order.
std::vector<glm::dvec3> corners(const Scene& scene) {
    std::vector<glm::dvec3> points;
    for (const Triangle& triangle : scene.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) points.push_back(scene.positions[vertex]);
    }
    return points;
}

void expect_corners(const Scene& scene, const std::vector<glm::dvec3>& expected) {
    const std::vector<glm::dvec3> found = corners(scene);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        expect_near(found[i], expected[i], 1e-12, fmt::format("corner {}", i));
    }
}

/// cross(p1 - p0, p2 - p0), unit.
glm::dvec3 geometric_normal(const Scene& scene, const Triangle& triangle) {
    const glm::dvec3 p0 = scene.positions[triangle.vertex[0]];
    const glm::dvec3 p1 = scene.positions[triangle.vertex[1]], p2 = scene.positions[triangle.vertex[2]];
    return glm::normalize(glm::cross(p1 - p0, p2 - p0));
}

// ---- containers and scenes ----

TEST(Gltf, ReadsEmbeddedExternalAndContainedBuffersAlike) {
    const GltfBuilder builder = test::one_triangle();
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "embedded.gltf", builder.gltf());
    test::write_bytes(folder / "external.gltf", builder.gltf_with_uri("my%20data.bin"));
    test::write_bytes(folder / "my data.bin", builder.bytes() + "bytes past byteLength");
    test::write_bytes(folder / "contained.glb", builder.glb());
    for (const char* name : {"embedded.gltf", "external.gltf", "contained.glb"}) {
        SCOPED_TRACE(name);
        const Scene scene = load_gltf(folder / name);
        expect_corners(scene, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        EXPECT_EQ(scene.file, folder / name);
    }
}

TEST(Gltf, ReadsChunksWhoseLengthDoesNotCountTheirPadding) {
    const std::string glb = test::one_triangle().glb();
    const auto word = [](std::size_t value) {
        return std::string{char(value), char(value >> 8), char(value >> 16), char(value >> 24)};
    };
    std::uint32_t json_size;
    std::memcpy(&json_size, glb.data() + 12, sizeof json_size);
    std::string json = glb.substr(20, json_size);
    json.erase(json.find_last_of('}') + 1);
    if (json.size() % 4 == 0) json.insert(json.size() - 1, " ");
    const std::string padding(4 - json.size() % 4, ' '), binary = glb.substr(20 + json_size);
    for (const std::string& between : {std::string(), padding}) {
        const std::string chunks = word(json.size()) + "JSON" + json + between + binary;
        EXPECT_EQ(load_text("glTF" + word(2) + word(12 + chunks.size()) + chunks).triangles.size(), 1u);
    }
}

/// FNV-1a by its definition: 64 bits, byte by byte.
std::uint64_t fnv1a(const std::string& bytes) {
    std::uint64_t hash = 14695981039346656037u;
    for (const char c : bytes) hash = (hash ^ std::uint8_t(c)) * 1099511628211u;
    return hash;
}

TEST(Gltf, HashesTheFileAndItsExternalBuffers) {
    const GltfBuilder builder = test::one_triangle();
    const test::TemporaryFolder folder;
    const std::string text = builder.gltf_with_uri("data.bin");
    test::write_bytes(folder / "scene.gltf", text);
    test::write_bytes(folder / "data.bin", builder.bytes());
    EXPECT_EQ(load_gltf(folder / "scene.gltf").hash, fnv1a(text + builder.bytes()));
    test::write_bytes(folder / "scene.glb", builder.glb());
    EXPECT_EQ(load_gltf(folder / "scene.glb").hash, fnv1a(builder.glb()));
}

TEST(Gltf, NeedsNoBufferThatNoMeshReads) {
    GltfBuilder builder = test::one_triangle();
    json document = json::parse(builder.gltf());
    document["buffers"].push_back({{"byteLength", 4}, {"uri", "animation.bin"}});
    document["buffers"].push_back({{"byteLength", 4}});
    EXPECT_EQ(load_text(document.dump()).triangles.size(), 1u);
}

TEST(Gltf, TakesTheDefaultSceneElseTheFirstElseAllRoots) {
    GltfBuilder builder = test::one_triangle();
    builder.add("nodes", {{"mesh", 0}, {"translation", {10, 0, 0}}, {"children", {2}}});
    builder.add("nodes", {{"mesh", 0}, {"translation", {100, 0, 0}}});
    expect_corners(
        load(builder),
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {110, 0, 0}, {111, 0, 0}, {110, 1, 0}});
    builder.add("scenes", {{"nodes", {0}}});
    builder.add("scenes", {{"nodes", {1}}});
    expect_corners(load(builder), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    builder.document["scene"] = 1;
    expect_corners(load(builder), {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {110, 0, 0}, {111, 0, 0}, {110, 1, 0}});
}

TEST(Gltf, TellsWhichTrianglesANodeHas) {
    GltfBuilder builder = test::one_triangle();
    builder.add("nodes", {{"name", "empty"}});
    builder.add("nodes", {{"name", "second"}, {"mesh", 0}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.mesh_nodes.size(), 2u);
    EXPECT_EQ(scene.mesh_nodes[0].index, 0u);
    EXPECT_EQ(scene.mesh_nodes[0].first_triangle, 0u);
    EXPECT_EQ(scene.mesh_nodes[1].index, 2u);
    EXPECT_EQ(scene.mesh_nodes[1].name, "second");
    EXPECT_EQ(scene.mesh_nodes[1].first_triangle, 1u);
}

TEST(Gltf, IsNotRecursiveOverNodes) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = json::array();
    constexpr int depth = 20000;
    for (int i = 0; i < depth; ++i) builder.add("nodes", {{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    builder.add("nodes", {{"mesh", 0}});
    expect_corners(load(builder), {{depth, 0, 0}, {depth + 1, 0, 0}, {depth, 1, 0}});
}

// ---- transforms ----

TEST(Gltf, ComposesTranslationRotationAndScale) {
    GltfBuilder builder = test::one_triangle();
    const double half = std::numbers::sqrt2 / 2.0;
    builder.document["nodes"] = {
        {{"children", {1}}, {"translation", {10, 20, 30}}, {"rotation", {0, 0, half, half}}, {"scale", {2, 3, 4}}},
        {{"mesh", 0}, {"translation", {0, 0, 1}}, {"scale", {1, 1, -1}}},
    };
    // Child: (x, y, z) -> (x, y, 1 - z). Parent: scaled (2x, 3y, 4z), turned by 90 degrees about z (-y, x, z), moved.
    const Scene scene = load(builder);
    // The determinant is negative: the last two corners change places.
    expect_corners(scene, {{10, 20, 34}, {7, 20, 34}, {10, 22, 34}});
    expect_near(geometric_normal(scene, scene.triangles[0]), {0, 0, -1}, 1e-12, "geometric normal");
    for (const glm::vec3& normal : scene.normals) expect_near(normal, {0, 0, -1}, 1e-7, "flat normal");
}

TEST(Gltf, ReadsAColumnMajorMatrixInDoublePrecision) {
    GltfBuilder builder = test::one_triangle();
    const double far = 12345678.0625;  // float would round it to 12345678
    builder.document["nodes"] = {{{"mesh", 0}, {"matrix", {0, 2, 0, 0, 0, 0, 3, 0, 5, 0, 0, 0, far, -1, -2, 1}}}};
    // Columns: x -> (0, 2, 0), y -> (0, 0, 3), z -> (5, 0, 0).
    expect_corners(load(builder), {{far, -1, -2}, {far, 1, -2}, {far, -1, 1}});
}

TEST(Gltf, ReadsAMatrixWhoseLastRowIsRounded) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = {
        {{"mesh", 0}, {"matrix", {1, 0, 0, 1e-9, 0, 1, 0, -3e-8, 0, 0, 1, 0, 5, 0, 0, 0.99999988}}}};
    expect_corners(load(builder), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
}

TEST(Gltf, TransformsNormalsByTheInverseTranspose) {
    GltfBuilder builder;
    // A slope x + z = 1 whose normal (1, 0, 1) / sqrt 2 becomes that of x/2 + z = 1 under the scale (2, 1, 1).
    const float s = float(std::numbers::sqrt2 / 2.0);
    const int positions = builder.float3({{1, 0, 0}, {1, 1, 0}, {0, 0, 1}});
    const int normals = builder.float3({{s, 0, s}, {s, 0, s}, {s, 0, s}});
    builder.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    for (const double sign : {1.0, -1.0}) {
        SCOPED_TRACE(sign);
        builder.document["nodes"] = {{{"mesh", 0}, {"scale", {2 * sign, 1, 1}}}};
        const Scene scene = load(builder);
        const glm::dvec3 expected = glm::normalize(glm::dvec3(0.5 * sign, 0, 1));
        ASSERT_EQ(scene.triangles.size(), 1u);
        for (const glm::vec3& normal : scene.normals) expect_near(normal, expected, 1e-7, "shading normal");
        expect_near(geometric_normal(scene, scene.triangles[0]), expected, 1e-7, "geometric normal");
    }
}

TEST(Gltf, DropsAMeshUnderASingularTransformWithAWarning) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = {
        {{"mesh", 0}, {"scale", {1, 1, 0}}}, {{"mesh", 0}, {"scale", {0, 0, 0}}}, {{"mesh", 0}}};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_ONE_WARNING(scene, "nodes[0] (and 1 more)", "singular");
}

TEST(Gltf, KeepsAMeshUnderATinyScale) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = {{{"mesh", 0}, {"scale", {1e-30, 1e-30, 1e-30}}}};
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 1u) << all_warnings(scene);
    expect_near(scene.normals[0], {0, 0, 1}, 1e-7, "normal");
}

// ---- primitives ----

const std::vector<Float3> square_strip = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};

TEST(Gltf, WindsStripsAndFansAsTheSpecificationSays) {
    GltfBuilder builder;
    const int strip = builder.float3(square_strip);
    builder.mesh({{"attributes", {{"POSITION", strip}}}, {"mode", 5}});
    builder.add("nodes", {{"mesh", 0}});
    // p_i = {v_i, v_(i + 1 + i % 2), v_(i + 2 - i % 2)}
    const Scene scene = load(builder);
    expect_corners(scene, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    for (const Triangle& t : scene.triangles) expect_near(geometric_normal(scene, t), {0, 0, 1}, 1e-12, "strip");

    const int order = builder.u16({0, 1, 3, 2});
    builder.document["meshes"][0]["primitives"][0] = {
        {"attributes", {{"POSITION", strip}}}, {"indices", order}, {"mode", 6}};
    // p_i = {v_(i + 1), v_(i + 2), v_0}
    const Scene fan = load(builder);
    expect_corners(fan, {{1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}});
    for (const Triangle& t : fan.triangles) expect_near(geometric_normal(fan, t), {0, 0, 1}, 1e-12, "fan");
}

TEST(Gltf, SkipsPointsAndLinesWithOneWarning) {
    GltfBuilder builder = test::one_triangle();
    for (const int mode : {0, 1, 2, 3}) {
        builder.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
    }
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_ONE_WARNING(scene, "meshes[0].primitives[1] (and 3 more)", "points and lines are skipped");
}

template <typename T> void expect_indices_of_type(int component) {
    SCOPED_TRACE(component);
    GltfBuilder builder;
    const int positions = builder.float3(square_strip);
    const int indices = builder.accessor(builder.view(std::vector<T>{0, 1, 2, 2, 1, 3}), "SCALAR", component, 6);
    builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    builder.add("nodes", {{"mesh", 0}});
    expect_corners(load(builder), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}});
}

TEST(Gltf, ReadsEveryTypeOfIndex) {
    expect_indices_of_type<std::uint8_t>(5121);
    expect_indices_of_type<std::uint16_t>(5123);
    expect_indices_of_type<std::uint32_t>(5125);
}

/// One triangle whose POSITION has components of type T, plain or normalized.
template <typename T>
Scene load_integer_triangle(int component, bool normalized, const std::vector<std::array<T, 4>>& values) {
    GltfBuilder builder;
    const int view = builder.view(values);
    builder.document["bufferViews"][view]["byteStride"] = sizeof values[0];  // the fourth component is padding
    const int positions = builder.accessor(view, "VEC3", component, values.size());
    builder.document["accessors"][positions]["normalized"] = normalized;
    builder.mesh({{"attributes", {{"POSITION", positions}}}});
    builder.add("nodes", {{"mesh", 0}});
    return load(builder);
}

TEST(Gltf, ReadsIntegerAttributesPlainAndNormalized) {
    expect_corners(load_integer_triangle<std::int8_t>(5120, false, {{0, 0, -7, 9}, {127, 0, 0, 9}, {0, -128, 0, 9}}),
                   {{0, 0, -7}, {127, 0, 0}, {0, -128, 0}});
    expect_corners(load_integer_triangle<std::int8_t>(5120, true, {{0, 0, -127, 9}, {127, 0, 0, 9}, {0, -128, 0, 9}}),
                   {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}});
    expect_corners(load_integer_triangle<std::uint8_t>(5121, true, {{0, 0, 51, 9}, {255, 0, 0, 9}, {0, 102, 0, 9}}),
                   {{0, 0, 0.2}, {1, 0, 0}, {0, 0.4, 0}});
    expect_corners(load_integer_triangle<std::int16_t>(5122, true, {{0, 0, -32768, 9}, {32767, 0, 0, 9}, {0, 1, 0, 9}}),
                   {{0, 0, -1}, {1, 0, 0}, {0, 1.0 / 32767, 0}});
    expect_corners(load_integer_triangle<std::uint16_t>(5123, false, {{0, 0, 3, 9}, {65535, 0, 0, 9}, {0, 256, 0, 9}}),
                   {{0, 0, 3}, {65535, 0, 0}, {0, 256, 0}});
}

TEST(Gltf, ReadsInterleavedAttributes) {
    GltfBuilder builder;
    const int view = builder.view<Float3>({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}});
    builder.document["bufferViews"][view]["byteStride"] = 24;
    const int positions = builder.accessor(view, "VEC3", 5126, 3), normals = builder.accessor(view, "VEC3", 5126, 3);
    builder.document["accessors"][normals]["byteOffset"] = 12;
    builder.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}});
    builder.add("nodes", {{"mesh", 0}});
    const Scene scene = load(builder);
    expect_corners(scene, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    ASSERT_EQ(scene.normals.size(), 3u);
    for (const glm::vec3& normal : scene.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(Gltf, AStrideOfZeroIsNone) {
    GltfBuilder builder = test::one_triangle();
    builder.document["bufferViews"][0]["byteStride"] = 0;
    expect_corners(load(builder), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(Gltf, AppliesSparseValuesOverABaseAndOverZeros) {
    GltfBuilder builder = test::one_triangle();
    const int indices = builder.view<std::uint8_t>({1, 2}), values = builder.view<Float3>({{5, 0, 0}, {0, 6, 0}});
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                         {"values", {{"bufferView", values}}}};
    builder.document["accessors"][0]["sparse"] = sparse;
    expect_corners(load(builder), {{0, 0, 0}, {5, 0, 0}, {0, 6, 0}});
    builder.document["accessors"][0].erase("bufferView");
    expect_corners(load(builder), {{0, 0, 0}, {5, 0, 0}, {0, 6, 0}});
}

TEST(Gltf, ReadsAnAccessorWithoutAViewAsZeros) {
    GltfBuilder builder = test::one_triangle();
    const int zeros = builder.add("accessors", {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}});
    builder.document["meshes"][0]["primitives"][0]["indices"] = zeros;
    const Scene scene = load(builder);  // the vertices 0, 0, 0
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_ONE_WARNING(scene, "zero area: 1 dropped");
}

TEST(Gltf, GivesFlatNormalsAndUnsharedVerticesWhereTheyAreMissing) {
    GltfBuilder builder;
    const int positions = builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", builder.u16({0, 1, 2, 0, 3, 1})}});
    builder.add("nodes", {{"mesh", 0}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.positions.size(), 6u);
    for (const std::uint32_t vertex : scene.triangles[0].vertex) EXPECT_EQ(scene.normals[vertex], glm::vec3(0, 0, 1));
    for (const std::uint32_t vertex : scene.triangles[1].vertex) EXPECT_EQ(scene.normals[vertex], glm::vec3(0, 1, 0));
}

TEST(Gltf, ReplacesNormalsWithoutDirectionByTheGeometricOne) {
    GltfBuilder builder = test::one_triangle();
    const int normals = builder.float3({{0, 0, 0}, {test::float_nan, 0, 0}, {0, 3, 4}});
    builder.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
    const Scene scene = load(builder);
    ASSERT_EQ(scene.triangles.size(), 1u);
    const auto& vertex = scene.triangles[0].vertex;
    EXPECT_EQ(scene.normals[vertex[0]], glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.normals[vertex[1]], glm::vec3(0, 0, 1));
    expect_near(scene.normals[vertex[2]], {0, 0.6, 0.8}, 1e-7, "a normal of length 5");
    EXPECT_ONE_WARNING(scene, "a normal (and 1 more)");
}

TEST(Gltf, DropsDegenerateTrianglesWithOneWarningThatCountsThem) {
    GltfBuilder builder;
    const int positions = builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}});
    const int indices = builder.u16({0, 1, 2, 0, 0, 1, 0, 1, 3});
    builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    builder.add("nodes", {{"mesh", 0}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_ONE_WARNING(scene, "zero area: 2 dropped");
}

TEST(Gltf, SharesTheVerticesOfPrimitivesWithTheSameAttributes) {
    GltfBuilder builder;
    const int positions = builder.float3(square_strip);
    const int normals = builder.float3({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    const json attributes = {{"POSITION", positions}, {"NORMAL", normals}};
    builder.mesh({{"attributes", attributes}, {"indices", builder.u16({0, 1, 2})}});
    builder.document["meshes"][0]["primitives"].push_back(
        {{"attributes", attributes}, {"indices", builder.u16({2, 1, 3})}});
    builder.document["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 5}}}};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.positions.size(), 8u);  // four an instance
    expect_corners(scene, {{0, 0, 0},
                           {1, 0, 0},
                           {0, 1, 0},
                           {0, 1, 0},
                           {1, 0, 0},
                           {1, 1, 0},
                           {0, 0, 5},
                           {1, 0, 5},
                           {0, 1, 5},
                           {0, 1, 5},
                           {1, 0, 5},
                           {1, 1, 5}});
}

TEST(Gltf, HiddenNodesShowNothingAndShedNoLight) {
    GltfBuilder builder = test::one_triangle();
    const auto visible = [](bool value) { return json{{"KHR_node_visibility", {{"visible", value}}}}; };
    builder.document["extensionsUsed"] = builder.document["extensionsRequired"] = {"KHR_node_visibility"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    json lamp = {{"camera", 0}, {"extensions", visible(true)}};
    lamp["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.document["nodes"] = {{{"extensions", visible(false)}, {"children", {1, 2}}},
                                 {{"mesh", 0}},
                                 lamp,
                                 {{"mesh", 0}, {"translation", {0, 0, 5}}, {"extensions", visible(true)}}};
    const Scene scene = load(builder);
    expect_corners(scene, {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.cameras.size(), 1u) << "one may look from where nothing is shown";
    EXPECT_TRUE(scene.warnings.empty()) << all_warnings(scene);
}

TEST(Gltf, WholeNumbersMayBeWrittenWithAPointOrAnExponent) {
    const std::string text = test::one_triangle().gltf();
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        const std::size_t at = changed.find(from);
        EXPECT_NE(at, changed.npos) << from;
        return changed.replace(at, from.size(), to);
    };
    for (const char* count : {"3.0", "3e0", "30e-1", "0.3E+1"}) {
        EXPECT_EQ(load_text(with("\"count\":3", std::string("\"count\":") + count)).triangles.size(), 1u) << count;
    }
    EXPECT_EQ(load_text(with("\"mesh\":0", "\"mesh\":-0.0")).triangles.size(), 1u);
    for (const char* count : {"3.5", "-3.0", "1e300", "9007199254740994.0"}) {
        test::expect_bad_scene(with("\"count\":3", std::string("\"count\":") + count), {"accessors[0].count is"});
    }
}

TEST(Gltf, AVariantHasOtherMaterials) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensionsUsed"] = {"KHR_materials_variants"};
    for (const char* name : {"plain", "red", "blue"}) builder.add("materials", {{"name", name}});
    builder.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"variants", {1}}, {"material", 2}}};
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    const auto material = [&](const std::string& variant) {
        return load_gltf(folder / "scene.gltf", {.variant = variant}).triangles.at(0).material;
    };
    EXPECT_EQ(material(""), 0u);
    EXPECT_EQ(material("day"), 0u);
    EXPECT_EQ(material("night"), 2u);
    EXPECT_EQ(material("1"), 2u);
    EXPECT_EQ(warnings_with(load_gltf(folder / "scene.gltf"), {"extensions"}), 0);
    const auto error = test::thrown_by([&] { material("dusk"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
    EXPECT_NE(std::string(error->what()).find("0 'day', 1 'night'"), std::string::npos) << error->what();
    primitive["extensions"]["KHR_materials_variants"]["mappings"][0]["variants"] = {7};
    test::expect_bad_scene(builder.gltf(), {"mappings[0].variants[0] is 7", "variants has 2"});
}

// ---- files beside the scene ----

TEST(Gltf, ReadsFilesBelowItsFolderAndWithARootElsewhere) {
    const test::TemporaryFolder folder;
    const GltfBuilder builder = test::one_triangle();
    std::filesystem::create_directories(folder / "a/b/models/parts");
    std::filesystem::create_directories(folder / "a/b/data");
    const std::filesystem::path scene = folder / "a/b/models/scene.gltf";
    const auto triangles = [&](const std::string& uri, const GltfOptions& options = {}) {
        test::write_bytes(scene, builder.gltf_with_uri(uri));
        return load_gltf(scene, options).triangles.size();
    };
    test::write_bytes(folder / "a/b/data/near.bin", builder.bytes());
    test::write_bytes(folder / "a/far.bin", builder.bytes());
    std::filesystem::create_symlink(folder / "a/b/data/near.bin", folder / "a/b/models/near.bin");
    std::filesystem::create_symlink(folder / "a/far.bin", folder / "a/b/models/far.bin");
    test::write_bytes(folder / "a/b/models/parts/own.bin", builder.bytes());
    EXPECT_EQ(triangles("parts/own.bin"), 1u);
    EXPECT_EQ(triangles("x/../parts/./own.bin"), 1u);
    const GltfOptions above{.root = folder / "a/b"};
    EXPECT_EQ(triangles("../data/near.bin", above), 1u);
    EXPECT_EQ(triangles("near.bin", above), 1u);
    EXPECT_EQ(triangles("x/../../data/./near.bin", above), 1u);
    EXPECT_EQ(triangles("../../far.bin", {.root = folder / "a"}), 1u);
    EXPECT_EQ(triangles("far.bin", {.root = folder / "a"}), 1u);
    for (const char* uri : {"../../far.bin", "far.bin", "../data/near.bin", "near.bin", "parts/../../data/near.bin"}) {
        const auto error = test::thrown_by([&] { triangles(uri); });
        ASSERT_TRUE(error) << uri;
        EXPECT_EQ(error->code(), ExitCode::bad_input);
        EXPECT_NE(std::string(error->what()).find("--root"), std::string::npos) << error->what();
    }
    EXPECT_TRUE(test::thrown_by([&] { triangles("../../far.bin", above); }));
    const auto error = test::thrown_by([&] { triangles("near.bin", {.root = folder / "none"}); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::no_input);
}

TEST(Gltf, TellsWhichFilesItNames) {
    GltfBuilder builder = test::one_triangle();
    builder.add("images", {{"uri", "unused.png"}});
    builder.add("images", {{"uri", "https://example.org/t.png"}});
    builder.add("images", {{"uri", "data:image/png;base64,AAAA"}});
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf_with_uri("my%20data.bin"));
    test::write_bytes(folder / "my data.bin", builder.bytes());
    EXPECT_EQ(
        load_gltf(folder / "scene.gltf").inputs,
        (std::vector<std::filesystem::path>{folder / "scene.gltf", folder / "my data.bin", folder / "unused.png"}));
}

TEST(Gltf, SaysWhereThereIsNoTriangle) {
    const Scene scene = load_text(R"({"asset": {"version": "2.0"}})");
    EXPECT_ONE_WARNING(scene, "no triangle");
    EXPECT_EQ(scene.cameras.size(), 1u);
}

// ---- cameras ----

GltfBuilder with_camera(const json& camera, json node) {
    GltfBuilder builder = test::one_triangle();
    node["camera"] = builder.add("cameras", camera);
    builder.add("nodes", node);
    return builder;
}

TEST(Gltf, ReadsAPerspectiveCameraAndRemovesItsScale) {
    const double half = std::numbers::sqrt2 / 2.0;
    const json camera = {{"type", "perspective"},
                         {"name", "eye"},
                         {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}};
    // Turned by 90 degrees about y: it looks along -x, its right hand is -z.
    const json node = {{"translation", {1, 2, 3}}, {"rotation", {0, half, 0, half}}, {"scale", {2, 5, 7}}};
    const Scene scene = load(with_camera(camera, node));
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& eye = scene.cameras[0];
    EXPECT_EQ(eye.name, "eye");
    EXPECT_EQ(eye.yfov, 0.5);
    EXPECT_EQ(eye.aspect, 1.5);
    expect_near(eye.to_world[0], {0, 0, -1}, 1e-12, "right");
    expect_near(eye.to_world[1], {0, 1, 0}, 1e-12, "up");
    expect_near(eye.to_world[2], {1, 0, 0}, 1e-12, "backward");
    expect_near(eye.to_world[3], {1, 2, 3}, 1e-12, "position");
    EXPECT_EQ(eye.to_world[3].w, 1.0);
}

TEST(Gltf, NamesACameraByItsNodeWhereItHasNoName) {
    const json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}};
    const Scene scene = load(with_camera(camera, {{"name", "tripod"}}));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "tripod");
    EXPECT_EQ(scene.cameras[0].aspect, std::nullopt);
}

TEST(Gltf, KeepsAMirroredCameraRightHanded) {
    const json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}};
    const Scene scene = load(with_camera(camera, {{"scale", {-1, 1, 1}}}));
    const glm::dmat4& m = scene.cameras.at(0).to_world;
    expect_near(glm::cross(glm::dvec3(m[0]), glm::dvec3(m[1])), m[2], 1e-12, "x cross y");
}

/// The largest angle between the view direction and a corner of the scene, rad.
double widest_angle(const Scene& scene, const Camera& camera) {
    double widest = 0.0;
    for (const glm::dvec3& corner : corners(scene)) {
        const glm::dvec3 to_corner = glm::normalize(corner - glm::dvec3(camera.to_world[3]));
        widest = std::max(widest, std::acos(glm::dot(to_corner, -glm::dvec3(camera.to_world[2]))));
    }
    return widest;
}

TEST(Gltf, ReadsAnOrthographicCamera) {
    const json lens = {{"xmag", 3}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 10}};
    const Scene scene = load(with_camera({{"type", "orthographic"}, {"name", "plan"}, {"orthographic", lens}},
                                         {{"name", "tripod"}, {"scale", {2, 3, 4}}, {"translation", {1, 2, 3}}}));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "plan");
    EXPECT_EQ(scene.cameras[0].node, "tripod");
    EXPECT_EQ(scene.cameras[0].ymag, 2.0);
    EXPECT_EQ(scene.cameras[0].aspect, 1.5);
    expect_near(scene.cameras[0].to_world[3], {1, 2, 3}, 1e-12, "position");
    EXPECT_TRUE(scene.warnings.empty()) << all_warnings(scene);
    for (const char* side : {"xmag", "ymag"}) {
        for (const double size : {0.0, 1e300}) {
            json bad = lens;
            bad[side] = size;
            test::expect_bad_scene(
                with_camera({{"type", "orthographic"}, {"orthographic", bad}}, json::object()).gltf(),
                {fmt::format("cameras[0].orthographic.{} is", side), "positive"});
        }
        json negative = lens;
        negative[side] = -5;
        const Scene upright = load(with_camera({{"type", "orthographic"}, {"orthographic", negative}}, json::object()));
        EXPECT_EQ(upright.cameras.at(0).aspect, side == std::string("xmag") ? 2.5 : 0.6);
        EXPECT_ONE_WARNING(upright, "cameras[0].orthographic", "negative");
    }
}

TEST(Gltf, IgnoresAnAspectRatioThatIsNone) {
    const json lens = {{"yfov", 1}, {"znear", 1}, {"aspectRatio", 0}};
    const Scene scene = load(with_camera({{"type", "perspective"}, {"perspective", lens}}, json::object()));
    EXPECT_EQ(scene.cameras.at(0).aspect, std::nullopt);
    EXPECT_ONE_WARNING(scene, "cameras[0].perspective.aspectRatio = 0", "ignored");
}

TEST(Gltf, FramesASceneWithoutACamera) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"][0]["scale"] = {1000, 10, 10};
    const Scene scene = load(builder);
    EXPECT_ONE_WARNING(scene, "no camera");
    ASSERT_EQ(scene.cameras.size(), 1u);
    const Camera& frame = scene.cameras[0];
    const double widest = widest_angle(scene, frame);
    EXPECT_LE(widest, 0.5 * frame.yfov);
    EXPECT_GE(widest, 0.7 * 0.5 * frame.yfov) << "the scene should fill the picture";
    EXPECT_GT(frame.to_world[3].z, 0.0) << "from the front";
    EXPECT_GT(frame.to_world[3].y, 0.0) << "from above";
}

// ---- lights ----

Scene load_light(const json& light, const json& node) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    json placed = node;
    placed["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.add("nodes", placed);
    Scene scene = load(builder);
    EXPECT_EQ(scene.lights.size(), 1u);
    scene.lights.resize(1);
    return scene;
}

TEST(Gltf, ReadsASpotLightTurnedAboutX) {
    const double half = std::numbers::sqrt2 / 2.0;
    const json light = {{"type", "spot"},
                        {"name", "lamp"},
                        {"color", {1, 0.5, 0.25}},
                        {"intensity", 8},
                        {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}};
    // Turned by -90 degrees about x: -z becomes -y. The scale must not matter.
    const Scene scene =
        load_light(light, {{"translation", {1, 2, 3}}, {"rotation", {-half, 0, 0, half}}, {"scale", {3, 3, 3}}});
    const PunctualLight& lamp = scene.lights[0];
    EXPECT_EQ(lamp.kind, PunctualLight::Kind::spot);
    EXPECT_EQ(lamp.name, "lamp");
    EXPECT_EQ(lamp.intensity, glm::vec3(8, 4, 2));
    EXPECT_EQ(lamp.inner_cone, 0.25);
    EXPECT_EQ(lamp.outer_cone, 0.5);
    expect_near(lamp.direction, {0, -1, 0}, 1e-12, "direction");
    expect_near(lamp.position, {1, 2, 3}, 1e-12, "position");
}

TEST(Gltf, ReadsTheDefaultsOfLights) {
    const PunctualLight spot = load_light({{"type", "spot"}, {"spot", json::object()}}, json::object()).lights[0];
    EXPECT_EQ(spot.intensity, glm::vec3(1));
    EXPECT_EQ(spot.inner_cone, 0.0);
    EXPECT_NEAR(spot.outer_cone, std::numbers::pi / 4, 1e-9);
    const Scene bare = load_light({{"type", "spot"}}, json::object());
    EXPECT_EQ(bare.lights.at(0).inner_cone, 0.0);
    EXPECT_NEAR(bare.lights.at(0).outer_cone, std::numbers::pi / 4, 1e-9);
    EXPECT_ONE_WARNING(bare, "lights[0].spot", "missing");
    const PunctualLight sun = load_light({{"type", "directional"}, {"intensity", 3}}, {{"name", "sun"}}).lights[0];
    EXPECT_EQ(sun.kind, PunctualLight::Kind::directional);
    EXPECT_EQ(sun.name, "sun");
    EXPECT_EQ(sun.intensity, glm::vec3(3));
    EXPECT_EQ(sun.direction, glm::dvec3(0, 0, -1));
}

TEST(Gltf, ReadsTheRangeOfALight) {
    const auto range_of = [](const json& light) { return load_light(light, json::object()).lights[0].range; };
    EXPECT_EQ(range_of({{"type", "point"}, {"range", 5}}), 5.0);
    EXPECT_EQ(range_of({{"type", "spot"}, {"range", 0.5}, {"spot", json::object()}}), 0.5);
    EXPECT_EQ(range_of({{"type", "point"}}), 0.0) << "without end";
    EXPECT_EQ(range_of({{"type", "point"}, {"range", 1e300}}), 0.0);
    EXPECT_EQ(range_of({{"type", "directional"}, {"range", 5}}), 0.0) << "of a sun it means nothing";
    for (const double none : {0.0, -2.0}) {
        const Scene scene = load_light({{"type", "point"}, {"range", none}}, json::object());
        EXPECT_EQ(scene.lights[0].range, 0.0);
        EXPECT_ONE_WARNING(scene, "lights[0].range", "greater than 0");
    }
}

/// A sun of 1366 and no other light, as a file of `generator`.
Scene load_sun(const char* generator, PunctualUnits units) {
    GltfBuilder builder = test::one_triangle();
    builder.document["asset"]["generator"] = generator;
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 1366}}};
    builder.document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    GltfOptions options;
    options.punctual_units = units;
    return load_gltf(folder / "scene.gltf", options);
}

TEST(Gltf, LightsAreInTheUnitsThatAreAskedForOrOfTheExporter) {
    const glm::vec3 watts(2.0f), lux(1366.0f);  // 683 lm/W
    const char* blender = "Khronos glTF Blender I/O v5.0.21";
    const auto intensity = [](const char* generator, PunctualUnits units) {
        const Scene scene = load_sun(generator, units);
        EXPECT_EQ(warnings_with(scene, {"candela and lux", "divided by 683", "--punctual-units"}),
                  units == PunctualUnits::by_generator && scene.lights.at(0).intensity.x == 2.0f ? 1 : 0)
            << all_warnings(scene);
        return scene.lights.at(0).intensity;
    };
    for (const char* generator : {blender, "Khronos glTF Blender I/O v3.4.50", "Khronos glTF Blender I/O v3.10"}) {
        EXPECT_EQ(intensity(generator, PunctualUnits::by_generator), watts) << generator;
    }
    for (const char* generator : {"", "Khronos glTF Blender I/O v3.3.27", "Khronos glTF Blender I/O v1.3.48",
                                  "Khronos glTF Blender I/O", "Khronos glTF Blender I/O vx", "another"}) {
        EXPECT_EQ(intensity(generator, PunctualUnits::by_generator), lux) << generator;
    }
    EXPECT_EQ(intensity(blender, PunctualUnits::radiometric), lux);
    EXPECT_EQ(intensity("another", PunctualUnits::photometric), watts);
    EXPECT_NE(load_sun("another", PunctualUnits::photometric).hash,
              load_sun("another", PunctualUnits::by_generator).hash);
}

TEST(Gltf, ClampsConesWithAWarning) {
    const Scene wide = load_light({{"type", "spot"}, {"spot", {{"outerConeAngle", 2.0}}}}, json::object());
    EXPECT_EQ(wide.lights[0].outer_cone, std::numbers::pi / 2);
    EXPECT_ONE_WARNING(wide, "outerConeAngle = 2", "clamped");
    const Scene hard =
        load_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}}, json::object());
    EXPECT_LT(hard.lights[0].inner_cone, hard.lights[0].outer_cone);
    EXPECT_ONE_WARNING(hard, "innerConeAngle = 0.5", "clamped");
    const Scene rounded =
        load_light({{"type", "spot"}, {"spot", {{"outerConeAngle", 1.5707963705062866}}}}, json::object());  // float
    EXPECT_EQ(rounded.lights[0].outer_cone, std::numbers::pi / 2);
    EXPECT_EQ(warnings_with(rounded, {"clamped"}), 0) << all_warnings(rounded);
}

TEST(Gltf, SkipsASpotLightWithoutACone) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.0}, {"outerConeAngle", 0.0}}}}, {{"type", "point"}}};
    for (const int light : {0, 1}) {
        builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    const Scene scene = load(builder);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, PunctualLight::Kind::point);
    EXPECT_ONE_WARNING(scene, "lights[0].spot.outerConeAngle = 0", "skipped");
}

TEST(Gltf, SkipsALightThatTakesLightAway) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", -2}},
                                                                       {{"type", "directional"}}};
    for (const int light : {0, 1}) {
        builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    const Scene scene = load(builder);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, PunctualLight::Kind::directional);
    EXPECT_ONE_WARNING(scene, "lights[0].intensity = -2", "skipped");
}

// ---- extensions ----

TEST(Gltf, WarnsOnceOfAllUnknownExtensions) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensionsUsed"] = {"KHR_materials_ior", "VENDOR_a", "KHR_mesh_quantization", "VENDOR_b"};
    builder.document["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_ior"};
    const Scene scene = load(builder);
    EXPECT_ONE_WARNING(scene, "\"VENDOR_a\", \"VENDOR_b\"");
    EXPECT_EQ(warnings_with(scene, {"KHR_"}), 0) << all_warnings(scene);
}

TEST(Gltf, MetadataIsNothingToWarnOfOrToRefuse) {
    GltfBuilder builder = test::one_triangle();
    builder.document["extensionsUsed"] = {"KHR_xmp_json_ld", "EXT_structural_metadata", "KHR_physics_rigid_bodies"};
    builder.document["extensionsRequired"] = {"KHR_xmp_json_ld"};
    EXPECT_EQ(warnings_with(load(builder), {"extension"}), 0) << all_warnings(load(builder));
}

}  // namespace
}  // namespace vkcppm
