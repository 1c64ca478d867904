// Malformed files: each gives an Error whose one line names the file, the object, the value and the limit.

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
#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::expect_bad_scene;
using test::GltfBuilder;

/// A change to the file of one triangle that makes it malformed, and what the message must hold.
struct Fault {
    const char* name;
    std::function<void(GltfBuilder&)> make;
    std::vector<std::string> parts;
};

void PrintTo(const Fault& fault, std::ostream* stream) { *stream << fault.name; }

json& primitive(GltfBuilder& b) { return b.document["meshes"][0]["primitives"][0]; }

void add_light(GltfBuilder& b, const json& light) {
    b.document["extensions"]["KHR_lights_punctual"]["lights"] = {light};
    b.document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
}

void add_material(GltfBuilder& b, const json& material) { b.add("materials", material); }

void add_camera(GltfBuilder& b, const json& perspective) {
    b.document["nodes"][0]["camera"] = b.add("cameras", {{"type", "perspective"}, {"perspective", perspective}});
}

void add_sparse(GltfBuilder& b, const std::vector<std::uint8_t>& indices, const json& changes = json::object()) {
    json sparse = {{"count", indices.size()},
                   {"indices", {{"bufferView", b.view(indices)}, {"componentType", 5121}}},
                   {"values", {{"bufferView", b.view(std::vector<test::Float3>(indices.size()))}}}};
    sparse.merge_patch(changes);
    b.document["accessors"][0]["sparse"] = sparse;
}

const float nan = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

const std::vector<Fault> faults = {
    // The document.
    {"Version1", [](auto& b) { b.document["asset"]["version"] = "1.0"; }, {"asset.version is \"1.0\"", "2.0"}},
    {"NoVersion", [](auto& b) { b.document["asset"].erase("version"); }, {"asset.version is missing"}},
    {"NoAsset", [](auto& b) { b.document.erase("asset"); }, {"asset.version is missing"}},
    {"MinVersion", [](auto& b) { b.document["asset"]["minVersion"] = "2.1"; }, {"asset.minVersion is \"2.1\""}},
    {"RequiredExtension",
     [](auto& b) {
         b.document["extensionsRequired"] = {"KHR_materials_ior", "VENDOR_x"};
     },
     {"extensionsRequired is \"VENDOR_x\""}},
    {"ExtensionsType", [](auto& b) { b.document["extensionsUsed"] = {7}; }, {"extensionsUsed is 7", "strings"}},
    {"WrongTypeOfArray", [](auto& b) { b.document["meshes"] = 3; }, {"meshes is 3", "array"}},
    {"NullElement", [](auto& b) { b.document["nodes"].push_back(nullptr); }, {"nodes[1] is null", "object"}},

    // References.
    {"Scene", [](auto& b) { b.document["scene"] = 0; }, {"scene is 0", "scenes has 0"}},
    {"SceneNode",
     [](auto& b) {
         b.document["scenes"] = {{{"nodes", {1}}}};
     },
     {"scenes[0].nodes[0] is 1", "nodes has 1"}},
    {"Child",
     [](auto& b) { b.document["nodes"][0]["children"] = {-1}; },
     {"nodes[0].children[0] is -1", "nodes has 1"}},
    {"Mesh", [](auto& b) { b.document["nodes"][0]["mesh"] = 1; }, {"nodes[0].mesh is 1", "meshes has 1"}},
    {"MeshFraction", [](auto& b) { b.document["nodes"][0]["mesh"] = 0.5; }, {"nodes[0].mesh is 0.5", "index"}},
    {"MeshBeyondInt", [](auto& b) { b.document["nodes"][0]["mesh"] = 4294967296u; }, {"nodes[0].mesh is 4294967296"}},
    {"Camera", [](auto& b) { b.document["nodes"][0]["camera"] = 0; }, {"nodes[0].camera is 0", "cameras has 0"}},
    {"Light",
     [](auto& b) { b.document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 2; },
     {"nodes[0].extensions.KHR_lights_punctual.light is 2", "lights has 0"}},
    {"Material", [](auto& b) { primitive(b)["material"] = 5; }, {"primitives[0].material is 5", "materials has 0"}},
    {"Attribute",
     [](auto& b) { primitive(b)["attributes"]["POSITION"] = 9; },
     {"[\"POSITION\"] is 9", "accessors has 1"}},
    {"Indices", [](auto& b) { primitive(b)["indices"] = 1; }, {"primitives[0].indices is 1", "accessors has 1"}},
    {"View",
     [](auto& b) { b.document["accessors"][0]["bufferView"] = 1; },
     {"accessors[0].bufferView is 1", "bufferViews has 1"}},
    {"Buffer",
     [](auto& b) { b.document["bufferViews"][0]["buffer"] = 1; },
     {"bufferViews[0].buffer is 1", "buffers has 1"}},
    {"Texture",
     [](auto& b) {
         add_material(b, {{"normalTexture", {{"index", 0}}}});
     },
     {"materials[0].normalTexture.index is 0", "textures has 0"}},

    // Nodes.
    {"OwnParent", [](auto& b) { b.document["nodes"][0]["children"] = {0}; }, {"nodes[0] is its own ancestor"}},
    {"Cycle",
     [](auto& b) {
         b.document["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
     },
     {"is its own ancestor"}},
    {"TwoParents",
     [](auto& b) {
         b.document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
     },
     {"nodes[2] is a child of nodes[0] and nodes[1]", "one parent"}},
    {"SceneNamesAChild",
     [](auto& b) {
         b.document["nodes"] = {{{"children", {1}}}, json::object()};
         b.document["scenes"] = {{{"nodes", {1}}}};
     },
     {"scenes[0].nodes[0] is 1", "nodes[0]"}},
    {"SceneNamesANodeTwice",
     [](auto& b) {
         b.document["scenes"] = {{{"nodes", {0, 0}}}};
     },
     {"scenes[0].nodes[1] is 0", "already"}},
    {"MatrixLength",
     [](auto& b) {
         b.document["nodes"][0]["matrix"] = {1, 2, 3};
     },
     {"nodes[0].matrix is an array of 3", "16"}},
    {"MatrixType",
     [](auto& b) { b.document["nodes"][0]["matrix"] = {"x", 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     {"nodes[0].matrix[0] is \"x\"", "number"}},
    {"ProjectiveMatrix",
     [](auto& b) { b.document["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     {"nodes[0].matrix[3] is 0.5", "must be 0"}},
    {"ZeroRotation",
     [](auto& b) {
         b.document["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     {"nodes[0].rotation is (0, 0, 0, 0)", "unit"}},
    {"OverflowingTransform",
     [](auto& b) {
         b.document["nodes"] = {{{"scale", {1e200, 1, 1}}, {"children", {1}}}, {{"scale", {1e200, 1, 1}}, {"mesh", 0}}};
     },
     {"world transform of nodes[1] is (inf", "finite"}},
    {"OverflowingPosition",
     [](auto& b) {
         b.document["nodes"][0]["scale"] = {1e100, 1, 1};
     },
     {"vertex of nodes[0] is (1e+100", "3.4028"}},

    // Buffers, views and accessors.
    {"BufferTooShort",
     [](auto& b) { b.document["bufferViews"][0]["byteLength"] = 40; },
     {"bufferViews[0] is 40 bytes from 0 on", "buffers[0] has 36"}},
    {"ViewOffset",
     [](auto& b) { b.document["bufferViews"][0]["byteOffset"] = 4; },
     {"bufferViews[0] is 36 bytes from 4 on", "buffers[0] has 36"}},
    {"ViewOverflow",
     [](auto& b) { b.document["bufferViews"][0]["byteOffset"] = 18446744073709551600u; },
     {"bufferViews[0].byteOffset is 18446744073709551600"}},
    {"ViewEmpty",
     [](auto& b) { b.document["bufferViews"][0]["byteLength"] = 0; },
     {"bufferViews[0].byteLength is 0", "1 to"}},
    {"StrideMultiple",
     [](auto& b) { b.document["bufferViews"][0]["byteStride"] = 13; },
     {"bufferViews[0].byteStride is 13", "multiple of 4"}},
    {"StrideRange",
     [](auto& b) { b.document["bufferViews"][0]["byteStride"] = 256; },
     {"bufferViews[0].byteStride is 256", "4 to 252"}},
    {"StrideSmall",
     [](auto& b) { b.document["bufferViews"][0]["byteStride"] = 8; },
     {"bufferViews[0].byteStride is 8", "accessors[0] has 12 bytes"}},
    {"AccessorTooLong",
     [](auto& b) { b.document["accessors"][0]["count"] = 4; },
     {"accessors[0] is 4 elements of 12 bytes", "bufferViews[0] has 36"}},
    {"AccessorOffset",
     [](auto& b) { b.document["accessors"][0]["byteOffset"] = 4; },
     {"accessors[0] is 3 elements of 12 bytes, 12 apart, from 4 on", "bufferViews[0] has 36"}},
    {"AccessorCountOverflow",
     [](auto& b) { b.document["accessors"][0]["count"] = 1537228672809129302u; },
     {"accessors[0].count is 1537228672809129302"}},
    {"AccessorHuge",
     [](auto& b) { b.document["accessors"][0]["count"] = 4503599627370496u; },
     {"triangles of meshes[0] is 1501199875790165; the limit is ", " bytes"}},
    {"AccessorNoCount", [](auto& b) { b.document["accessors"][0].erase("count"); }, {"accessors[0].count is missing"}},
    {"AccessorNegativeCount", [](auto& b) { b.document["accessors"][0]["count"] = -3; }, {"accessors[0].count is -3"}},
    {"AccessorComponent",
     [](auto& b) { b.document["accessors"][0]["componentType"] = 5124; },
     {"accessors[0].componentType is 5124", "POSITION"}},
    {"AccessorType",
     [](auto& b) { b.document["accessors"][0]["type"] = "VEC9"; },
     {"accessors[0].type is \"VEC9\"", "VEC3"}},
    {"PositionType",
     [](auto& b) { b.document["accessors"][0]["type"] = "VEC2"; },
     {"accessors[0].type is of 2 components", "POSITION needs 3"}},
    {"ZerosHuge",
     [](auto& b) {
         b.document["accessors"][0].erase("bufferView");
         b.document["accessors"][0]["count"] = 1000000;
     },
     {"number of vectors that the meshes read is 1000000; the limit is ", " bytes"}},
    {"SparseIndex",
     [](auto& b) {
         add_sparse(b, {0, 3});
     },
     {"accessors[0].sparse.indices element 1", "below 3"}},
    {"SparseOrder",
     [](auto& b) {
         add_sparse(b, {1, 1});
     },
     {"accessors[0].sparse.indices element 1", "rise"}},
    {"SparseCount",
     [](auto& b) {
         add_sparse(b, {0}, {{"count", 2}});
     },
     {"accessors[0].sparse.indices is 2 elements", "bufferViews[1] has 1 bytes"}},
    {"SparseValues",
     [](auto& b) {
         add_sparse(b, {0}, {{"values", {{"byteOffset", 4}}}});
     },
     {"accessors[0].sparse.values is 1 elements", "from 4 on", "bufferViews[2] has 12 bytes"}},
    {"SparseType",
     [](auto& b) {
         add_sparse(b, {0}, {{"indices", {{"componentType", 5122}}}});
     },
     {"accessors[0].sparse.indices.componentType is 5122"}},

    // Primitives.
    {"Mode", [](auto& b) { primitive(b)["mode"] = 7; }, {"primitives[0].mode is 7", "0 to 6"}},
    {"IndexRange",
     [](auto& b) {
         primitive(b)["indices"] = b.u16({0, 1, 3});
     },
     {"accessors[1] element 2", "is 3", "3 vertices"}},
    {"PrimitiveRestart",
     [](auto& b) {
         primitive(b)["attributes"]["POSITION"] = b.float3(std::vector<test::Float3>(300));
         primitive(b)["indices"] = b.accessor(b.view(std::vector<std::uint8_t>{0, 1, 255}), "SCALAR", 5121, 3);
     },
     {"accessors[2] element 2", "is 255", "255 is no index"}},
    {"IndexType",
     [](auto& b) {
         primitive(b)["indices"] = b.accessor(b.view(std::vector<float>{0, 1, 2}), "SCALAR", 5126, 3);
     },
     {"accessors[1].componentType is 5126", "indices"}},
    {"NormalCount",
     [](auto& b) {
         primitive(b)["attributes"]["NORMAL"] = b.float3({{0, 0, 1}});
     },
     {"accessors[1].count", "is 1", "POSITION has 3"}},
    {"NanPosition",
     [](auto& b) {
         primitive(b)["attributes"]["POSITION"] = b.float3({{0, 0, 0}, {1, nan, 0}, {0, 1, 0}});
     },
     {"accessors[1] element 1", "nan", "finite"}},
    {"InfinitePosition",
     [](auto& b) {
         primitive(b)["attributes"]["POSITION"] = b.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, infinity}});
     },
     {"accessors[1] element 2", "inf", "finite"}},
    {"TooManyPrimitives",
     [](auto& b) {
         b.document["meshes"][0]["primitives"] = std::vector<json>(5000, {{"attributes", json::object()}});
         b.document["nodes"] = std::vector<json>(5000, {{"mesh", 0}});
     },
     {"number of primitives is", "16777216"}},
    {"TooManyTriangles",
     [](auto& b) {
         b.document["accessors"][0].erase("bufferView");
         b.document["accessors"][0]["count"] = 600000;
         b.document["nodes"] = std::vector<json>(150, {{"mesh", 0}});
     },
     {"number of triangles is 800000; the limit is ", " bytes"}},

    // Cameras, lights, materials.
    {"Yfov",
     [](auto& b) {
         add_camera(b, {{"yfov", 4}, {"znear", 1}});
     },
     {"cameras[0].perspective.yfov is 4", "pi"}},
    {"YfovZero",
     [](auto& b) {
         add_camera(b, {{"yfov", 0}, {"znear", 1}});
     },
     {"cameras[0].perspective.yfov is 0"}},
    {"Aspect",
     [](auto& b) {
         add_camera(b, {{"yfov", 1}, {"znear", 1}, {"aspectRatio", 0}});
     },
     {"cameras[0].perspective.aspectRatio is 0", "positive"}},
    {"CameraWithoutProperties",
     [](auto& b) {
         b.add("cameras", {{"type", "perspective"}});
     },
     {"cameras[0].perspective is missing"}},
    {"LightType",
     [](auto& b) {
         add_light(b, {{"type", "area"}});
     },
     {"lights[0].type is \"area\"", "spot"}},
    {"SpotWithoutCone",
     [](auto& b) {
         add_light(b, {{"type", "spot"}});
     },
     {"lights[0].spot is missing"}},
    {"LightNegative",
     [](auto& b) {
         add_light(b, {{"type", "point"}, {"intensity", -2}});
     },
     {"lights[0].intensity is -2", "negative"}},
    {"LightColor",
     [](auto& b) {
         add_light(b, {{"type", "point"}, {"color", {1, -1, 1}}});
     },
     {"lights[0].color is (1, -1, 1)", "negative"}},
    {"LightOverflow",
     [](auto& b) {
         add_light(b, {{"type", "point"}, {"intensity", 1e300}});
     },
     {"lights[0].intensity is 1e+300", "3.4028"}},
    {"ConeZero",
     [](auto& b) {
         add_light(b, {{"type", "spot"}, {"spot", {{"outerConeAngle", 0}}}});
     },
     {"lights[0].spot.outerConeAngle is 0", "pi/2"}},
    {"EmissionNegative",
     [](auto& b) {
         add_material(b, {{"emissiveFactor", {0, -0.5, 0}}});
     },
     {"materials[0].emissiveFactor is (0, -0.5, 0)", "negative"}},
    {"EmissionOverflow",
     [](auto& b) {
         add_material(b, {{"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e39}}}}}});
     },
     {"materials[0].emissiveStrength is 1e+39", "3.4028"}},
    {"FactorType",
     [](auto& b) {
         add_material(b, {{"pbrMetallicRoughness", {{"metallicFactor", "1"}}}});
     },
     {"materials[0].pbrMetallicRoughness.metallicFactor is \"1\"", "number"}},
};

class HostileGltf : public testing::TestWithParam<Fault> {};

TEST_P(HostileGltf, IsRefusedByALineThatNamesObjectValueAndLimit) {
    GltfBuilder builder = test::one_triangle();
    GetParam().make(builder);
    expect_bad_scene(builder.gltf(), GetParam().parts);
}

INSTANTIATE_TEST_SUITE_P(Faults, HostileGltf, testing::ValuesIn(faults),
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
    expect_bad_scene(glb_with_word(12, 6), {"GLB chunk 0 length is 6", "multiple of 4"});
    expect_bad_scene(glb_with_word(16, 0x004e4942), {"GLB chunk 0 type is 0x004e4942", "JSON"});
    expect_bad_scene(glb_with_word(binary_header, 40), {"GLB chunk 1 length is 40", "36 bytes are left"});
    expect_bad_scene(glb_with_word(binary_header + 4, 0x12345678), {"buffers[0] is absent", "no binary chunk"});
}

TEST(HostileFile, Buffers) {
    GltfBuilder builder = test::one_triangle();
    expect_bad_scene(builder.gltf_with_uri("gone.bin"), {"buffers[0] is absent", "\"gone.bin\": no such file"});
    expect_bad_scene(builder.gltf_with_uri("hostile.gltf/"), {"buffers[0] is absent"});
    for (const char* uri : {"../secret.bin", "/etc/passwd", "%2e%2e/secret.bin", "http://example.com/x.bin"}) {
        expect_bad_scene(builder.gltf_with_uri(uri), {"buffers[0].uri is", uri, "inside the scene's folder"});
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

TEST(HostileFile, LinksOutOfItsFolder) {
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
        return test::thrown_by([&] { load_gltf(folder / "scene.gltf"); });
    };
    for (const char* uri : {"link.bin", "textures/secret.bin", "%74extures/secret.bin"}) {
        const auto error = load(uri);
        ASSERT_TRUE(error) << uri << " was read";
        const std::string message = error->what();
        EXPECT_EQ(error->code(), ExitCode::bad_scene) << message;
        for (const std::string& part : {std::string("buffers[0].uri is \"") + uri, (outside / "secret.bin").string()}) {
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
    primitive(builder)["material"] = builder.add(
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

TEST(HostileFile, PicturesThatClaimMoreThanTheyHold) {
    expect_bad_scene(textured(png_header(16385, 1)),
                     {"size of images[0] is 16385 x 1; the limit is 16384 texels a side"});
    expect_bad_scene(textured(png_header(16384, 16384)),
                     {"size of images[0] is 16384 x 16384; its 45 bytes hold 371520 texels at most"});
    expect_bad_scene(textured(png_header(65536, 32768)), {"size of images[0] is 65536 x 32768", "16384"});
    expect_bad_scene(textured(png_header(0x7fffffff, 1)), {"images[0] is unreadable; broken PNG"});
    expect_bad_scene(textured(jpeg_header(16384, 16384)), {"size of images[0] is 16384 x 16384", "texels at most"});
    expect_bad_scene(textured(jpeg_header(65500, 65500)), {"size of images[0] is 65500 x 65500", "16384"});
    expect_bad_scene(textured(jpeg_header(0, 16)), {"images[0] is unreadable; broken JPEG"});
    expect_bad_scene(textured(std::string("\xff\xd8\xff\0\0\0\0\0\0\0", 10)), {"images[0] is unreadable; broken JPEG"});
}

}  // namespace
}  // namespace vkcppm
