#include "support/scenes/everything.h"

#include <meshoptimizer.h>

#include "support/files/pictures.h"

namespace vkcppm::test {
namespace {

using nlohmann::json;

/// The index of an accessor over compressed floats of three components, which lie in the first bytes of the buffer.
int compressed_float3(GltfBuilder& builder, const std::vector<Float3>& values) {
    std::vector<std::uint8_t> encoded(meshopt_encodeVertexBufferBound(values.size(), sizeof(Float3)));
    encoded.resize(
        meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), values.data(), values.size(), sizeof(Float3)));
    const int view = builder.view(encoded);
    json& stored = builder.document["bufferViews"][view];
    const json extension = {{"buffer", 0},
                            {"byteOffset", stored["byteOffset"]},
                            {"byteLength", stored["byteLength"]},
                            {"byteStride", sizeof(Float3)},
                            {"count", values.size()},
                            {"mode", "ATTRIBUTES"}};
    stored = {{"buffer", 0},
              {"byteOffset", 0},
              {"byteLength", values.size() * sizeof(Float3)},
              {"byteStride", sizeof(Float3)},
              {"extensions", {{"EXT_meshopt_compression", extension}}}};
    return builder.accessor(view, "VEC3", 5126, values.size());
}

int normalized(GltfBuilder& builder, int accessor) {
    builder.document["accessors"][accessor]["normalized"] = true;
    return accessor;
}

void add_materials(GltfBuilder& b) {
    const int texture = b.texture(encode_png({2, 2}, std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128,  //
                                                                               0, 0, 255, 0, 90, 90, 200, 255}));
    b.document["textures"][texture]["sampler"] =
        b.add("samplers", {{"magFilter", 9728}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33648}});
    const json moved = {{"index", texture},
                        {"texCoord", 1},
                        {"extensions",
                         {{"KHR_texture_transform",
                           {{"offset", {0.1, 0.2}}, {"rotation", 0.3}, {"scale", {2, -1}}, {"texCoord", 0}}}}}};
    const json plain = {{"index", texture}};
    b.add("materials",
          {{"pbrMetallicRoughness",
            {{"baseColorFactor", {0.5, 0.6, 0.7, 0.8}},
             {"metallicFactor", 0.5},
             {"roughnessFactor", 0.4},
             {"baseColorTexture", moved},
             {"metallicRoughnessTexture", plain}}},
           {"normalTexture", {{"index", texture}, {"scale", 0.5}}},
           {"emissiveTexture", plain},
           {"emissiveFactor", {1, 0.5, 0.25}},
           {"alphaMode", "MASK"},
           {"alphaCutoff", 0.25},
           {"doubleSided", true},
           {"extensions",
            {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5}}},
             {"KHR_materials_specular",
              {{"specularFactor", 0.5},
               {"specularColorFactor", {1, 0.9, 0.8}},
               {"specularTexture", plain},
               {"specularColorTexture", moved}}},
             {"KHR_materials_clearcoat",
              {{"clearcoatFactor", 0.5},
               {"clearcoatRoughnessFactor", 0.1},
               {"clearcoatTexture", plain},
               {"clearcoatRoughnessTexture", plain},
               {"clearcoatNormalTexture", plain}}},
             {"KHR_materials_anisotropy",
              {{"anisotropyStrength", 0.6}, {"anisotropyRotation", 1}, {"anisotropyTexture", plain}}},
             {"KHR_materials_iridescence",
              {{"iridescenceFactor", 0.7}, {"iridescenceTexture", plain}, {"iridescenceThicknessTexture", plain}}},
             {"KHR_materials_sheen",
              {{"sheenColorFactor", {0.3, 0.5, 0.4}},
               {"sheenRoughnessFactor", 0.5},
               {"sheenColorTexture", plain},
               {"sheenRoughnessTexture", moved}}}}}});
    b.add("materials",
          {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
           {"alphaMode", "BLEND"},
           {"extensions",
            {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", plain}}},
             {"KHR_materials_ior", {{"ior", 1.5}}},
             {"KHR_materials_dispersion", {{"dispersion", 0.3}}},
             {"KHR_materials_volume",
              {{"thicknessFactor", 0.1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0}}}}}}});
    b.add("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
}

void add_lights(GltfBuilder& b) {
    const json spot = {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}};
    b.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 3}},
        {{"type", "spot"}, {"spot", spot}},
        {{"type", "directional"}}};
}

}  // namespace

GltfBuilder everything() {
    GltfBuilder b;
    add_materials(b);
    add_lights(b);
    const std::vector<Float3> square = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
    const int position = compressed_float3(b, square);
    const int normal = normalized(
        b, b.accessor(b.view(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 9, 127, 0, 0, 0, 127, 0}), "VEC3",
                      5120, 4));
    b.document["bufferViews"].back()["byteStride"] = 4;
    const int tangent =
        b.accessor(b.view(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 1, 0, 0, 1}), "VEC4", 5126, 4);
    const int uv0 = normalized(
        b, b.accessor(b.view(std::vector<std::uint16_t>{0, 0, 65535, 0, 0, 65535, 65535, 65535}), "VEC2", 5123, 4));
    const int uv1 = b.accessor(b.view(std::vector<float>{0, 0, 2, 0, 0, 2, 2, 2}), "VEC2", 5126, 4);
    const int color = normalized(b, b.accessor(b.view(std::vector<std::uint8_t>(16, 200)), "VEC4", 5121, 4));
    const int displacement = b.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});
    b.document["accessors"][displacement]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", b.view(std::vector<std::uint8_t>{2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(std::vector<Float3>{{0.1f, 0.2f, 0.3f}})}}}};
    const json attributes = {{"POSITION", position}, {"NORMAL", normal},  {"TANGENT", tangent},
                             {"TEXCOORD_0", uv0},    {"TEXCOORD_1", uv1}, {"COLOR_0", color}};
    const int strip = b.mesh({{"attributes", attributes},
                              {"mode", 5},
                              {"material", 0},
                              {"targets", json::array({{{"POSITION", displacement}}})}});
    b.document["meshes"][strip]["weights"] = {0.5};
    const int indexed = b.mesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv0}}},
                                {"indices", b.u16({0, 1, 2, 2, 1, 3})},
                                {"material", 1}});
    b.document["meshes"][indexed]["primitives"].push_back(
        {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv0}}}, {"mode", 6}, {"material", 2}});
    const int places = b.float3({{0, 0, 0}, {2, 0, 0}});
    b.add("nodes", {{"mesh", strip}, {"weights", {0.25}}, {"scale", {1, 2, -1}}, {"children", {1, 2, 3}}});
    b.add("nodes", {{"mesh", indexed},
                    {"rotation", {0, 0, 0.6, 0.8}},
                    {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
    b.add("nodes",
          {{"translation", {0, 3, 0}}, {"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.add("nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}},
                    {"children", {4}},
                    {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    b.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 2}}}}}});
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1.5}}}});
    b.document["scenes"] = {{{"nodes", {0}}}};
    b.document["scene"] = 0;
    return b;
}

}  // namespace vkcppm::test
