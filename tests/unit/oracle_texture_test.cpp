// Texture lookup and textured surfaces of the oracle, texel by texel.

#include <array>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "oracle/surface.h"
#include "oracle/texture.h"

namespace vkcppm::oracle {
namespace {

/// 2 x 2: red channel 0, 51 / 102, 255; green 255 everywhere; blue 0; alpha 128.
TextureImage four_texels() {
    return {"four", {2, 2}, {0, 255, 0, 128, 51, 255, 0, 128, 102, 255, 0, 128, 255, 255, 0, 128}};
}

double red(const Texture& texture, double u, double v, Encoding encoding = Encoding::linear) {
    return lookup(texture, four_texels(), {u, v}, encoding).r;
}

TEST(OracleTexture, TexelCentresAreAtHalves) {
    Texture texture;
    for (const bool nearest : {false, true}) {
        texture.nearest = nearest;
        EXPECT_NEAR(red(texture, 0.25, 0.25), 0.0, 1e-15);
        EXPECT_NEAR(red(texture, 0.75, 0.25), 0.2, 1e-15) << "u to the right";
        EXPECT_NEAR(red(texture, 0.25, 0.75), 0.4, 1e-15) << "v downwards";
        EXPECT_NEAR(red(texture, 0.75, 0.75), 1.0, 1e-15);
    }
    EXPECT_NEAR(red(texture, 0.49, 0.49), 0.0, 1e-15) << "nearest";
    texture.nearest = false;
    EXPECT_NEAR(red(texture, 0.5, 0.5), 0.4, 1e-15) << "mean of the four";
    EXPECT_NEAR(red(texture, 0.5, 0.25), 0.1, 1e-15);
    EXPECT_NEAR(red(texture, 0.375, 0.25), 0.05, 1e-15);
}

TEST(OracleTexture, Wraps) {
    Texture texture;
    texture.wrap_t = Texture::Wrap::clamp_to_edge;
    texture.nearest = true;
    const auto row = [&](Texture::Wrap wrap, double u) {
        texture.wrap_s = wrap;
        return red(texture, u, -7.0);
    };
    for (const double turn : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
        const bool odd = std::abs(turn) == 1.0;
        EXPECT_EQ(row(Texture::Wrap::repeat, turn + 0.25), 0.0);
        EXPECT_EQ(row(Texture::Wrap::repeat, turn + 0.75), 0.2);
        EXPECT_EQ(row(Texture::Wrap::mirrored_repeat, turn + 0.25), odd ? 0.2 : 0.0) << turn;
        EXPECT_EQ(row(Texture::Wrap::mirrored_repeat, turn + 0.75), odd ? 0.0 : 0.2) << turn;
        EXPECT_EQ(row(Texture::Wrap::clamp_to_edge, turn + 0.25), turn > 0.0 ? 0.2 : 0.0) << turn;
    }
    texture.nearest = false;
    EXPECT_NEAR(row(Texture::Wrap::repeat, 0.0), 0.1, 1e-15) << "between the last texel and the first";
    EXPECT_NEAR(row(Texture::Wrap::mirrored_repeat, 0.0), 0.0, 1e-15) << "the first twice";
    EXPECT_NEAR(row(Texture::Wrap::clamp_to_edge, 0.0), 0.0, 1e-15);
    EXPECT_NEAR(row(Texture::Wrap::clamp_to_edge, 1.0), 0.2, 1e-15);
}

TEST(OracleTexture, TransformComesBeforeTheLookup) {
    Texture texture;
    texture.matrix = glm::mat2(0.0f, 1.0f, 1.0f, 0.0f);  // swaps u and v
    texture.offset = {0.5f, 0.0f};
    EXPECT_NEAR(red(texture, 0.75, -0.25), 0.4, 1e-15) << "(0.75, -0.25) to (0.25, 0.75)";
}

TEST(OracleTexture, DecodesBeforeItInterpolates) {
    const Texture texture;
    const double fifth = std::pow((0.2 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(red(texture, 0.75, 0.25, Encoding::srgb), fifth, 1e-15);
    EXPECT_NEAR(red(texture, 0.5, 0.25, Encoding::srgb), fifth / 2.0, 1e-15);
    const double alpha = lookup(texture, four_texels(), {0.3, 0.4}, Encoding::srgb).a;
    EXPECT_NEAR(alpha, 128.0 / 255.0, 1e-15) << "alpha is linear";
    const TextureImage dark{"dark", {1, 1}, {10, 10, 10, 10}};
    EXPECT_NEAR(lookup(texture, dark, {0.0, 0.0}, Encoding::srgb).r, 10.0 / 255.0 / 12.92, 1e-15) << "the linear part";
}

/// A triangle in z = 0 with its corners at (0, 0), (1, 0), (0, 1), texture coordinates (x, 1 - y) in set 0 and
/// (y, x) in set 1, and one texel in the only image.
Scene one_triangle(const std::array<std::uint8_t, 4>& texel) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.normals.assign(3, {0.0f, 0.0f, 1.0f});
    scene.uv[0] = {{0.0f, 1.0f}, {1.0f, 1.0f}, {0.0f, 0.0f}};
    scene.uv[1] = {{0.0f, 0.0f}, {0.0f, 1.0f}, {1.0f, 0.0f}};
    scene.triangles = {{{0, 1, 2}, 0}};
    scene.materials.emplace_back();
    scene.images.push_back({"texel", {1, 1}, {texel.begin(), texel.end()}});
    return scene;
}

const Hit middle{1.0, {0.25, 0.25, 0.5}, 0};
const glm::dvec3 down(0.0, 0.0, -1.0), up(0.0, 0.0, 1.0);

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, const char* what) {
    EXPECT_LT(glm::distance(value, expected), 1e-7)
        << what << ": (" << value.x << ", " << value.y << ", " << value.z << ") instead of (" << expected.x << ", "
        << expected.y << ", " << expected.z << ")";
}

TEST(OracleSurface, TextureCoordinatesAreInterpolatedInBothSets) {
    const Scene scene = one_triangle({0, 0, 0, 0});
    EXPECT_EQ(uv_at(scene, middle, 0), glm::dvec2(0.25, 0.5));
    EXPECT_EQ(uv_at(scene, middle, 1), glm::dvec2(0.5, 0.25));
}

TEST(OracleSurface, EveryTextureMultipliesItsFactor) {
    Scene scene = one_triangle({255, 51, 102, 204});
    const double second = std::pow((0.2 + 0.055) / 1.055, 2.4), third = std::pow((0.4 + 0.055) / 1.055, 2.4);
    Material& m = scene.materials[0];
    m.base_color = m.emission = m.specular_color = glm::vec3(0.5f);
    m.metallic = m.roughness = m.clearcoat = m.clearcoat_roughness = m.specular = m.transmission = 0.5f;
    m.base_color_texture = m.metallic_roughness_texture = m.emissive_texture = m.transmission_texture = Texture{};
    m.specular_texture = m.specular_color_texture = m.clearcoat_texture = m.clearcoat_roughness_texture = Texture{};
    const Surface surface = surface_at(scene, middle, down);
    const glm::dvec3 color = 0.5 * glm::dvec3(1.0, second, third);
    expect_near(surface.base_color, color, "base colour");
    expect_near(surface.bsdf.base_color, color, "base colour of the bsdf");
    const glm::dvec3 emission = (1.0 - 0.5 * 0.04) * color;  // below the clearcoat
    expect_near(surface.emission, emission, "emission");
    expect_near(surface.bsdf.specular_color, color, "specular colour");
    EXPECT_NEAR(surface.bsdf.metallic, 0.5 * 0.4, 1e-12);
    EXPECT_NEAR(surface.bsdf.alpha, 0.1 * 0.1, 1e-12);
    EXPECT_NEAR(surface.bsdf.transmission, 0.5, 1e-12);
    EXPECT_NEAR(surface.bsdf.specular, 0.5 * 0.8, 1e-12);
    EXPECT_NEAR(surface.bsdf.coat, 0.5, 1e-12);
    EXPECT_NEAR(surface.bsdf.coat_alpha, 0.1 * 0.1, 1e-12);
    scene.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}};
    expect_near(surface_at(scene, middle, down).base_color, color * glm::dvec3(0.25, 0.25, 0.5), "vertex colours");
    expect_near(surface_at(scene, middle, down).emission, emission, "vertex colours do not touch the emission");
}

TEST(OracleSurface, Coverage) {
    Scene scene = one_triangle({255, 255, 255, 204});
    Material& m = scene.materials[0];
    m.base_color_texture = Texture{};
    m.opacity = 0.5f;
    EXPECT_EQ(coverage(scene, middle), 1.0) << "opaque";
    m.alpha = Material::Alpha::blend;
    EXPECT_NEAR(coverage(scene, middle), 0.4, 1e-12);
    scene.colors = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
    EXPECT_NEAR(coverage(scene, middle), 0.2, 1e-12);
    m.alpha = Material::Alpha::mask;
    m.alpha_cutoff = 0.21f;
    EXPECT_EQ(coverage(scene, middle), 0.0);
    m.alpha_cutoff = 0.19f;
    EXPECT_EQ(coverage(scene, middle), 1.0);
}

TEST(OracleSurface, NormalTextureInTheTangentSpace) {
    // (255, 127.5, 127.5): as near to +x as bytes go; x = 1, y = z = 1 / 255 at 128.
    Scene scene = one_triangle({255, 128, 128, 255});
    scene.materials[0].normal_texture = Texture{};
    const auto tilted = [](const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
        return glm::normalize(x + (y + z) / 255.0);
    };
    const glm::dvec3 ex(1, 0, 0), ey(0, 1, 0), ez(0, 0, 1);
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(ex, ey, ez), "from set 0: x right, y up");
    expect_near(surface_at(scene, middle, up).shading_normal, -tilted(ex, ey, ez), "from behind");
    scene.materials[0].normal_texture->matrix = glm::mat2(-1, 0, 0, 1);
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(-ex, ey, ez), "mirrored by its transform");
    // Column by column: u turns to v, v to -u. The new u grows upwards, the new v to the right.
    scene.materials[0].normal_texture->matrix = glm::mat2(0, 1, -1, 0);
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(ey, -ex, ez), "turned by its transform");
    scene.materials[0].normal_texture->matrix = glm::mat2(1);
    scene.materials[0].normal_texture->uv_set = 1;
    // u grows along +y and v along +x, so that the bitangent, against growing v, is -x.
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(ey, -ex, ez), "from set 1");
    scene.uv[1] = {{0.0f, 0.0f}, {0.0f, -1.0f}, {1.0f, 0.0f}};
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(ey, ex, ez), "mirrored");
    scene.tangents.assign(3, {0.0f, -1.0f, 0.0f, 1.0f});
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(-ey, ex, ez), "given, w = 1");
    scene.tangents.assign(3, {0.0f, -1.0f, 0.0f, -1.0f});
    expect_near(surface_at(scene, middle, down).shading_normal, tilted(-ey, -ex, ez), "given, w = -1");
    expect_near(surface_at(scene, middle, down).bsdf.coat_normal, ez, "the coat has none");
    scene.materials[0].normal_scale = 0.0f;
    expect_near(surface_at(scene, middle, down).shading_normal, ez, "scale 0");
    scene.materials[0].clearcoat_normal_texture = Texture{};
    expect_near(surface_at(scene, middle, down).bsdf.coat_normal, tilted(-ey, -ex, ez), "the coat's own");
}

TEST(OracleSurface, AbsorptionOfAVolume) {
    Material material;
    EXPECT_EQ(absorption(material), glm::dvec3(0.0));
    material.attenuation_color = {0.5f, 0.25f, 1.0f};
    material.attenuation_distance = 2.0f;
    expect_near(absorption(material), {std::log(2.0) / 2.0, std::log(2.0), 0.0}, "-ln(colour) / distance");
}

}  // namespace
}  // namespace vkcppm::oracle
