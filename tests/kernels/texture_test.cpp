// Textures looked up on the device, and what they make of a surface, against oracle/texture and oracle/surface in
// double.

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/features.h"
#include "flat/flatten.h"
#include "kernels/probe.h"
#include "oracle/surface.h"
#include "oracle/texture.h"
#include "support/device/gpu.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t texture_words[] = {
#include "texture.spv.inc"
};

using Wrap = Texture::Wrap;

std::uint32_t add_image(Scene& scene, std::uint32_t width, std::uint32_t height, std::mt19937& random, int bits = 8) {
    TextureImage image{"noise", {width, height}, {}};
    for (std::uint32_t i = 0; i < 4 * width * height; ++i) image.rgba.push_back(std::uint8_t(random()));
    if (bits == 16) {
        for (std::size_t i = 0; i < image.rgba.size(); ++i) {
            const int rest = int(random() % 255) - 127, value = 257 * image.rgba[i] + rest;
            image.rest.push_back(std::int8_t(value < 0 || value > 65535 ? -rest : rest));
        }
    }
    scene.images.push_back(image);
    return std::uint32_t(scene.images.size() - 1);
}

/// Every texel the same.
std::uint32_t add_plain_image(Scene& scene, const std::array<std::uint8_t, 4>& rgba) {
    scene.images.push_back({"plain", {2, 2}, {}});
    for (int i = 0; i < 4; ++i)
        scene.images.back().rgba.insert(scene.images.back().rgba.end(), rgba.begin(), rgba.end());
    return std::uint32_t(scene.images.size() - 1);
}

/// A triangle of that material, so that the scene has it.
void add_use(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, std::uint32_t(scene.materials.size() - 1));
}

class Textures : public GpuTest {
protected:
    /// surfaces: at points of triangles, else lookups.
    static std::vector<gpu::TextureOutput> run(const FlatScene& flat, const std::vector<gpu::TextureInput>& inputs,
                                               bool surfaces) {
        Probe probe("texture", texture_words, flat.bvh.stack, bits_of(flat.features));
        probe.input(Binding::triangles, flat.triangles);
        probe.input(Binding::shading, flat.shading);
        probe.input(Binding::instances, flat.instances);
        probe.input(Binding::materials, flat.materials);
        probe.input(Binding::texcoords, flat.texcoords);
        probe.input(Binding::vertex_colors, flat.vertex_colors);
        probe.input(Binding::tangents, flat.tangents);
        probe.input(Binding::textures, flat.textures);
        probe.input(Binding::images, flat.images);
        probe.input(PROBE_INPUT, inputs);
        probe.output<gpu::TextureOutput>(PROBE_OUTPUT, inputs.size());
        probe.run(inputs.size(), {.iteration = 0,
                                  .round = 0,
                                  .last_round = 0,
                                  .argument = surfaces ? 1u : 0u,
                                  .items = std::uint32_t(inputs.size())});
        return probe.result<gpu::TextureOutput>(PROBE_OUTPUT, inputs.size());
    }
};

TEST_F(Textures, LookupsAreTheReferences) {
    std::mt19937 random(31);
    Scene scene;
    std::vector<Texture> textures;
    constexpr std::array<std::array<std::uint32_t, 3>, 9> sizes = {
        {{1, 1, 8}, {1, 7, 8}, {5, 1, 8}, {2, 2, 8}, {16, 16, 8}, {1, 1, 16}, {17, 9, 16}, {37, 53, 8}, {64, 3, 8}}};
    for (const auto& [width, height, bits] : sizes) {
        const std::uint32_t image = add_image(scene, width, height, random, int(bits));
        for (const Wrap s : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
            for (const Wrap t : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
                for (const bool nearest : {false, true}) {
                    Texture texture;
                    texture.image = image;
                    texture.wrap_s = s;
                    texture.wrap_t = t;
                    texture.nearest = nearest;
                    texture.uv_set = std::uint32_t(textures.size() % 2);
                    if (textures.size() % 3 == 1) {  // rotated, scaled, moved
                        texture.matrix = glm::mat2(1.5f, -0.7f, 0.4f, 2.25f);
                        texture.offset = {0.3f, -11.0f};
                    }
                    textures.push_back(texture);
                }
            }
        }
    }
    for (const Texture& texture : textures) {
        Material material;
        material.base_color_texture = material.metallic_roughness_texture = texture;
        add_use(scene, material);
    }
    scene.uv[0].assign(scene.positions.size(), glm::vec2(0.0f));
    scene.uv[1] = scene.uv[0];
    const FlatScene flat = flatten(scene);

    std::uniform_real_distribution<float> near(-2.5f, 2.5f);
    std::vector<gpu::TextureInput> inputs;
    std::vector<std::pair<std::size_t, oracle::Encoding>> uses;
    const auto add = [&](std::size_t index, const glm::vec2& uv) {
        for (const int slot : {TEXTURE_BASE_COLOR, TEXTURE_METALLIC_ROUGHNESS}) {
            gpu::TextureInput input{};
            const glm::vec2 other(0.31f, 0.77f);  // of the set that is not used
            input.coordinates = textures[index].uv_set == 0 ? glm::vec4(uv, other) : glm::vec4(other, uv);
            input.texture = flat.materials[index].texture[slot];
            inputs.push_back(input);
            uses.emplace_back(index, slot == TEXTURE_BASE_COLOR ? oracle::Encoding::srgb : oracle::Encoding::linear);
        }
    };
    for (std::size_t index = 0; index < textures.size(); ++index) {
        for (int i = 0; i < 150; ++i) add(index, {near(random), near(random)});
        // Far away, on fractions that floats there hold exactly.
        for (int i = 0; i < 50; ++i) {
            const auto far = [&] { return float(int(random() % (20000 * 512)) - 10000 * 512) / 512.0f; };
            add(index, {far(), far()});
        }
        for (const float x : {-1e4f, -1.0f, -0.0f, 0.0f, 0.5f, 1.0f, 2.0f, 1e4f}) {
            for (const float y : {-1.0f, 0.0f, 1.0f}) add(index, {x, y});
        }
        for (const float x : {-1e-9f, 0.99999994f, -1.1920929e-7f}) add(index, {x, x});
    }
    const auto outputs = run(flat, inputs, false);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto& [index, encoding] = uses[i];
        const Texture& texture = textures[index];
        const TextureImage& image = scene.images[texture.image];
        const glm::vec4& both = inputs[i].coordinates;
        const glm::dvec2 uv = texture.uv_set == 0 ? glm::dvec2(both.x, both.y) : glm::dvec2(both.z, both.w);
        // Rounding of the transformed coordinates, in texels.
        const glm::dvec2 size(image.size.width, image.size.height);
        const glm::dvec2 place = (glm::dmat2(texture.matrix) * uv + glm::dvec2(texture.offset)) * size;
        const bool exact = texture.matrix == glm::mat2(1.0f) && texture.offset == glm::vec2(0.0f);
        const double far = exact ? 1.0 : 1.0 + 4.0 * (std::abs(uv.x) + std::abs(uv.y)) + 11.0;
        const double rounding = 2.4e-7 * far * std::max(size.x, size.y);
        if (texture.nearest) {
            // On the edge of a texel rounding decides.
            const glm::dvec2 edge = glm::abs(place - glm::round(place));
            if ((edge.x < 2.0 * rounding && image.size.width > 1) ||
                (edge.y < 2.0 * rounding && image.size.height > 1)) {
                continue;
            }
        }
        ++compared;
        const glm::dvec4 want = oracle::lookup(texture, image, uv, encoding);
        // Colours of 16 bits are made linear and rounded to 16 bits, where one in 257 is off by 1.
        const bool is_rounded = encoding == oracle::Encoding::srgb && !image.rest.empty();
        const double exactness = 3e-6 + (is_rounded ? 1.5 / 65535.0 : 0.0);
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(outputs[i].value[c], want[c], exactness + (texture.nearest ? 0.0 : 2.0 * rounding))
                << fmt::format("{} x {}, wraps {} {}, {}, set {}, {}, uv ({:.9g}, {:.9g}), channel {}",
                               image.size.width, image.size.height, int(texture.wrap_s), int(texture.wrap_t),
                               texture.nearest ? "nearest" : "bilinear", texture.uv_set,
                               exact ? "as is" : "transformed", uv.x, uv.y, c);
        }
    }
    EXPECT_GT(compared, inputs.size() * 4 / 5);
}

/// A bumpy sheet whose triangles differ in size and in the sense of their texture coordinates; everything textured.
Scene textured_sheet(std::mt19937& random, bool tangents) {
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto signed_number = [&] { return 2.0f * uniform(random) - 1.0f; };
    Scene scene;
    const std::array kinds = {Material::Alpha::opaque, Material::Alpha::mask, Material::Alpha::blend};
    for (std::uint32_t i = 0; i < 6; ++i) {
        Material m;
        const auto texture = [&](std::uint32_t width, std::uint32_t height) {
            Texture t;
            t.image = add_image(scene, width, height, random);
            t.uv_set = std::uint32_t(random() % 2);
            t.nearest = random() % 3 == 0;
            t.wrap_s = random() % 2 ? Wrap::mirrored_repeat : Wrap::repeat;
            return t;
        };
        m.base_color = {0.9f, 0.8f, 0.7f};
        m.metallic = 0.8f;
        m.roughness = 0.9f;
        m.emission = {3.0f, 2.0f, 1.0f};
        m.opacity = 0.9f;
        m.alpha = kinds[i % 3];
        m.transmission = 0.7f;
        m.specular = 0.6f;
        m.specular_color = {0.5f, 1.0f, 1.5f};
        m.clearcoat = 0.8f;
        m.clearcoat_roughness = 0.7f;
        m.normal_scale = i % 2 ? 0.4f : 0.7f;
        m.clearcoat_normal_scale = 0.3f;
        m.double_sided = i % 2 == 0;
        m.base_color_texture = texture(4, 4);
        m.metallic_roughness_texture = texture(3, 5);
        m.normal_texture = texture(4, 2);
        m.emissive_texture = texture(2, 2);
        m.transmission_texture = texture(1, 4);
        m.specular_texture = texture(4, 1);
        m.specular_color_texture = texture(5, 5);
        m.clearcoat_texture = texture(2, 3);
        m.clearcoat_roughness_texture = texture(3, 3);
        m.clearcoat_normal_texture = texture(2, 2);
        m.anisotropy = 0.9f;
        m.anisotropy_rotation = i % 2 ? 0.7f : 0.0f;
        m.anisotropy_texture = texture(3, 4);
        m.iridescence = 0.8f;
        m.iridescence_texture = texture(2, 4);
        m.iridescence_thickness_texture = texture(5, 2);
        m.sheen_color = {0.9f, 0.5f, 0.7f};
        m.sheen_roughness = 0.9f;
        m.sheen_color_texture = texture(3, 2);
        m.sheen_roughness_texture = texture(2, 5);
        // Tangents follow transformed coordinates: turned by a right angle, mirrored, drawn out.
        const std::array matrices = {glm::mat2(0, 1, -1, 0), glm::mat2(-1, 0, 0, 1), glm::mat2(0.5f, 0, 0, 2)};
        m.normal_texture->matrix = matrices[i % 3];
        m.clearcoat_normal_texture->matrix = matrices[(i + 1) % 3];
        // Blue of a normal map is positive.
        for (const auto& t : {m.normal_texture, m.clearcoat_normal_texture}) {
            auto& rgba = scene.images[t->image].rgba;
            for (std::size_t p = 2; p < rgba.size(); p += 4) rgba[p] |= 192;
        }
        // The direction of the facets is a direction.
        auto& directions = scene.images[m.anisotropy_texture->image].rgba;
        for (std::size_t p = 0; p < directions.size(); p += 4) directions[p] |= 192;
        scene.materials.push_back(m);
    }
    for (std::uint32_t i = 0; i < 120; ++i) {
        const glm::dvec3 at(signed_number(), signed_number(), 0.2 * signed_number());
        const auto corner = [&] {
            return at + glm::dvec3(0.3f * signed_number(), 0.3f * signed_number(), 0.1f * signed_number());
        };
        add_triangle(scene, corner(), corner(), corner(), i % 6);
        for (std::size_t c = 0; c < 3; ++c) {
            glm::vec3& n = scene.normals[scene.normals.size() - 1 - c];
            n = glm::normalize(n + 0.3f * glm::vec3(signed_number(), signed_number(), signed_number()));
            for (auto& set : scene.uv) set.emplace_back(2.0f * signed_number(), 2.0f * signed_number());
            scene.colors.emplace_back(uniform(random), uniform(random), uniform(random), uniform(random));
        }
        if (!tangents) continue;
        // One normal and one tangent across it a triangle, which interpolation leaves as they are.
        const glm::vec3 n = scene.normals.back();
        std::fill(scene.normals.end() - 3, scene.normals.end(), n);
        const glm::vec3 t = glm::normalize(glm::cross(n, glm::vec3(signed_number(), signed_number(), signed_number())));
        const float sign = i % 2 ? -1.0f : 1.0f;
        for (int c = 0; c < 3; ++c) scene.tangents.emplace_back(t, i % 5 == 0 ? 0.0f : sign);
    }
    return scene;
}

TEST_F(Textures, SurfacesAreTheReferences) {
    for (const bool tangents : {false, true}) {
        SCOPED_TRACE(tangents ? "tangents of the file" : "tangents of the texture coordinates");
        std::mt19937 random(32);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const Scene scene = textured_sheet(random, tangents);
        const FlatScene flat = flatten(scene);
        std::vector<gpu::TextureInput> inputs;
        for (int i = 0; i < 20000; ++i) {
            gpu::TextureInput input{};
            input.triangle = std::uint32_t(random() % scene.triangles.size());
            const double s = std::sqrt(uniform(random)), t = uniform(random);
            input.barycentric = glm::vec2(s * (1.0 - t), s * t);
            input.direction = glm::vec3(
                glm::normalize(glm::dvec3(uniform(random) - 0.5, uniform(random) - 0.5, i % 2 == 0 ? -1.0 : 1.0)));
            inputs.push_back(input);
        }
        const auto outputs = run(flat, inputs, true);
        std::size_t normals = 0, mirrored = 0, backs = 0, missing = 0, partial = 0;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const auto& in = inputs[i];
            const auto& out = outputs[i];
            const std::uint32_t source = flat.bvh.order[in.triangle];
            const double b = in.barycentric.x, c = in.barycentric.y;
            const oracle::Hit hit{0.0, {1.0 - b - c, b, c}, source};
            const Material& material = scene.materials[scene.triangles[source].material];
            // On the edge of a texel, rounding of the coordinates decides.
            bool edge = false;
            for (const auto* texture :
                 {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                  &material.emissive_texture, &material.transmission_texture, &material.specular_texture,
                  &material.specular_color_texture, &material.clearcoat_texture, &material.clearcoat_roughness_texture,
                  &material.clearcoat_normal_texture, &material.anisotropy_texture, &material.iridescence_texture,
                  &material.iridescence_thickness_texture, &material.sheen_color_texture,
                  &material.sheen_roughness_texture}) {
                const Extent size = scene.images[(*texture)->image].size;
                const glm::dvec2 uv = glm::dmat2((*texture)->matrix) * oracle::uv_at(scene, hit, (*texture)->uv_set);
                const glm::dvec2 place = uv * glm::dvec2(size.width, size.height);
                const glm::dvec2 gap = glm::abs(place - glm::round(place));
                edge = edge || ((*texture)->nearest && std::min(gap.x, gap.y) < 1e-5);
            }
            if (edge) continue;
            const oracle::Surface want = oracle::surface_at(scene, hit, glm::dvec3(in.direction));
            const std::string line = fmt::format("triangle {} of material {}, barycentrics ({}, {}), {}", source,
                                                 scene.triangles[source].material, b, c, want.front ? "front" : "back");
            // Vertex colours are half floats: 11 bits.
            const auto expect = [&](const char* name, double got, double wanted, double tolerance) {
                EXPECT_NEAR(got, wanted, tolerance) << line << ": " << name;
            };
            for (int k = 0; k < 3; ++k) {
                expect("base colour", out.value[k], want.base_color[k], 5e-4);
                expect("sheen colour", out.sheen[k], want.bsdf.sheen_color[k], 1e-5);
                expect("specular colour", out.specular_color[k], want.bsdf.specular_color[k], 1e-5);
            }
            expect("metallic", out.metal[0], want.bsdf.metallic, 1e-5);
            expect("alpha", out.metal[1] * out.metal[1], want.bsdf.alpha, 1e-5);
            expect("transmission", out.metal[2], want.bsdf.transmission, 1e-5);
            expect("specular", out.metal[3], want.bsdf.specular, 1e-5);
            expect("clearcoat", out.clearcoat[0], want.bsdf.coat, 1e-5);
            expect("film", out.film[0], want.bsdf.film, 1e-5);
            expect("thickness of the film", 1e3 * out.film[1], want.bsdf.film_thickness, 1e-2);
            expect("sheen alpha", out.sheen[3] * out.sheen[3], want.bsdf.sheen_alpha, 1e-5);
            expect("anisotropy", out.anisotropy, want.bsdf.anisotropy, 1e-5);
            expect("clearcoat alpha", out.clearcoat[1] * out.clearcoat[1], want.bsdf.coat_alpha, 1e-5);
            const double coverage = oracle::coverage(scene, hit);
            if (material.alpha != Material::Alpha::mask || std::abs(out.value.a - material.alpha_cutoff) > 1e-3) {
                expect("coverage", out.coverage, coverage, 5e-4);
                missing += coverage == 0.0 ? 1 : 0;
                partial += coverage > 0.0 && coverage < 1.0 ? 1 : 0;
            }
            // A normal that a ray would see from behind is replaced: Surface.LiesOnItsPlane... has the rule.
            const glm::dvec3 d(in.direction);
            const auto& v = scene.triangles[source].vertex;
            // Where the derivative by u cancels, its direction is rounding.
            const auto sense = [&](const Texture& texture, double& condition) {
                const auto& uv = scene.uv[texture.uv_set];
                const glm::dvec2 d1 = texture.matrix * (uv[v[1]] - uv[v[0]]),
                                 d2 = texture.matrix * (uv[v[2]] - uv[v[0]]);
                const glm::dvec3 e1 = scene.positions[v[1]] - scene.positions[v[0]];
                const glm::dvec3 e2 = scene.positions[v[2]] - scene.positions[v[0]];
                const double whole = glm::length(e1) * std::abs(d2.y) + glm::length(e2) * std::abs(d1.y);
                condition = std::max(condition, whole / glm::length(e1 * d2.y - e2 * d1.y));
                return d1.x * d2.y - d1.y * d2.x;
            };
            double condition = 1.0;
            sense(*material.clearcoat_normal_texture, condition);
            const double determinant = sense(*material.normal_texture, condition);
            const double rounding = 3e-4 + 2e-6 * condition;  // packed normals and tangents; the derivative
            const glm::dvec3 vertex_normal = (1.0 - b - c) * glm::dvec3(scene.normals[v[0]]) +
                                             b * glm::dvec3(scene.normals[v[1]]) + c * glm::dvec3(scene.normals[v[2]]);
            const bool seen = glm::dot(want.front ? vertex_normal : -vertex_normal, d) < -0.05;
            if (seen && glm::dot(want.bsdf.normal, d) < -0.05 && glm::dot(want.bsdf.coat_normal, d) < -0.05) {
                const auto expect_normal = [&](const char* name, const glm::vec3& got, const glm::dvec3& wanted) {
                    EXPECT_LT(glm::distance(glm::dvec3(got), wanted), rounding)
                        << line << ": " << name
                        << fmt::format(" ({:.6f}, {:.6f}, {:.6f}), wanted ({:.6f}, {:.6f}, {:.6f})", got.x, got.y,
                                       got.z, wanted.x, wanted.y, wanted.z)
                        << ", condition " << condition;
                };
                expect_normal("normal", out.normal, want.bsdf.normal);
                expect_normal("normal of the clearcoat", out.clearcoat_normal, want.bsdf.coat_normal);
                expect_normal("tangent", out.tangent, want.bsdf.tangent);
                // What the rounding of the coat's normal makes of its Fresnel term, by Schlick.
                const double steepness = 4.8 * want.bsdf.coat * std::pow(1.0 + glm::dot(want.bsdf.coat_normal, d), 4.0);
                for (int k = 0; k < 3 && (want.front || material.double_sided); ++k)
                    expect("emission", out.emission[k], want.emission[k], 3e-5 + steepness * rounding);
                ++normals;
                mirrored += determinant > 0.0 ? 1 : 0;
                backs += want.front ? 0 : 1;
            }
            if (HasFailure()) return;
        }
        EXPECT_GT(normals, 5000u);
        EXPECT_GT(mirrored, 2000u);
        EXPECT_GT(backs, 2000u);
        EXPECT_GT(missing, 500u);
        EXPECT_GT(partial, 2000u);
    }
}

TEST_F(Textures, ANormalMapBendsTowardsTheTopOfItsImage) {
    // Unit square that faces +z, the picture upright on it (u to the right, v down), or mirrored left to right, or
    // upside down. Green above one half bends up as the picture has it, red to the right of it.
    struct View {
        const char* name;
        glm::vec3 right, up;  // of the picture, in space
    };
    for (const View& view : {View{"upright", {1, 0, 0}, {0, 1, 0}}, View{"mirrored", {-1, 0, 0}, {0, 1, 0}},
                             View{"upside down", {1, 0, 0}, {0, -1, 0}}, View{"turned", {0, 1, 0}, {-1, 0, 0}}}) {
        for (const bool back : {false, true}) {
            SCOPED_TRACE(fmt::format("{}, {}", view.name, back ? "back" : "front"));
            Scene scene;
            Material material;
            material.metallic = 0.0f;
            material.normal_texture.emplace();
            material.normal_texture->image = add_plain_image(scene, {204, 230, 230, 255});  // (0.6, 0.804, 0.804)
            scene.materials.push_back(material);
            add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
            for (const glm::dvec3& p : scene.positions) {
                scene.uv[0].emplace_back(glm::dot(glm::vec3(p), view.right), -glm::dot(glm::vec3(p), view.up));
            }
            const FlatScene flat = flatten(scene);
            std::vector<gpu::TextureInput> inputs(2);
            for (std::uint32_t i = 0; i < 2; ++i) {
                inputs[i].triangle = i;
                inputs[i].barycentric = {0.3f, 0.3f};
                inputs[i].direction = {0.0f, 0.0f, back ? 1.0f : -1.0f};
            }
            const glm::dvec3 n =
                glm::normalize(0.6 * glm::dvec3(view.right) +
                               (2.0 * 230.0 / 255.0 - 1.0) * (glm::dvec3(view.up) + glm::dvec3(0, 0, 1)));
            for (const auto& out : run(flat, inputs, true)) {
                EXPECT_LT(glm::distance(glm::dvec3(out.normal), back ? -n : n), 1e-5) << fmt::format(
                    "({}, {}, {}), expected ({}, {}, {})", out.normal.x, out.normal.y, out.normal.z, n.x, n.y, n.z);
            }
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
