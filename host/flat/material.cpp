#include "flat/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/diagnosis/alpha.h"
#include "scene/diagnosis/glass.h"

namespace vkcppm {
namespace {

constexpr float infinite_ior = 1e8f;

const glm::vec3 black(0.0f), white(1.0f);

std::string text(const glm::vec3& v) {
    return v.x == v.y && v.y == v.z ? fmt::format("{:g}", v.x) : fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z);
}

/// A metal that is black all over: what exporters leave under a lamp. Schlick's white edge would have rays trace it,
/// and every photon weighed, for nothing that anybody means: it takes all light in.
bool is_black_metal(const Material& m) {
    return m.metallic == 1.0f && m.base_color == black && !m.metallic_roughness_texture && m.iridescence == 0.0f;
}

/// Light gets below its surface, somewhere, and is not let through.
bool has_base(const Material& m) {
    return (m.metallic < 1.0f || m.metallic_roughness_texture) && (m.transmission < 1.0f || m.transmission_texture);
}

bool has_metal(const Material& m) { return m.metallic > 0.0f && !is_black_metal(m); }

bool has_coat(const Material& m) { return has_base(m) && m.specular > 0.0f; }

/// A lobe of facets, of that roughness.
LobeTraits of_facets(float roughness, const std::optional<Texture>& texture) {
    return {.smooth = roughness == 0.0f || texture, .rough = roughness > 0.0f};
}

/// The facets of reflection and transmission. Smooth ones are stretched to rough ones where there is a tangent.
LobeTraits base_facets(const Material& m) {
    LobeTraits lobe = of_facets(m.roughness, m.metallic_roughness_texture);
    lobe.rough = lobe.rough || m.anisotropy > 0.0f;
    return lobe;
}

/// How the material, which is not unlit, has the lobe: one function a row of LOBES, a row without one does not link.
template <Lobe lobe> LobeTraits lobe_of(const Material& m);

template <> LobeTraits lobe_of<Lobe::diffuse>(const Material& m) {
    return {.wide = has_base(m) && m.base_color != black};
}

template <> LobeTraits lobe_of<Lobe::reflection>(const Material& m) {
    if (!has_metal(m) && !has_coat(m) && !is_glass(m)) return {};
    return base_facets(m);
}

template <> LobeTraits lobe_of<Lobe::transmission>(const Material& m) {
    if (!is_glass(m)) return {};
    LobeTraits lobe = base_facets(m);
    lobe.smooth = lobe.smooth || m.ior == 1.0f;  // no facet bends it
    return lobe;
}

template <> LobeTraits lobe_of<Lobe::clearcoat>(const Material& m) {
    if (!(m.clearcoat > 0.0f)) return {};
    return of_facets(m.clearcoat_roughness, m.clearcoat_roughness_texture);
}

template <> LobeTraits lobe_of<Lobe::sheen>(const Material& m) { return {.wide = m.sheen_color != black}; }

enum class Encoding { linear, srgb };

struct NamedTexture {
    const char* name;
    const std::optional<Texture>* texture;
    Encoding encoding;
};

/// [TEXTURE_*]
std::array<NamedTexture, TEXTURE_COUNT> textures_of(const Material& m) {
    std::array<NamedTexture, TEXTURE_COUNT> textures;
    textures[TEXTURE_BASE_COLOR] = {"base colour", &m.base_color_texture, Encoding::srgb};
    textures[TEXTURE_METALLIC_ROUGHNESS] = {"metallic-roughness", &m.metallic_roughness_texture, Encoding::linear};
    textures[TEXTURE_NORMAL] = {"normal", &m.normal_texture, Encoding::linear};
    textures[TEXTURE_EMISSIVE] = {"emissive", &m.emissive_texture, Encoding::srgb};
#define EXTENSION(name, ...) __VA_ARGS__
#define TEXTURE(NUMBER, member, json, words, encoding, where) \
    textures[TEXTURE_##NUMBER] = {words, &m.member, Encoding::encoding};
#define NORMALS(NUMBER, member, json, words, scale, where) TEXTURE(NUMBER, member, json, words, linear, where)
#include "scene/material_extensions.h"
    return textures;
}

#define EXTENSION(name, ...) __VA_ARGS__
#define TEXTURE(NUMBER, member, json, words, encoding, where) +1
#define NORMALS(NUMBER, member, json, words, scale, where) +1
constexpr int textures_of_extensions = 0
#include "scene/material_extensions.h"
    ;
static_assert(TEXTURE_EMISSIVE + 1 + textures_of_extensions == TEXTURE_COUNT, "each number has its texture");

}  // namespace

bool MaterialTraits::glossy() const {
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        if (Lobe(i) == Lobe::diffuse) continue;
        // Another lobe that gathers, or one that takes from the diffuse lobe by the direction.
        if (lobes[i].rough || lobes[i].wide || (lobes[i].there() && has(Lobe::diffuse))) return true;
    }
    return false;
}

MaterialTraits traits_of(const Material& m, float least_alpha) {
    MaterialTraits t;
    t.unlit = m.unlit;
    t.alpha = is_partly_there(m, least_alpha);
    t.culled = !m.double_sided && !is_glass(m);
    t.emits = m.emission != black;
    const auto textures = textures_of(m);
    t.textured =
        std::any_of(textures.begin(), textures.end(), [](const NamedTexture& n) { return n.texture->has_value(); });
    if (m.unlit) return t;
#define LOOK_FOR_LOBE(number, NAME, name, present) t.lobes[number] = lobe_of<Lobe::name>(m);
    LOBES(LOOK_FOR_LOBE)
#undef LOOK_FOR_LOBE
    t.metal = has_metal(m);
    t.coat = has_coat(m);
    t.thin = is_glass(m) && !is_solid_glass(m);
    t.absorbs = is_solid_glass(m) && std::isfinite(m.attenuation_distance) && m.attenuation_color != white;
    t.specular_glass = is_glass(m) && (m.specular != 1.0f || m.specular_color != white || m.specular_texture ||
                                       m.specular_color_texture);
    t.disperses = is_solid_glass(m) && m.dispersion > 0.0f && m.ior > 1.0f;
    t.anisotropic = m.anisotropy > 0.0f && t.has(Lobe::reflection);
    t.iridescent = m.iridescence > 0.0f && t.has(Lobe::reflection);
    t.normal_map = m.normal_texture || (t.has(Lobe::clearcoat) && m.clearcoat_normal_texture);
    return t;
}

std::vector<MaterialTraits> traits_of(const Scene& scene) {
    const std::vector<float> alphas = least_alphas(scene);
    std::vector<MaterialTraits> traits;
    for (std::size_t i = 0; i < alphas.size(); ++i) traits.push_back(traits_of(scene.materials[i], alphas[i]));
    return traits;
}

gpu::SurfaceMaterial gpu_material(const Material& m, const MaterialTraits& traits, double scale, TextureTable& table) {
    gpu::SurfaceMaterial read{};
    read.color = m.base_color;
    read.emission = m.emission;
    read.ior = m.ior == 0.0f ? infinite_ior : m.ior;
    read.metallic = is_black_metal(m) ? 0.0f : m.metallic;
    read.roughness = m.roughness;
    read.transmission = is_black_metal(m) ? 0.0f : m.transmission;
    read.specular = is_black_metal(m) ? 0.0f : m.specular;
    read.specular_color = m.specular_color;
    read.opacity = m.opacity;
    if (traits.absorbs) {
        for (int channel = 0; channel < 3; ++channel) {
            // Of what is 0 after any distance nothing is left after the least; not infinite, for the distance may be 0.
            constexpr double most = 1e30;
            const double color = m.attenuation_color[channel];
            const double distance = double(m.attenuation_distance) * scale;
            read.absorption[channel] = float(color > 0.0 ? std::min(most, -std::log(color) / distance) : most);
        }
    }
    if (traits.disperses) {
        // Abbe number V = (n_d - 1) / (n_F - n_C), lines d, F, C of the spectrum; micrometres.
        const double abbe = 20.0 / double(m.dispersion);
        read.cauchy = float((double(m.ior) - 1.0) / (abbe * (1.0 / (0.4861 * 0.4861) - 1.0 / (0.6563 * 0.6563))));
    }
    if (traits.anisotropic) {
        const double angle = m.anisotropy_rotation;
        read.anisotropy = {float(std::cos(angle)), float(std::sin(angle)), m.anisotropy};
    }
    if (traits.iridescent) {
        read.iridescence = m.iridescence;
        read.film_index = m.iridescence_ior;
        read.film_thickness = 1e-3f * glm::vec2(m.iridescence_thickness_minimum, m.iridescence_thickness_maximum);
    }
    read.sheen_color = m.sheen_color;
    read.sheen_roughness = m.sheen_roughness;
    read.clearcoat = m.clearcoat;
    read.clearcoat_roughness = m.clearcoat_roughness;
    read.alpha_cutoff = m.alpha_cutoff;
    read.normal_scale = m.normal_scale;
    read.clearcoat_normal_scale = m.clearcoat_normal_scale;
    const auto textures = textures_of(m);
    for (std::size_t i = 0; i < textures.size(); ++i)
        read.texture[i] = table.add(*textures[i].texture, textures[i].encoding == Encoding::srgb);
    if (m.double_sided) read.flags |= SURFACE_DOUBLE_SIDED;
    if (traits.thin) read.flags |= SURFACE_THIN;
    if (traits.alpha) read.flags |= m.alpha == Material::Alpha::mask ? SURFACE_MASK : SURFACE_BLEND;
    if (traits.unlit) read.flags |= SURFACE_UNLIT;
    if (traits.textured) read.flags |= SURFACE_TEXTURED;
    if (traits.culled) read.flags |= SURFACE_CULLED;
    return read;
}

std::string describe_material(const Material& m, const MaterialTraits& t) {
    std::vector<std::string> parts;
    const auto roughness = [](float r) { return r > 0.0f ? fmt::format("roughness {:g}", r) : std::string("smooth"); };
    if (t.unlit) parts.push_back(fmt::format("unlit, seen as {}", text(m.base_color)));
    if (t.has(Lobe::diffuse))
        parts.push_back(fmt::format("diffuse {}",
                                    text(m.base_color * (1.0f - (m.metallic_roughness_texture ? 0.0f : m.metallic)))));
    if (t.metal)
        parts.push_back(fmt::format("metal {}{}, {}", m.metallic < 1.0f ? fmt::format("{:g} of ", m.metallic) : "",
                                    text(m.base_color), roughness(m.roughness)));
    if (t.coat)
        parts.push_back(fmt::format("coat of ior {:g}{}, {}", m.ior,
                                    m.specular < 1.0f ? fmt::format(", weight {:g}", m.specular) : "",
                                    roughness(m.roughness)));
    if (t.has(Lobe::transmission)) {
        std::string glass = fmt::format("{} of ior {:g}, tint {}, {}", t.thin ? "thin-walled glass" : "solid glass",
                                        m.ior, text(m.base_color), roughness(m.roughness));
        if (m.specular < 1.0f) glass += fmt::format(", reflecting {:g} of Fresnel's share", m.specular);
        if (m.specular_color != white) glass += fmt::format(", in colour {}", text(m.specular_color));
        if (m.transmission < 1.0f) glass += fmt::format(", {:g} of the surface", m.transmission);
        if (t.absorbs) glass += fmt::format(", {} after {:g} m", text(m.attenuation_color), m.attenuation_distance);
        if (t.disperses) glass += fmt::format(", Abbe number {:g}", 20.0f / m.dispersion);
        parts.push_back(glass);
    }
    if (t.has(Lobe::clearcoat))
        parts.push_back(fmt::format("clearcoat {:g}, {}", m.clearcoat, roughness(m.clearcoat_roughness)));
    if (t.anisotropic) parts.push_back(fmt::format("facets wider along a tangent by strength {:g}", m.anisotropy));
    if (t.iridescent)
        parts.push_back(fmt::format("thin film {:g} of ior {:g}, {:g} nm", m.iridescence, m.iridescence_ior,
                                    m.iridescence_thickness_maximum));
    if (t.has(Lobe::sheen))
        parts.push_back(fmt::format("sheen {}, {}", text(m.sheen_color), roughness(m.sheen_roughness)));
    if (parts.empty()) parts.push_back("black");
    if (t.alpha)
        parts.push_back(m.alpha == Material::Alpha::mask ? fmt::format("there where alpha >= {:g}", m.alpha_cutoff)
                                                         : std::string("there with probability alpha"));
    std::vector<std::string> names;
    for (const NamedTexture& texture : textures_of(m)) {
        if (texture.texture->has_value()) names.push_back(texture.name);
    }
    if (!names.empty()) parts.push_back(fmt::format("textures: {}", fmt::join(names, ", ")));
    if (t.emits) {
        parts.push_back(fmt::format("emits {} W m^-2 sr^-1 from {}", text(m.emission),
                                    m.double_sided ? "both sides" : "its front"));
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace vkcppm
