// --set: values of materials that a file does not have.

#include "scene/gltf/material_changes.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/files/pictures.h"
#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// One triangle of material 1, "glass"; 0 and 2 are both "wall: left".
GltfBuilder with_materials() {
    GltfBuilder b = test::one_triangle();
    b.add("materials", {{"name", "wall: left"}});
    b.add("materials", {{"name", "glass"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 0.25}}}}});
    b.add("materials", {{"name", "wall: left"}});
    b.document["meshes"][0]["primitives"][0]["material"] = 1;
    return b;
}

Scene load_with(const GltfBuilder& builder, const std::vector<std::string>& words) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    GltfOptions options;
    for (const std::string& word : words) options.set.push_back(parse_material_change(word));
    return load_gltf(folder / "scene.gltf", options);
}

/// What is said about a word that is refused as wrong usage; empty where it is not.
std::string refusal_of(const std::string& word) {
    const auto error = test::thrown_by([&] { load_with(with_materials(), {word}); });
    return error && error->code() == ExitCode::usage ? error->what() : "";
}

TEST(MaterialChanges, ReachEveryMemberOfTheTable) {
    const Scene scene =
        load_with(with_materials(),
                  {"glass:baseColorFactor=0.1,0.2,0.3:metallicFactor=0:roughnessFactor=0.25:emissiveFactor=1,0.5,0.25",
                   "1:emissiveStrength=8:alphaCutoff=0.75:ior=1.33:attenuationDistance=0.5:attenuationColor=0.9,1,0.5",
                   "glass:transmissionFactor=0.75:thicknessFactor=2:dispersion=0.5:specularFactor=0.5",
                   "glass:specularColorFactor=2,1,0:clearcoatFactor=0.125:clearcoatRoughnessFactor=0.375"});
    const Material& glass = scene.materials.at(1);
    EXPECT_EQ(glass.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(glass.opacity, 0.25f) << "the alpha of the base colour stays";
    EXPECT_EQ(glass.metallic, 0.0f);
    EXPECT_EQ(glass.roughness, 0.25f);
    EXPECT_EQ(glass.emission, glm::vec3(8, 4, 2));
    EXPECT_EQ(glass.alpha_cutoff, 0.75f);
    EXPECT_EQ(glass.ior, 1.33f);
    EXPECT_EQ(glass.attenuation_distance, 0.5f);
    EXPECT_EQ(glass.attenuation_color, glm::vec3(0.9f, 1.0f, 0.5f));
    EXPECT_EQ(glass.transmission, 0.75f);
    EXPECT_EQ(glass.thickness, 2.0f);
    EXPECT_EQ(glass.dispersion, 0.5f);
    EXPECT_EQ(glass.specular, 0.5f);
    EXPECT_EQ(glass.specular_color, glm::vec3(2, 1, 0));
    EXPECT_EQ(glass.clearcoat, 0.125f);
    EXPECT_EQ(glass.clearcoat_roughness, 0.375f);
    EXPECT_EQ(scene.materials.at(0).ior, 1.5f);
    EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(0.0f));
}

TEST(MaterialChanges, AreOfAllMaterialsOfTheName) {
    const Scene scene = load_with(with_materials(), {"wall: left:ior=2:ior=1.75"});
    EXPECT_EQ(scene.materials.at(0).ior, 1.75f) << "the last counts";
    EXPECT_EQ(scene.materials.at(1).ior, 1.5f);
    EXPECT_EQ(scene.materials.at(2).ior, 1.75f);
}

TEST(MaterialChanges, BringTexturesThatTheFactorKeptOut) {
    GltfBuilder b = with_materials();
    const int texture = b.texture(test::one_texel_png({255, 0, 0, 255}));
    b.document["materials"][1]["extensions"]["KHR_materials_transmission"]["transmissionTexture"]["index"] = texture;
    EXPECT_FALSE(load_with(b, {}).materials.at(1).transmission_texture);
    EXPECT_TRUE(load_with(b, {"glass:transmissionFactor=1"}).materials.at(1).transmission_texture);
}

TEST(MaterialChanges, MakeAnotherScene) {
    const std::uint64_t plain = load_with(with_materials(), {}).hash;
    const std::uint64_t set = load_with(with_materials(), {"glass:ior=1.33"}).hash;
    EXPECT_NE(set, plain);
    EXPECT_NE(load_with(with_materials(), {"glass:ior=1.34"}).hash, set);
    EXPECT_EQ(load_with(with_materials(), {"glass:ior=1.330"}).hash, set) << "the same number";
    EXPECT_EQ(parse_material_change("a:b:ior=1.330:attenuationColor=1,0.50,0").text(),
              "a:b:ior=1.33:attenuationColor=1,0.5,0");
}

TEST(MaterialChanges, AreRefusedWithWhatThereIs) {
    EXPECT_NE(refusal_of("gloss:ior=1.3").find("'gloss' is none of the materials of "), std::string::npos)
        << refusal_of("gloss:ior=1.3");
    EXPECT_NE(refusal_of("gloss:ior=1.3").find("1 'glass'"), std::string::npos);
    EXPECT_NE(refusal_of("3:ior=1.3").find("2 'wall: left'"), std::string::npos);
    EXPECT_NE(refusal_of("glass:index=1.3").find("'index' is none of baseColorFactor, metallicFactor"),
              std::string::npos);
    EXPECT_NE(refusal_of("glass:ior=0.5").find("ior '0.5' is not 1 or more"), std::string::npos);
    EXPECT_NE(refusal_of("glass:roughnessFactor=1.5").find("roughnessFactor '1.5' is not 0..1"), std::string::npos);
    EXPECT_NE(refusal_of("glass:attenuationDistance=0").find("'0' is not above 0"), std::string::npos);
    for (const char* value : {"0.5", "1,1", "1,1,1,1", "1,2,1", "1,nan,1", "1,,1", ""}) {
        EXPECT_NE(refusal_of(std::string("glass:baseColorFactor=") + value).find("' is not R,G,B of 0..1"),
                  std::string::npos)
            << value;
    }
    for (const char* value : {"", "x", "1x", "nan", "inf", "1,1", "1e300"}) {
        EXPECT_NE(refusal_of(std::string("glass:ior=") + value).find("' is not 1 or more"), std::string::npos) << value;
    }
    for (const char* word : {"", "glass", "glass:", ":ior=1.3", "ior=1.3", "glass:ior"}) {
        EXPECT_NE(refusal_of(word).find("it is not MATERIAL:member=value"), std::string::npos) << word;
    }
}

TEST(MaterialChanges, ALineOfTheHelpIsNoWiderThanAsked) {
    const std::string text = material_members(60);
    for (std::size_t begin = 0, end = 0; end != text.npos; begin = end + 1) {
        end = text.find('\n', begin);
        EXPECT_LE(std::min(end, text.size()) - begin, 60u);
    }
    EXPECT_NE(text.find("clearcoatRoughnessFactor (0..1)"), std::string::npos);
}

}  // namespace
}  // namespace vkcppm
