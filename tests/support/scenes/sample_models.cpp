#include "support/scenes/sample_models.h"

#include "support/files/pictures.h"
#include "support/scenes/draco.h"
#include "support/scenes/everything.h"

namespace vkcppm::test {
namespace {

using nlohmann::json;

const std::vector<Float3> corners = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
const std::vector<std::uint16_t> both_triangles = {0, 1, 2, 2, 1, 3};

json& primitive(GltfBuilder& b) { return b.document["meshes"][0]["primitives"][0]; }

int float2(GltfBuilder& b, const std::vector<float>& values) {
    return b.accessor(b.view(values), "VEC2", 5126, values.size() / 2);
}

/// The square [-1, 1]^2 that faces +z, with normals and texture coordinates, of one material: mesh 0 at node 0.
GltfBuilder square(const json& material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}) {
    GltfBuilder b;
    const int normal = b.float3(std::vector<Float3>(4, Float3{0, 0, 1}));
    b.mesh(
        {{"attributes",
          {{"POSITION", b.float3(corners)}, {"NORMAL", normal}, {"TEXCOORD_0", float2(b, {0, 1, 1, 1, 0, 0, 1, 0})}}},
         {"indices", b.u16(both_triangles)},
         {"material", b.add("materials", material)}});
    b.add("nodes", {{"mesh", 0}});
    return b;
}

json with_extension(const char* name, const json& content, const json& factors = {{"metallicFactor", 0}}) {
    return {{"pbrMetallicRoughness", factors}, {"extensions", {{name, content}}}};
}

/// A texture of four colours, one of them half transparent.
int add_texture(GltfBuilder& b) {
    return b.texture(encode_png({2, 2}, std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 100,  //
                                                                  0, 0, 255, 255, 200, 200, 200, 255}));
}

/// With a texture at `where` below its material, such as /pbrMetallicRoughness/baseColorTexture.
GltfBuilder with_texture(GltfBuilder b, const char* where, const json& info = json::object()) {
    json texture = {{"index", add_texture(b)}};
    texture.update(info);
    b.document["materials"][0][json::json_pointer(where)] = texture;
    return b;
}

GltfBuilder textured(const char* where, const json& info = json::object()) {
    return with_texture(square(), where, info);
}

/// The square with a texture that has a WebP beside its PNG.
GltfBuilder in_webp() {
    GltfBuilder b = textured("/pbrMetallicRoughness/baseColorTexture");
    const int webp = b.texture(encode_webp({2, 1}, std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 100}));
    b.document["textures"][0]["extensions"]["EXT_texture_webp"] = b.document["textures"][webp];
    b.document["extensionsUsed"] = {"EXT_texture_webp"};
    return b;
}

GltfBuilder by_draco(const DracoFormat& format) {
    GltfBuilder b = square();
    compress_by_draco(b, 0, format);
    return b;
}

GltfBuilder changed(GltfBuilder b, const char* where, const json& value) {
    b.document[json::json_pointer(where)] = value;
    return b;
}

constexpr const char* base_colour = "/pbrMetallicRoughness/baseColorTexture";

/// Positions and normals in turn in one view.
GltfBuilder interleaved() {
    GltfBuilder b = square();
    std::vector<float> both;
    for (const Float3& corner : corners) {
        both.insert(both.end(), corner.begin(), corner.end());
        both.insert(both.end(), {0, 0, 1});
    }
    const int view = b.view(both);
    b.document["bufferViews"][view]["byteStride"] = 24;
    primitive(b)["attributes"]["POSITION"] = b.accessor(view, "VEC3", 5126, 4);
    const int normal = b.accessor(view, "VEC3", 5126, 4);
    b.document["accessors"][normal]["byteOffset"] = 12;
    primitive(b)["attributes"]["NORMAL"] = normal;
    return b;
}

/// One corner is moved by sparse values.
GltfBuilder sparse() {
    GltfBuilder b = square();
    const int position = primitive(b)["attributes"]["POSITION"];
    b.document["accessors"][position]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", b.view(std::vector<std::uint8_t>{3})}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(std::vector<Float3>{{1.5f, 1.5f, 0.5f}})}}}};
    return b;
}

/// The square as a strip, and once more as a fan, beside points and lines, which are left out.
GltfBuilder modes() {
    GltfBuilder b = square();
    const json plain = primitive(b);
    b.document["meshes"][0]["primitives"] = json::array();
    for (const int mode : {5, 6, 0, 1}) {
        json one = plain;
        one["mode"] = mode;
        one["indices"] = mode == 6 ? b.u16({0, 1, 3, 2}) : b.u16({0, 1, 2, 3});
        b.document["meshes"][0]["primitives"].push_back(one);
    }
    return b;
}

GltfBuilder without_indices_or_normals() { return one_triangle(); }

GltfBuilder colours() {
    GltfBuilder b = square();
    const int color = b.accessor(b.view(std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255,  //
                                                                  0, 0, 255, 255, 200, 200, 200, 255}),
                                 "VEC4", 5121, 4);
    b.document["accessors"][color]["normalized"] = true;
    primitive(b)["attributes"]["COLOR_0"] = color;
    return b;
}

/// Positions in 16 bits that the node scales.
GltfBuilder quantised() {
    GltfBuilder b = square();
    const int view =
        b.view(std::vector<std::int16_t>{-100, -100, 0, 0, 100, -100, 0, 0, -100, 100, 0, 0, 100, 100, 0, 0});
    b.document["bufferViews"][view]["byteStride"] = 8;
    primitive(b)["attributes"]["POSITION"] = b.accessor(view, "VEC3", 5122, 4);
    b.document["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
    b.document["extensionsRequired"] = b.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    return b;
}

GltfBuilder second_set() {
    GltfBuilder b = textured(base_colour, {{"texCoord", 1}});
    primitive(b)["attributes"]["TEXCOORD_1"] = float2(b, {0, 3, 3, 3, 0, 0, 3, 0});
    b.document["textures"][0]["sampler"] = b.add("samplers", {{"magFilter", 9728}, {"wrapS", 33648}, {"wrapT", 33071}});
    return b;
}

GltfBuilder morphed() {
    GltfBuilder b = square();
    primitive(b)["targets"] = {{{"POSITION", b.float3({{0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}})}}};
    b.document["meshes"][0]["weights"] = {0.5};
    return b;
}

/// Three of them, one in a mirror.
GltfBuilder placed() {
    GltfBuilder b = square();
    b.document["nodes"][0]["children"] = {1};
    const int places = b.float3({{3, 0, 0}, {-3, 0, 0}});
    b.add("nodes", {{"mesh", 0},
                    {"scale", {-1, 1, 1}},
                    {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
    return b;
}

GltfBuilder lit() {
    GltfBuilder b = square();
    b.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 3}},
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}},
        {{"type", "directional"}, {"color", {1, 0.5, 0.25}}}};
    for (int light = 0; light < 3; ++light) {
        b.add("nodes",
              {{"translation", {0.5 * light, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    return b;
}

/// A perspective camera and one of parallel rays.
GltfBuilder with_cameras() {
    GltfBuilder b = square();
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    b.add("cameras",
          {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 9}}}});
    for (int camera = 0; camera < 2; ++camera) b.add("nodes", {{"camera", camera}, {"translation", {0, 0, 4}}});
    return b;
}

/// A rig that moves: it is shown at rest.
GltfBuilder animated() {
    GltfBuilder b = square();
    b.add("skins", {{"joints", {1}}});
    b.add("nodes", json::object());
    b.document["nodes"][0]["skin"] = 0;
    primitive(b)["attributes"]["JOINTS_0"] =
        b.accessor(b.view(std::vector<std::array<std::uint8_t, 4>>(4)), "VEC4", 5121, 4);
    primitive(b)["attributes"]["WEIGHTS_0"] =
        b.accessor(b.view(std::vector<std::array<float, 4>>(4, {1, 0, 0, 0})), "VEC4", 5126, 4);
    const int times = b.accessor(b.view(std::vector<float>{0, 1}), "SCALAR", 5126, 2);
    b.document["accessors"][times].update({{"min", {0}}, {"max", {1}}});
    b.add("animations", {{"samplers", {{{"input", times}, {"output", b.float3({{0, 0, 0}, {1, 0, 0}})}}}},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    return b;
}

/// A solid ball would be glass of many triangles: this is a box of it, whose faces are the square six times.
GltfBuilder glass_box(const json& extensions) {
    const std::vector<Float3> box = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                     {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
    GltfBuilder b;
    b.mesh({{"attributes", {{"POSITION", b.float3(box)}}},
            {"indices", b.u16({0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7, 0, 1, 4, 4, 1, 5,  //
                               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 5, 3, 7})},
            {"material", b.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                                             {"extensions", extensions}})}});
    b.add("nodes", {{"mesh", 0}});
    return b;
}

const json transmission = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};

json with_volume(const json& more = json::object()) {
    json extensions = transmission;
    extensions["KHR_materials_ior"] = {{"ior", 1.5}};
    extensions["KHR_materials_volume"] = {
        {"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0.1}}};
    extensions.update(more);
    return extensions;
}

}  // namespace

std::vector<SampleModel> sample_models() {
    return {
        {"everything", everything(), 10},
        {"without indices or normals", without_indices_or_normals(), 1},
        {"interleaved", interleaved(), 2},
        {"sparse", sparse(), 2},
        {"modes", modes(), 4, {"meshes[0].primitives[2] (and 1 more): points and lines are skipped"}},
        {"colours", colours(), 2},
        {"quantised", quantised(), 2},
        {"morphed", morphed(), 2},
        {"placed", placed(), 6},
        {"animated", animated(), 2, {"animations: at rest"}},
        {"texture", textured(base_colour), 2},
        {"texture of the second set", second_set(), 2},
        {"texture transform",
         textured(base_colour, {{"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}, {"rotation", 0.5}}}}}}),
         2},
        {"texture of roughness", textured("/pbrMetallicRoughness/metallicRoughnessTexture"), 2},
        {"texture of normals", textured("/normalTexture"), 2},
        {"texture in WebP", in_webp(), 2},
        {"Draco", by_draco({}), 2},
        {"Draco in order", by_draco({.sequential = true, .position_bits = 12}), 2},
        {"missing image",
         changed(textured(base_colour), "/images/0", {{"uri", "absent.png"}}),
         2,
         {"images[0] (\"absent.png\": no such file): its textures are ignored"}},
        {"mask", changed(textured(base_colour), "/materials/0/alphaMode", "MASK"), 2},
        {"blend", changed(textured(base_colour), "/materials/0/alphaMode", "BLEND"), 2},
        {"two sides", changed(square(), "/materials/0/doubleSided", true), 2},
        {"metal", square({{"pbrMetallicRoughness", {{"roughnessFactor", 0.3}}}}), 2},
        {"mirror", square({{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}}), 2},
        {"emitter",
         changed(square(with_extension("KHR_materials_emissive_strength", {{"emissiveStrength", 5}})),
                 "/materials/0/emissiveFactor", {1, 0.5, 0.25}),
         2},
        {"clearcoat", square(with_extension("KHR_materials_clearcoat", {{"clearcoatFactor", 1}})), 2},
        {"iridescence",
         with_texture(square(with_extension("KHR_materials_iridescence", {{"iridescenceFactor", 1}})),
                      "/extensions/KHR_materials_iridescence/iridescenceThicknessTexture"),
         2},
        {"anisotropy",
         with_texture(square(with_extension("KHR_materials_anisotropy",
                                            {{"anisotropyStrength", 0.8}, {"anisotropyRotation", 1}})),
                      "/extensions/KHR_materials_anisotropy/anisotropyTexture"),
         2},
        {"specular", square(with_extension("KHR_materials_specular", {{"specularColorFactor", {1, 0.5, 0.2}}})), 2},
        {"specular-glossiness",
         with_texture(square(with_extension("KHR_materials_pbrSpecularGlossiness", {{"glossinessFactor", 0.5}})),
                      "/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture"),
         2,
         {"materials[0].KHR_materials_pbrSpecularGlossiness: rendered as a dielectric of that specular colour"}},
        {"unlit", square(with_extension("KHR_materials_unlit", json::object())), 2},
        {"sheen",
         with_texture(square(with_extension("KHR_materials_sheen",
                                            {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}})),
                      "/extensions/KHR_materials_sheen/sheenColorTexture"),
         2},
        {"diffuse transmission",
         changed(square(with_extension("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}})),
                 "/extensionsUsed", {"KHR_materials_diffuse_transmission"}),
         2,
         {"extensions \"KHR_materials_diffuse_transmission\": ignored, this program lacks them"}},
        {"pane",
         square(
             {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}, {"extensions", transmission}}),
         2},
        {"glass", glass_box(with_volume()), 12},
        {"dispersion", glass_box(with_volume({{"KHR_materials_dispersion", {{"dispersion", 0.5}}}})), 12},
        {"lights", lit(), 2},
        {"cameras", with_cameras(), 2},
    };
}

}  // namespace vkcppm::test
