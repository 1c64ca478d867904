// Materials of glTF files: factors, textures and the images behind them, against values worked out by hand.

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>
#include <png.h>

#include "support/files/pictures.h"
#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::all_warnings;
using test::expect_bad_scene;
using test::GltfBuilder;
using test::load;
using test::warnings_with;

// ---- factors ----

Scene load_material(const json& material) {
    GltfBuilder builder = test::one_triangle();
    builder.document["meshes"][0]["primitives"][0]["material"] = builder.add("materials", material);
    return load(builder);
}

TEST(GltfMaterial, ReadsEveryFactorOfAMaterial) {
    const Material m =
        load_material(
            {
                {"name", "all"},
                {"doubleSided", true},
                {"alphaMode", "MASK"},
                {"alphaCutoff", 0.125},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {0.1, 0.2, 0.3, 0.5}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}},
                {"emissiveFactor", {1, 0.5, 0.25}},
                {"extensions",
                 {{"KHR_materials_emissive_strength", {{"emissiveStrength", 5000000000}}},  // above 2^32
                  {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                  {"KHR_materials_ior", {{"ior", 1.6}}},
                  {"KHR_materials_volume",
                   {{"thicknessFactor", 2}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 0.6, 0.7}}}},
                  {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.625}, {"clearcoatRoughnessFactor", 0.375}}},
                  {"KHR_materials_dispersion", {{"dispersion", 0.36}}},
                  {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.75}, {"anisotropyRotation", -7}}},
                  {"KHR_materials_iridescence",
                   {{"iridescenceFactor", 0.5},
                    {"iridescenceIor", 1.75},
                    {"iridescenceThicknessMinimum", 50},
                    {"iridescenceThicknessMaximum", 900}}},
                  {"KHR_materials_sheen", {{"sheenColorFactor", {0.75, 0.5, 0.25}}, {"sheenRoughnessFactor", 0.875}}},
                  {"KHR_materials_specular", {{"specularFactor", 0}, {"specularColorFactor", {1, 2, 3}}}}}},
            })
            .materials.at(0);
    EXPECT_EQ(m.name, "all");
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(m.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.opacity, 0.5f);
    EXPECT_EQ(m.alpha, Material::Alpha::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.125f);
    EXPECT_EQ(m.metallic, 0.25f);
    EXPECT_EQ(m.roughness, 0.75f);
    EXPECT_EQ(m.emission, glm::vec3(5e9f, 2.5e9f, 1.25e9f));
    EXPECT_EQ(m.transmission, 0.9f);
    EXPECT_EQ(m.ior, 1.6f);
    EXPECT_EQ(m.thickness, 2.0f);
    EXPECT_EQ(m.attenuation_distance, 3.0f);
    EXPECT_EQ(m.attenuation_color, glm::vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(m.specular, 0.0f);
    EXPECT_EQ(m.specular_color, glm::vec3(1, 2, 3));
    EXPECT_EQ(m.clearcoat, 0.625f);
    EXPECT_EQ(m.clearcoat_roughness, 0.375f);
    EXPECT_EQ(m.dispersion, 0.36f);
    EXPECT_EQ(m.anisotropy, 0.75f);
    EXPECT_EQ(m.anisotropy_rotation, -7.0f);
    EXPECT_EQ(m.iridescence, 0.5f);
    EXPECT_EQ(m.iridescence_ior, 1.75f);
    EXPECT_EQ(m.iridescence_thickness_minimum, 50.0f);
    EXPECT_EQ(m.iridescence_thickness_maximum, 900.0f);
    EXPECT_EQ(m.sheen_color, glm::vec3(0.75f, 0.5f, 0.25f));
    EXPECT_EQ(m.sheen_roughness, 0.875f);
    EXPECT_FALSE(m.unlit);
}

TEST(GltfMaterial, GivesGltfsDefaultsToAnEmptyMaterialAndToNone) {
    const Scene none = load(test::one_triangle());
    ASSERT_EQ(none.materials.size(), 1u);
    EXPECT_EQ(none.triangles.at(0).material, 0u);
    for (const Material& m : {load_material(json::object()).materials.at(0), none.materials[0]}) {
        EXPECT_EQ(m.base_color, glm::vec3(1));
        EXPECT_EQ(m.metallic, 1.0f);
        EXPECT_EQ(m.roughness, 1.0f);
        EXPECT_EQ(m.emission, glm::vec3(0));
        EXPECT_EQ(m.transmission, 0.0f);
        EXPECT_EQ(m.thickness, 0.0f);
        EXPECT_EQ(m.ior, 1.5f);
        EXPECT_EQ(m.specular, 1.0f);
        EXPECT_EQ(m.specular_color, glm::vec3(1));
        EXPECT_EQ(m.attenuation_distance, std::numeric_limits<float>::infinity());
        EXPECT_FALSE(m.double_sided);
        EXPECT_EQ(m.opacity, 1.0f);
        EXPECT_EQ(m.alpha, Material::Alpha::opaque);
        EXPECT_EQ(m.alpha_cutoff, 0.5f);
        EXPECT_EQ(m.dispersion, 0.0f);
        EXPECT_EQ(m.clearcoat, 0.0f);
        EXPECT_EQ(m.clearcoat_roughness, 0.0f);
        EXPECT_EQ(m.anisotropy, 0.0f);
        EXPECT_EQ(m.anisotropy_rotation, 0.0f);
        EXPECT_EQ(m.iridescence, 0.0f);
        EXPECT_EQ(m.iridescence_ior, 1.3f);
        EXPECT_EQ(m.iridescence_thickness_minimum, 100.0f);
        EXPECT_EQ(m.iridescence_thickness_maximum, 400.0f);
        EXPECT_EQ(m.sheen_color, glm::vec3(0));
        EXPECT_EQ(m.sheen_roughness, 0.0f);
        EXPECT_EQ(m.normal_scale, 1.0f);
    }
}

TEST(GltfMaterial, KeepsAnIorOfZeroThatStandsForInfinity) {
    EXPECT_EQ(load_material({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).materials.at(0).ior, 0.0f);
}

TEST(GltfMaterial, ClampsFactorsOutsideTheirRangeWithOneWarning) {
    const Scene scene = load_material({{"pbrMetallicRoughness", {{"metallicFactor", 3}, {"roughnessFactor", -1}}},
                                       {"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}});
    EXPECT_EQ(scene.materials.at(0).metallic, 1.0f);
    EXPECT_EQ(scene.materials.at(0).roughness, 0.0f);
    EXPECT_EQ(scene.materials.at(0).ior, 1.0f);
    EXPECT_ONE_WARNING(scene, "materials[0].metallicFactor = 3", "(and 2 more)", "clamped");
}

TEST(GltfMaterial, ReadsTheModesOfAlpha) {
    EXPECT_EQ(load_material({{"alphaMode", "BLEND"}}).materials.at(0).alpha, Material::Alpha::blend);
    EXPECT_EQ(load_material({{"alphaMode", "OPAQUE"}}).materials.at(0).alpha, Material::Alpha::opaque);
    EXPECT_EQ(load_material({{"alphaMode", "MASK"}, {"alphaCutoff", 1.5}}).materials.at(0).alpha_cutoff, 1.5f);
}

TEST(GltfMaterial, KeepsOfAnUnlitOneTheBaseColourAlone) {
    const Scene scene = load_material({{"extensions", {{"KHR_materials_unlit", json::object()}}},
                                       {"emissiveFactor", {1, 1, 1}},
                                       {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 0.75}}}}});
    const Material& m = scene.materials.at(0);
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.base_color, glm::vec3(0.5f, 0.25f, 1.0f));
    EXPECT_EQ(m.opacity, 0.75f);
    EXPECT_EQ(m.emission, glm::vec3(0.0f)) << "an unlit surface lights nothing";
    EXPECT_EQ(warnings_with(scene, {"no light"}), 0) << all_warnings(scene);
}

// ---- textures ----

constexpr std::array<std::uint8_t, 4> red = {255, 0, 0, 255}, green = {0, 255, 0, 255};

/// A triangle with both sets of texture coordinates.
GltfBuilder textured_triangle() {
    GltfBuilder builder = test::one_triangle();
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"}) {
        attributes[name] =
            builder.accessor(builder.view(std::vector<std::array<float, 2>>{{0, 0}, {1, 0}, {0, 1}}), "VEC2", 5126, 3);
    }
    return builder;
}

void set_material(GltfBuilder& builder, const json& material) {
    builder.document["materials"] = {material};
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
}

/// The scene of a triangle whose base colour is textured by `info`; textures[0] is a red texel.
Scene load_texture(const json& info, const json& sampler = nullptr) {
    GltfBuilder builder = textured_triangle();
    builder.texture(test::one_texel_png(red));
    if (!sampler.is_null()) builder.document["textures"][0]["sampler"] = builder.add("samplers", sampler);
    json whole = info;
    whole["index"] = 0;
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", whole}}}});
    return load(builder);
}

Texture base_color_texture(const Scene& scene) {
    EXPECT_TRUE(scene.materials.at(0).base_color_texture) << all_warnings(scene);
    return scene.materials.at(0).base_color_texture.value_or(Texture{});
}

TEST(GltfTexture, EveryUseReadsItsOwn) {
    GltfBuilder builder = textured_triangle();
    std::array<json, 15> info;
    for (int i = 0; i < int(info.size()); ++i) {
        info[i] = {{"index", builder.texture(test::one_texel_png({std::uint8_t(i), 0, 0, 255}))}};
    }
    info[2]["scale"] = 0.5;
    info[9]["scale"] = -2;
    set_material(
        builder,
        {{"pbrMetallicRoughness", {{"baseColorTexture", info[0]}, {"metallicRoughnessTexture", info[1]}}},
         {"normalTexture", info[2]},
         {"emissiveTexture", info[3]},
         {"emissiveFactor", {1, 1, 1}},
         {"occlusionTexture", info[0]},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info[4]}}},
           {"KHR_materials_specular", {{"specularTexture", info[5]}, {"specularColorTexture", info[6]}}},
           {"KHR_materials_clearcoat",
            {{"clearcoatFactor", 1},
             {"clearcoatTexture", info[7]},
             {"clearcoatRoughnessFactor", 1},
             {"clearcoatRoughnessTexture", info[8]},
             {"clearcoatNormalTexture", info[9]}}},
           {"KHR_materials_anisotropy", {{"anisotropyStrength", 1}, {"anisotropyTexture", info[10]}}},
           {"KHR_materials_iridescence",
            {{"iridescenceFactor", 1}, {"iridescenceTexture", info[11]}, {"iridescenceThicknessTexture", info[12]}}},
           {"KHR_materials_sheen",
            {{"sheenColorFactor", {1, 1, 1}},
             {"sheenRoughnessFactor", 1},
             {"sheenColorTexture", info[13]},
             {"sheenRoughnessTexture", info[14]}}}}}});
    const Scene scene = load(builder);
    const Material& m = scene.materials.at(0);
    const std::array<const std::optional<Texture>*, 15> textures = {&m.base_color_texture,
                                                                    &m.metallic_roughness_texture,
                                                                    &m.normal_texture,
                                                                    &m.emissive_texture,
                                                                    &m.transmission_texture,
                                                                    &m.specular_texture,
                                                                    &m.specular_color_texture,
                                                                    &m.clearcoat_texture,
                                                                    &m.clearcoat_roughness_texture,
                                                                    &m.clearcoat_normal_texture,
                                                                    &m.anisotropy_texture,
                                                                    &m.iridescence_texture,
                                                                    &m.iridescence_thickness_texture,
                                                                    &m.sheen_color_texture,
                                                                    &m.sheen_roughness_texture};
    for (std::size_t i = 0; i < textures.size(); ++i) {
        ASSERT_TRUE(*textures[i]) << "texture " << i;
        EXPECT_EQ(int(scene.images.at((*textures[i])->image).rgba.at(0)), int(i)) << "texture " << i;
    }
    EXPECT_EQ(m.normal_scale, 0.5f);
    EXPECT_EQ(m.clearcoat_normal_scale, -2.0f);
    EXPECT_EQ(scene.images.size(), 15u);
}

TEST(GltfTexture, WhatMultipliesZeroIsNotRead) {
    GltfBuilder builder = textured_triangle();
    const json info = {{"index", builder.texture("no picture")}};
    set_material(
        builder,
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}, {"metallicRoughnessTexture", info}}},
         {"emissiveTexture", info},
         {"occlusionTexture", info},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionTexture", info}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"thicknessTexture", info}}},
           {"KHR_materials_specular",
            {{"specularFactor", 0}, {"specularTexture", info}, {"specularColorTexture", info}}},
           {"KHR_materials_clearcoat",
            {{"clearcoatTexture", info}, {"clearcoatRoughnessTexture", info}, {"clearcoatNormalTexture", info}}},
           {"KHR_materials_anisotropy", {{"anisotropyTexture", info}}},
           {"KHR_materials_iridescence", {{"iridescenceTexture", info}, {"iridescenceThicknessTexture", info}}},
           {"KHR_materials_sheen", {{"sheenColorTexture", info}, {"sheenRoughnessTexture", info}}}}}});
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.images.empty());
    EXPECT_TRUE(scene.uv[0].empty());
}

TEST(GltfTexture, ReadsTheWrapAndTheFilterOfItsSampler) {
    const Texture plain = base_color_texture(load_texture(json::object()));
    EXPECT_EQ(plain.wrap_s, Texture::Wrap::repeat);
    EXPECT_EQ(plain.wrap_t, Texture::Wrap::repeat);
    EXPECT_FALSE(plain.nearest);
    EXPECT_EQ(plain.uv_set, 0u);
    const Texture wrapped = base_color_texture(load_texture(json::object(), {{"wrapS", 33071}, {"wrapT", 33648}}));
    EXPECT_EQ(wrapped.wrap_s, Texture::Wrap::clamp_to_edge);
    EXPECT_EQ(wrapped.wrap_t, Texture::Wrap::mirrored_repeat);
    for (const int minification : {9728, 9729, 9984, 9985, 9986, 9987}) {
        const bool is_nearest = minification == 9728 || minification == 9984 || minification == 9986;
        EXPECT_EQ(base_color_texture(load_texture(json::object(), {{"minFilter", minification}})).nearest, is_nearest)
            << minification;
        for (const int magnification : {9728, 9729}) {
            const json sampler = {{"minFilter", minification}, {"magFilter", magnification}};
            EXPECT_EQ(base_color_texture(load_texture(json::object(), sampler)).nearest, magnification == 9728)
                << minification << " " << magnification;
        }
    }
}

glm::vec2 transformed(const Texture& texture, const glm::vec2& uv) { return texture.matrix * uv + texture.offset; }

void expect_uv(const glm::vec2& value, const glm::vec2& expected) {
    EXPECT_NEAR(value.x, expected.x, 1e-6f) << "u of (" << value.x << ", " << value.y << ")";
    EXPECT_NEAR(value.y, expected.y, 1e-6f) << "v of (" << value.x << ", " << value.y << ")";
}

TEST(GltfTexture, TransformsItsCoordinates) {
    const auto texture_with = [](const json& transform) {
        return base_color_texture(load_texture({{"extensions", {{"KHR_texture_transform", transform}}}}));
    };
    const Texture moved = texture_with({{"offset", {0.25, -0.5}}, {"scale", {2, 3}}});
    expect_uv(transformed(moved, {1, 1}), {2.25f, 2.5f});
    // The extension's example: the lower left quarter of the image, turned by 90 degrees.
    const Texture turned =
        texture_with({{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}});
    expect_uv(transformed(turned, {0, 0}), {0, 1});
    expect_uv(transformed(turned, {1, 0}), {0, 0.5f});
    expect_uv(transformed(turned, {0, 1}), {0.5f, 1});
    // Scaled first, then turned: a scale of u alone must come out along v.
    const Texture both = texture_with({{"rotation", std::numbers::pi / 2}, {"scale", {3, 1}}});
    expect_uv(transformed(both, {1, 0}), {0, -3});
    expect_uv(transformed(both, {0, 1}), {1, 0});
}

TEST(GltfTexture, TakesTheSetOfItsTransformOverItsOwn) {
    const json override = {{"KHR_texture_transform", {{"texCoord", 1}}}};
    EXPECT_EQ(base_color_texture(load_texture({{"texCoord", 1}})).uv_set, 1u);
    EXPECT_EQ(base_color_texture(load_texture({{"texCoord", 0}, {"extensions", override}})).uv_set, 1u);
    EXPECT_EQ(base_color_texture(load_texture({{"texCoord", 5}, {"extensions", override}})).uv_set, 1u);
}

TEST(GltfTexture, IgnoresAnotherSetWithAWarning) {
    const Scene scene = load_texture({{"texCoord", 2}});
    EXPECT_FALSE(scene.materials.at(0).base_color_texture);
    EXPECT_TRUE(scene.images.empty());
    EXPECT_ONE_WARNING(scene, "materials[0].baseColorTexture.texCoord = 2", "TEXCOORD_1");
}

TEST(GltfTexture, IgnoresOneWithoutASourceWithAWarning) {
    GltfBuilder builder = textured_triangle();
    builder.document["extensionsUsed"] = {"KHR_texture_basisu"};
    builder.add("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    const Scene scene = load(builder);
    EXPECT_FALSE(scene.materials.at(0).base_color_texture);
    EXPECT_ONE_WARNING(scene, "textures[0] (materials[0].baseColorTexture)", "no PNG, JPEG or WebP");
    EXPECT_ONE_WARNING(scene, "\"KHR_texture_basisu\"", "lacks");
}

TEST(GltfTexture, TakesTheWebpWhereThereAreTwo) {
    GltfBuilder builder = textured_triangle();
    const std::vector<std::uint8_t> texel(green.begin(), green.end());
    builder.texture(test::encode_webp({1, 1}, texel));
    const int texture = builder.texture(test::one_texel_png(red));
    builder.document["textures"][texture]["extensions"]["EXT_texture_webp"]["source"] = 0;
    builder.document["extensionsUsed"] = {"EXT_texture_webp"};
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const Scene both = load(builder);
    EXPECT_EQ(both.images.at(base_color_texture(both).image).rgba, texel);
    EXPECT_EQ(warnings_with(both, {"webp"}), 0) << all_warnings(both);
    // What is no WebP, or breaks off behind its header, or is not there, is as if the program could not read any.
    std::vector<std::uint8_t> noise(4 * 64 * 64);
    for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = std::uint8_t(i * i * i >> 5);
    std::string cut = test::encode_webp({64, 64}, noise);
    cut.resize(cut.size() / 2);
    GltfBuilder broken = builder;
    for (const std::string& bytes : {std::string("RIFF\1\1\1\1WEBPVP8 broken"), cut}) {
        broken = builder;
        broken.document["images"][0] = {{"uri", test::data_uri(bytes, "image/webp")}};
        const Scene fallback = load(broken);
        EXPECT_EQ(fallback.images.at(base_color_texture(fallback).image).rgba,
                  std::vector<std::uint8_t>(red.begin(), red.end()));
        EXPECT_EQ(fallback.images.size(), 1u);
        EXPECT_ONE_WARNING(fallback, "images[0] (broken WebP", "unreadable");
        broken.document["textures"][texture].erase("source");
        const Scene without = load(broken);
        EXPECT_FALSE(without.materials.at(0).base_color_texture);
        EXPECT_TRUE(without.images.empty());
        EXPECT_ONE_WARNING(without, "images[0] (broken WebP", "unreadable");
    }
    broken = builder;
    broken.document["images"][0] = {{"uri", "gone.webp"}};
    const Scene absent = load(broken);
    EXPECT_EQ(absent.images.at(base_color_texture(absent).image).rgba,
              std::vector<std::uint8_t>(red.begin(), red.end()));
    builder.document["textures"][texture].erase("source");
    builder.document["extensionsRequired"] = {"EXT_texture_webp"};
    const Scene alone = load(builder);
    EXPECT_EQ(alone.images.at(base_color_texture(alone).image).rgba, texel);
    builder.document["textures"][texture]["extensions"]["EXT_texture_webp"]["source"] = 2;
    expect_bad_scene(builder.gltf(), {"textures[1].extensions.EXT_texture_webp.source is 2", "images has 2"});
}

TEST(GltfTexture, FallsBackFromAFormatItLacks) {
    GltfBuilder builder = textured_triangle();
    const int texture = builder.texture(test::one_texel_png(red));
    builder.document["extensionsUsed"] = {"KHR_texture_basisu"};
    builder.document["textures"][texture]["extensions"]["KHR_texture_basisu"]["source"] = 0;
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.images.at(base_color_texture(scene).image).rgba, std::vector<std::uint8_t>(red.begin(), red.end()));
    EXPECT_ONE_WARNING(scene, "\"KHR_texture_basisu\"", "lacks");
    builder.document["extensionsRequired"] = {"KHR_texture_basisu"};
    expect_bad_scene(builder.gltf(),
                     {"extensionsRequired is \"KHR_texture_basisu\"", "lacks it: export its textures as PNG, JPEG"});
}

// ---- specular-glossiness ----

TEST(GltfSpecularGlossiness, IsADielectricOfItsSpecularColour) {
    GltfBuilder builder = textured_triangle();
    set_material(builder, {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"baseColorFactor", {0, 0, 0, 1}}}},
                           {"extensions",
                            {{"KHR_materials_pbrSpecularGlossiness",
                              {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                               {"specularFactor", {0.9, 0.5, 0.25}},
                               {"glossinessFactor", 0.75}}}}}});
    builder.document["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
    const Scene scene = load(builder);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.opacity, 0.4f);
    EXPECT_EQ(m.metallic, 0.0f);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.ior, 0.0f);
    EXPECT_EQ(m.specular, 1.0f);
    EXPECT_EQ(m.specular_color, glm::vec3(0.9f, 0.5f, 0.25f));
    EXPECT_ONE_WARNING(scene, "materials[0].KHR_materials_pbrSpecularGlossiness", "KHR_materials_specular");
}

TEST(GltfSpecularGlossiness, ItsTextureIsThatOfTheColourAndOfTheRoughness) {
    const auto loaded = [](const json& values, const json& extensions = json::object()) {
        GltfBuilder builder = textured_triangle();
        builder.texture(test::encode_png({2, 1}, {255, 0, 0, 255, 10, 20, 30, 51}));
        json all = extensions;
        all["KHR_materials_pbrSpecularGlossiness"] = values;
        set_material(builder, {{"extensions", all}});
        return load(builder);
    };
    const json texture = {{"index", 0}};
    const Scene scene =
        loaded({{"diffuseTexture", texture}, {"specularGlossinessTexture", texture}, {"glossinessFactor", 0.5}});
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.roughness, 1.0f);
    ASSERT_EQ(scene.images.size(), 2u);
    const std::uint32_t color = m.specular_color_texture.value().image;
    EXPECT_EQ(m.base_color_texture.value().image, color);
    EXPECT_EQ(scene.images[color].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 10, 20, 30, 51}));
    // 255 (1 - 0.5 a)
    EXPECT_EQ(scene.images[m.metallic_roughness_texture.value().image].rgba,
              (std::vector<std::uint8_t>{0, 128, 0, 255, 0, 230, 0, 255}));

    // Without its image the factors are what is left.
    const json absent = {{"index", 0}};
    GltfBuilder builder = textured_triangle();
    builder.add("textures", {{"source", builder.add("images", {{"uri", "gone.png"}})}});
    set_material(builder, {{"extensions",
                            {{"KHR_materials_pbrSpecularGlossiness",
                              {{"specularGlossinessTexture", absent}, {"glossinessFactor", 0.75}}}}}});
    EXPECT_EQ(load(builder).materials.at(0).roughness, 0.25f);

    const Scene unlit = loaded({{"diffuseFactor", {1, 0, 0, 1}}}, {{"KHR_materials_unlit", json::object()}});
    EXPECT_EQ(unlit.materials.at(0).base_color, glm::vec3(1.0f)) << "the core's";
}

// ---- images ----

TEST(GltfImage, ReadsFilesDataUrisAndBufferViewsAlike) {
    const std::string png = test::encode_png({2, 1}, {255, 0, 0, 255, 0, 255, 0, 7});
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "my textures");
    test::write_bytes(folder / "my textures/a.png", png);
    for (const char* uri : {"", "my%20textures/a.png", "data"}) {
        SCOPED_TRACE(uri);
        GltfBuilder builder = textured_triangle();
        if (*uri == 0) {
            builder.texture(png);
        } else {
            const std::string text = uri == std::string("data") ? test::data_uri(png, "image/png") : uri;
            builder.add("textures", {{"source", builder.add("images", {{"uri", text}, {"name", "stripes"}})}});
        }
        set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        test::write_bytes(folder / "scene.gltf", builder.gltf());
        const Scene scene = load_gltf(folder / "scene.gltf");
        ASSERT_EQ(scene.images.size(), 1u) << all_warnings(scene);
        EXPECT_EQ(scene.images[0].size, (Extent{2, 1}));
        EXPECT_EQ(scene.images[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 7}));
        EXPECT_EQ(scene.images[0].name, *uri ? "stripes" : "");
    }
}

TEST(GltfImage, DecodesWhatTrianglesUseAndThatOnce) {
    GltfBuilder builder = textured_triangle();
    const std::string uri = test::data_uri(test::one_texel_png(green), "image/png");
    for (int i = 0; i < 2; ++i) builder.add("textures", {{"source", builder.add("images", {{"uri", uri}})}});
    const int broken = builder.texture("no picture");
    set_material(builder, {{"pbrMetallicRoughness",
                            {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
                           {"normalTexture", {{"index", 1}}}});
    builder.add("materials", {{"normalTexture", {{"index", broken}}}});
    builder.document["meshes"].push_back(builder.document["meshes"][0]);  // in no node
    builder.document["meshes"][1]["primitives"][0]["material"] = 1;
    const Scene scene = load(builder);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(base_color_texture(scene).image, 0u);
    EXPECT_EQ(scene.materials[0].normal_texture.value().image, 0u);
}

TEST(GltfImage, ItsFileGoesIntoTheHash) {
    const test::TemporaryFolder folder;
    GltfBuilder builder = textured_triangle();
    builder.add("textures", {{"source", builder.add("images", {{"uri", "a.png"}})}});
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    test::write_bytes(folder / "a.png", test::one_texel_png(red));
    const std::uint64_t with_red = load_gltf(folder / "scene.gltf").hash;
    EXPECT_EQ(load_gltf(folder / "scene.gltf").hash, with_red);
    test::write_bytes(folder / "a.png", test::one_texel_png(green));
    EXPECT_NE(load_gltf(folder / "scene.gltf").hash, with_red);
}

/// A triangle whose base colour has one image.
GltfBuilder with_image(const json& image) {
    GltfBuilder builder = textured_triangle();
    builder.add("textures", {{"source", builder.add("images", image)}});
    set_material(builder, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    return builder;
}

TEST(GltfImage, AnAbsentOneOrOneOfAnotherFormatIsAWarning) {
    const Scene absent = load(with_image({{"uri", "gone.png"}}));
    EXPECT_FALSE(absent.materials.at(0).base_color_texture);
    EXPECT_TRUE(absent.uv[0].empty());
    EXPECT_ONE_WARNING(absent, "images[0] (\"gone.png\": no such file)", "absent");
    // What is refused for safety costs the texture, not the picture.
    for (const char* uri : {"../../../../../etc/x.png", "/etc/x.png", "file:///x.png", "https://example.com/x.png"}) {
        const Scene refused = load(with_image({{"uri", uri}}));
        EXPECT_FALSE(refused.materials.at(0).base_color_texture);
        EXPECT_ONE_WARNING(refused, std::string("images[0] (\"") + uri, "absent");
    }
    const Scene ktx = load(with_image({{"uri", test::data_uri("\xabKTX 20\xbb\r\n\x1a\n", "image/ktx2")}}));
    EXPECT_FALSE(ktx.materials.at(0).base_color_texture);
    EXPECT_ONE_WARNING(ktx, "images[0]", "lacks KTX2: export PNG, JPEG or WebP");
    const Scene gif = load(with_image({{"uri", test::data_uri("GIF89a", "image/gif")}}));
    EXPECT_FALSE(gif.materials.at(0).base_color_texture);
    EXPECT_ONE_WARNING(gif, "images[0]", "lacks GIF: export PNG, JPEG or WebP");
}

TEST(GltfImage, ADamagedOneThatIsWholeIsAWarning) {
    std::string jpeg = test::encode_jpeg({8, 8}, std::vector<std::uint8_t>(64, 77), true);
    jpeg.insert(jpeg.size() - 2, 16, 'x');  // before the mark of its end
    const Scene scene = load(with_image({{"uri", test::data_uri(jpeg, "image/jpeg")}}));
    EXPECT_TRUE(scene.materials.at(0).base_color_texture);
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_NEAR(scene.images[0].rgba.at(0), 77, 1);
    EXPECT_ONE_WARNING(scene, "images[0] (", "extraneous", "damaged");
}

TEST(HostileImage, IsRefusedByALineThatNamesIt) {
    expect_bad_scene(with_image({{"uri", "data:;base64,****"}}).gltf(), {"images[0].uri is", "base64"});
    expect_bad_scene(with_image({{"name", "nothing"}}).gltf(), {"images[0] is", "nothing", "either a uri or"});
    expect_bad_scene(with_image({{"uri", "a.png"}, {"bufferView", 0}}).gltf(), {"images[0] is", "either a uri or"});
    expect_bad_scene(with_image({{"bufferView", 9}}).gltf(), {"images[0].bufferView is 9", "bufferViews has 3"});
    expect_bad_scene(with_image({{"uri", 7}}).gltf(), {"images[0].uri is 7", "string"});
}

TEST(GltfImage, ABrokenOneCostsItsTexturesAndNoOthers) {
    const auto expect_none = [](const GltfBuilder& builder, const char* object, const char* why) {
        const Scene scene = load(builder);
        EXPECT_FALSE(scene.materials.at(0).base_color_texture);
        EXPECT_TRUE(scene.images.empty());
        EXPECT_ONE_WARNING(scene, object, why, "unreadable, its textures do without it");
    };
    expect_none(with_image({{"bufferView", 0}}), "images[0]", "neither PNG, JPEG nor WebP");
    const std::string png = test::one_texel_png(red);
    const json broken = {{"uri", test::data_uri(png.substr(0, 45), "image/png")}};
    expect_none(with_image(broken), "images[0]", "broken PNG");
    // A file beside the scene is named as well: here the scene itself.
    expect_none(with_image({{"uri", "scene.gltf"}}), "images[0] (\"scene.gltf\"", "neither PNG");

    GltfBuilder builder = with_image(broken);
    builder.texture(test::one_texel_png(green));
    builder.document["materials"][0]["normalTexture"]["index"] = 1;
    const Scene scene = load(builder);
    EXPECT_FALSE(scene.materials.at(0).base_color_texture);
    ASSERT_TRUE(scene.materials.at(0).normal_texture);
    EXPECT_EQ(scene.images.at(scene.materials[0].normal_texture->image).rgba,
              std::vector<std::uint8_t>(green.begin(), green.end()));
    EXPECT_EQ(scene.images.size(), 1u);
}

/// An all-black PNG.
std::string black_png(const Extent& size) {
    const std::vector<std::uint8_t> rows((size.width + 7) / 8 * size.height);
    return test::encode_png(size, {PNG_COLOR_TYPE_GRAY, 1}, rows);
}

TEST(HostileImage, IsRefusedWhereItIsTooLarge) {
    expect_bad_scene(with_image({{"uri", test::data_uri(black_png({16385, 1}), "image/png")}}).gltf(),
                     {"the size of images[0] is 16385 x 1", "16384 texels a side"});
    expect_bad_scene(with_image({{"uri", test::data_uri(black_png({1, 16385}), "image/png")}}).gltf(),
                     {"the size of images[0] is 1 x 16385", "16384 texels a side"});
    // 2^27 + 16384 texels from some 20 kB.
    expect_bad_scene(with_image({{"uri", test::data_uri(black_png({16384, 8193}), "image/png")}}).gltf(),
                     {"number of texels, with those of images[0] is 134234112", "134217728"});
    // Two that are within the limit apart and beyond it together: the second is not decoded.
    GltfBuilder builder = with_image({{"uri", test::data_uri(black_png({1024, 1}), "image/png")}});
    builder.texture(black_png({16384, 8192}));
    builder.document["materials"][0]["normalTexture"]["index"] = 1;
    expect_bad_scene(builder.gltf(), {"with those of images[1] is 134218752", "134217728"});
}

TEST(HostileTexture, IsRefusedByALineThatNamesIt) {
    const auto with = [](const json& texture, const json& info) {
        GltfBuilder builder = textured_triangle();
        builder.texture(test::one_texel_png(red));
        builder.document["textures"][0].merge_patch(texture);
        json whole = info;
        whole["index"] = 0;
        set_material(builder, {{"normalTexture", whole}});
        return builder;
    };
    const json none = json::object();
    expect_bad_scene(with({{"source", 4}}, none).gltf(), {"textures[0].source is 4", "images has 1"});
    expect_bad_scene(with({{"sampler", 0}}, none).gltf(), {"textures[0].sampler is 0", "samplers has 0"});
    expect_bad_scene(with(none, {{"texCoord", -1}}).gltf(), {"materials[0].normalTexture.texCoord is -1", "0 to"});
    expect_bad_scene(with(none, {{"scale", "big"}}).gltf(), {"materials[0].normalTexture.scale is \"big\"", "number"});
    const auto transform = [](const json& value) -> json {
        return {{"extensions", {{"KHR_texture_transform", value}}}};
    };
    expect_bad_scene(with(none, transform({{"scale", {1, 1e9}}})).gltf(),
                     {"materials[0].normalTexture.extensions.KHR_texture_transform is 1000000000", "16777216"});
    expect_bad_scene(with(none, transform({{"offset", {1}}})).gltf(), {"offset is an array of 1", "must hold 2"});
    GltfBuilder builder = with({{"sampler", 0}}, none);
    builder.add("samplers", {{"wrapS", 0.5}});
    expect_bad_scene(builder.gltf(), {"samplers[0].wrapS is 0.5", "integer"});
    // Filters and wraps that glTF does not have, as exporters write them for none.
    builder.document["samplers"] = {{{"magFilter", 9987}, {"wrapS", -4294957296}, {"wrapT", 33648}}};
    const Scene scene = load(builder);
    const Texture& texture = scene.materials.at(0).normal_texture.value();
    EXPECT_FALSE(texture.nearest);
    EXPECT_EQ(texture.wrap_s, Texture::Wrap::repeat);
    EXPECT_EQ(texture.wrap_t, Texture::Wrap::mirrored_repeat);
    EXPECT_ONE_WARNING(scene, "samplers[0].magFilter = 9987 (and 1 more)", "no such number");
}

}  // namespace
}  // namespace vkcppm
