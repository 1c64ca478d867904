#include "scene/gltf/materials.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include "scene/gltf/limits.h"
#include "scene/gltf/specular_glossiness.h"
#include "scene/gltf/values.h"

namespace vkcppm {

namespace {

using nlohmann::json;
using Double3 = std::array<double, 3>;
using Double4 = std::array<double, 4>;

/// A member that is an object, or an empty one.
const json& object_or_empty(const json& parent, const char* name) {
    static const json empty = json::object();
    const auto found = parent.find(name);
    return found == parent.end() ? empty : *found;
}

glm::dvec3 vec3_or(const json& parent, const char* name, double otherwise) {
    return glm::make_vec3(parent.value(name, Double3{otherwise, otherwise, otherwise}).data());
}

Texture::Wrap wrap_of(const json& sampler, const char* member) {
    switch (sampler.value(member, std::int64_t(10497))) {
        case 33071: return Texture::Wrap::clamp_to_edge;
        case 33648: return Texture::Wrap::mirrored_repeat;
        default: return Texture::Wrap::repeat;
    }
}

/// Exporters write numbers that glTF does not have, such as -1 for none.
void check_sampler(const json& sampler, const std::string& object, Warnings& warnings) {
    static const std::map<std::string, std::vector<std::int64_t>> known = {
        {"magFilter", {9728, 9729}},
        {"minFilter", {9728, 9729, 9984, 9985, 9986, 9987}},
        {"wrapS", {10497, 33071, 33648}},
        {"wrapT", {10497, 33071, 33648}},
    };
    for (const auto& [member, values] : known) {
        if (!sampler.contains(member)) continue;
        const auto value = sampler[member].get<std::int64_t>();
        if (std::ranges::find(values, value) != values.end()) continue;
        warnings.add("glTF has no such number, linear filters and repetition are taken",
                     fmt::format("{}.{} = {}", object, member, value));
    }
}

/// There are no mipmaps: the magnification filter decides, and the minification filter where it is not stated.
bool is_nearest(const json& sampler) {
    constexpr int nearest = 9728, linear = 9729, nearest_mipmap_nearest = 9984, nearest_mipmap_linear = 9986;
    if (sampler.contains("magFilter")) return sampler["magFilter"] == nearest;
    const auto minification = sampler.value("minFilter", std::int64_t(linear));
    return minification == nearest || minification == nearest_mipmap_nearest || minification == nearest_mipmap_linear;
}

class MaterialReader {
public:
    MaterialReader(const GltfFile& file, std::size_t index, GltfImages& images, Warnings& warnings)
        : file_(file),
          source_(file.document["materials"][index]),
          name_(fmt::format("materials[{}]", index)),
          images_(images),
          warnings_(warnings) {}

    Material factors() const {
        const json& pbr = object_or_empty(source_, "pbrMetallicRoughness");
        const auto base_color = pbr.value("baseColorFactor", Double4{1.0, 1.0, 1.0, 1.0});

        Material material;
        material.name = source_.value("name", "");
        material.base_color = color(glm::make_vec3(base_color.data()), 1.0, "baseColorFactor");
        material.opacity = number(base_color[3], 0.0, 1.0, "baseColorFactor");
        const std::string alpha = source_.value("alphaMode", "OPAQUE");
        material.alpha = alpha == "MASK"    ? Material::Alpha::mask
                         : alpha == "BLEND" ? Material::Alpha::blend
                                            : Material::Alpha::opaque;
        material.alpha_cutoff = factor(source_, "alphaCutoff", 0.5, 0.0, FLT_MAX);
        material.double_sided = source_.value("doubleSided", false);
        material.unlit = object_or_empty(source_, "extensions").contains("KHR_materials_unlit");
        if (material.unlit) return material;  // nothing but the base colour means anything there

        material.metallic = factor(pbr, "metallicFactor", 1.0, 0.0, 1.0);
        material.roughness = factor(pbr, "roughnessFactor", 1.0, 0.0, 1.0);
        const double strength = extension("KHR_materials_emissive_strength").value("emissiveStrength", 1.0);
        material.emission = emitted(vec3_or(source_, "emissiveFactor", 0.0), strength, member("emissiveFactor"),
                                    member("emissiveStrength"), file_.name, warnings_);
        const json& volume = extension("KHR_materials_volume");
        if (volume.contains("attenuationDistance")) {
            material.attenuation_distance = factor(volume, "attenuationDistance", 0.0, FLT_MIN, FLT_MAX);
        }
        const double ior = extension("KHR_materials_ior").value("ior", 1.5);
        material.ior = ior == 0.0 ? 0.0f : number(ior, 1.0, FLT_MAX, "ior");  // 0 stands for infinity
        // clang-format off
#define EXTENSION(name, ...) { [[maybe_unused]] const json& of = extension(#name); __VA_ARGS__ }
#define FACTOR(member, json, standard, low, high) material.member = factor(of, json, standard, low, high);
#define COLOR(member, json, standard, high) material.member = color(vec3_or(of, json, standard), high, json);
#include "scene/material_extensions.h"
        // clang-format on
        return material;
    }

    /// The textures of a material with these factors. Not read: occlusion, which paths find out for themselves, and
    /// thickness, since a volume is as thick as its mesh.
    void add_textures(Material& material) {
        const json& pbr = object_or_empty(source_, "pbrMetallicRoughness");
        material.base_color_texture = texture(pbr, "baseColorTexture");
        if (material.unlit) return;

        if (material.metallic > 0.0f || material.roughness > 0.0f) {
            const std::optional<double> glossiness = glossiness_factor(source_);
            material.metallic_roughness_texture = texture(pbr, "metallicRoughnessTexture", glossiness);
            if (glossiness && !material.metallic_roughness_texture) {
                material.roughness *= number(1.0 - *glossiness, 0.0, 1.0, "roughnessFactor");
            }
        }
        material.normal_texture = normal_texture(source_, "normalTexture", material.normal_scale);
        if (material.emission != glm::vec3(0.0f)) material.emissive_texture = texture(source_, "emissiveTexture");
        const Material& m = material;
        // clang-format off
#define EXTENSION(name, ...) { [[maybe_unused]] const json& of = extension(#name); __VA_ARGS__ }
#define TEXTURE(NUMBER, member, json, words, encoding, where) if (where) material.member = texture(of, json);
#define NORMALS(NUMBER, member, json, words, scale, where) \
    if (where) material.member = normal_texture(of, json, material.scale);
#include "scene/material_extensions.h"
        // clang-format on
    }

private:
    std::string member(const char* name) const { return fmt::format("{}.{}", name_, name); }

    const json& extension(const char* name) const {
        return object_or_empty(object_or_empty(source_, "extensions"), name);
    }

    float number(double value, double low, double high, const char* name) const {
        return float(clamped(value, low, high, member(name), warnings_));
    }

    float factor(const json& parent, const char* name, double otherwise, double low, double high) const {
        return number(parent.value(name, otherwise), low, high, name);
    }

    glm::vec3 color(const glm::dvec3& value, double high, const char* name) const {
        return clamped(value, 0.0, high, member(name), warnings_);
    }

    /// A texture of `parent` by its member's name; none where it has none, or, with a warning, no image for it.
    /// glossiness: see GltfImages::index.
    std::optional<Texture> texture(const json& parent, const char* name, std::optional<double> glossiness = {}) {
        const auto found = parent.find(name);
        if (found == parent.end()) return std::nullopt;
        const json& info = *found;
        const json& transform = object_or_empty(object_or_empty(info, "extensions"), "KHR_texture_transform");
        const int uv_set = transform.value("texCoord", info.value("texCoord", 0));
        if (uv_set > 1) {
            warnings_.add("the texture is ignored, this program reads TEXCOORD_0 and TEXCOORD_1",
                          fmt::format("{}.texCoord = {}", member(name), uv_set));
            return std::nullopt;
        }
        const auto index = info["index"].get<std::size_t>();
        const json& source = file_.document["textures"][index];
        const json& webp = object_or_empty(object_or_empty(source, "extensions"), "EXT_texture_webp");
        const json& named = webp.contains("source") ? webp : source;
        if (!named.contains("source")) {
            warnings_.add("the texture is ignored, it has no PNG, JPEG or WebP as its source: export one of them",
                          fmt::format("textures[{}] ({})", index, member(name)));
            return std::nullopt;
        }
        const std::optional<std::uint32_t> image =
            &named == &webp ? image_of_webp(source, webp, glossiness) : images_.index(image_number(source), glossiness);
        if (!image) return std::nullopt;

        Texture texture;
        texture.image = *image;
        texture.uv_set = std::uint32_t(uv_set);
        if (source.contains("sampler")) {
            const auto number = source["sampler"].get<std::size_t>();
            const json& sampler = file_.document["samplers"][number];
            check_sampler(sampler, fmt::format("samplers[{}]", number), warnings_);
            texture.wrap_s = wrap_of(sampler, "wrapS");
            texture.wrap_t = wrap_of(sampler, "wrapT");
            texture.nearest = is_nearest(sampler);
        }
        set_transform(texture, transform, member(name));
        return texture;
    }

    static std::size_t image_number(const json& source) { return source["source"].get<std::size_t>(); }

    /// The image of a texture that EXT_texture_webp names; where it is not there, or cannot be read, the one beside it,
    /// if any.
    std::optional<std::uint32_t> image_of_webp(const json& source, const json& webp, std::optional<double> glossiness) {
        const std::optional<std::uint32_t> image = images_.index(image_number(webp), glossiness);
        if (!source.contains("source")) return image;
        if (!image) return images_.index(image_number(source), glossiness);
        images_.set_beside(*image, image_number(source));
        return image;
    }

    /// KHR_texture_transform: scaled, then turned, then moved. A positive angle turns the coordinates counter-clockwise
    /// as seen with v downwards, (1, 0) towards (0, -1): the extension's own example takes the lower left quarter.
    void set_transform(Texture& texture, const json& transform, const std::string& object) const {
        const auto offset = transform.value("offset", std::array<double, 2>{0.0, 0.0});
        const auto scale = transform.value("scale", std::array<double, 2>{1.0, 1.0});
        for (const double value : {offset[0], offset[1], scale[0], scale[1]}) {
            if (std::abs(value) <= max_uv) continue;
            bad_scene(file_.name, object + ".extensions.KHR_texture_transform", fmt::to_string(value),
                      fmt::format("the limit of offset and scale is {}", max_uv));
        }
        const double angle = transform.value("rotation", 0.0);
        const double c = std::cos(angle), s = std::sin(angle);
        texture.matrix = glm::mat2(c * scale[0], -s * scale[0], s * scale[1], c * scale[1]);  // columns
        texture.offset = {float(offset[0]), float(offset[1])};
    }

    std::optional<Texture> normal_texture(const json& parent, const char* name, float& scale) {
        std::optional<Texture> normals = texture(parent, name);
        if (normals) scale = factor(parent[name], "scale", 1.0, -max_uv, max_uv);
        return normals;
    }

    const GltfFile& file_;
    const json& source_;
    const std::string name_;
    GltfImages& images_;
    Warnings& warnings_;
};

}  // namespace

std::vector<Material> read_materials(const GltfFile& file, const std::vector<bool>& is_used, GltfImages& images,
                                     Warnings& warnings) {
    std::vector<Material> materials;
    for (std::size_t i = 0; i < is_used.size(); ++i) {
        if (file.document["materials"][i].value("extensions", json::object()).contains(specular_glossiness_extension)) {
            warnings.add("rendered as a dielectric of that specular colour, by KHR_materials_specular",
                         fmt::format("materials[{}].{}", i, specular_glossiness_extension));
        }
        MaterialReader reader(file, i, images, warnings);
        materials.push_back(reader.factors());
        if (is_used[i]) reader.add_textures(materials.back());
    }
    return materials;
}

namespace {

/// Calls visit(texture) of every texture that a material may have.
template <typename AMaterial, typename Visit> void for_textures(AMaterial& material, const Visit& visit) {
    for (auto* texture : {
             &material.base_color_texture,
             &material.metallic_roughness_texture,
             &material.normal_texture,
             &material.emissive_texture,
#define EXTENSION(name, ...) __VA_ARGS__
#define TEXTURE(NUMBER, member, json, words, encoding, where) &material.member,
#define NORMALS(NUMBER, member, json, words, scale, where) &material.member,
#include "scene/material_extensions.h"
         }) {
        if (*texture) visit(*texture);
    }
}

}  // namespace

void place_images(std::vector<Material>& materials, const std::vector<std::optional<std::uint32_t>>& at) {
    for (Material& material : materials) {
        for_textures(material, [&](std::optional<Texture>& texture) {
            if (const auto image = at[texture->image]) {
                texture->image = *image;
            } else {
                texture.reset();
            }
        });
    }
}

VertexNeeds vertex_needs(const Material& material) {
    VertexNeeds needs;
    for_textures(material, [&](const std::optional<Texture>& texture) { needs.uv[texture->uv_set] = true; });
    const bool anisotropic = material.anisotropy > 0.0f;
    needs.tangents = material.normal_texture || material.clearcoat_normal_texture || anisotropic;
    // Which coordinates tangents follow from set_tangent of include/surface.glsl knows.
    needs.frame = anisotropic && !material.normal_texture && !material.anisotropy_texture;
    return needs;
}

}  // namespace vkcppm
