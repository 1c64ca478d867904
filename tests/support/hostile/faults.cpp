#include "support/hostile/faults.h"

#include <limits>

namespace vkcppm::test {
namespace {

using nlohmann::json;

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
                   {"values", {{"bufferView", b.view(std::vector<Float3>(indices.size()))}}}};
    sparse.merge_patch(changes);
    b.document["accessors"][0]["sparse"] = sparse;
}

}  // namespace

const std::vector<Fault>& faults() {
    static const std::vector<Fault> all = {
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
        {"MeshBeyondInt",
         [](auto& b) { b.document["nodes"][0]["mesh"] = 4294967296u; },
         {"nodes[0].mesh is 4294967296"}},
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
        {"OverflowingRotation",
         [](auto& b) {
             b.document["nodes"][0]["rotation"] = {1e300, 0, 0, 1e300};
         },
         {"nodes[0].rotation is (1e+300, 0, 0, 1e+300)", "unit"}},
        {"OverflowingTransform",
         [](auto& b) {
             b.document["nodes"] = {{{"scale", {1e200, 1, 1}}, {"children", {1}}},
                                    {{"scale", {1e200, 1, 1}}, {"mesh", 0}}};
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
         {"accessors[0] is 3 elements of 12 bytes", "bufferViews[0] has 0"}},
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
        {"AccessorNoCount",
         [](auto& b) { b.document["accessors"][0].erase("count"); },
         {"accessors[0].count is missing"}},
        {"AccessorNegativeCount",
         [](auto& b) { b.document["accessors"][0]["count"] = -3; },
         {"accessors[0].count is -3"}},
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
        {"PrimitiveRestartOfAList",
         [](auto& b) {
             primitive(b)["attributes"]["POSITION"] = b.float3(std::vector<Float3>(300));
             primitive(b)["indices"] = b.accessor(b.view(std::vector<std::uint8_t>{0, 1, 255}), "SCALAR", 5121, 3);
         },
         {"accessors[2] element 2", "is 255", "255 is no index"}},
        {"IndexType",
         [](auto& b) {
             primitive(b)["indices"] = b.accessor(b.view(std::vector<float>{0, 1, 2}), "SCALAR", 5126, 3);
         },
         {"accessors[1].componentType is 5126", "indices"}},
        {"PositionsEmpty",
         [](auto& b) {
             primitive(b)["indices"] = b.u16({0, 1, 2});
             b.document["accessors"][0]["count"] = 0;
         },
         {"accessors[1] element 0", "is 0", "0 vertices"}},
        {"NormalCount",
         [](auto& b) {
             primitive(b)["attributes"]["NORMAL"] = b.float3({{0, 0, 1}});
         },
         {"accessors[1].count", "is 1", "POSITION has 3"}},
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
             primitive(b)["material"] = b.add("materials", {{"emissiveFactor", {1, 1, 1}}});  // a lamp is copied
         },
         {"number of triangles is 30000000; the limit is ", " bytes"}},

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
    return all;
}

}  // namespace vkcppm::test
