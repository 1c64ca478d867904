#include "flat/surface.h"

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
    return m.metallic == 1.0f && m.base_color == black && !m.metallic_roughness_texture;
}

struct NamedTexture {
    const char* name;
    const std::optional<Texture>* texture;
    bool srgb;
};

/// In the order of TEXTURE_*.
std::array<NamedTexture, TEXTURE_COUNT> textures_of(const Material& m) {
    return {{{"base colour", &m.base_color_texture, true},
             {"metallic-roughness", &m.metallic_roughness_texture, false},
             {"normal", &m.normal_texture, false},
             {"emissive", &m.emissive_texture, true},
             {"transmission", &m.transmission_texture, false},
             {"specular", &m.specular_texture, false},
             {"specular colour", &m.specular_color_texture, true},
             {"clearcoat", &m.clearcoat_texture, false},
             {"clearcoat roughness", &m.clearcoat_roughness_texture, false},
             {"clearcoat normal", &m.clearcoat_normal_texture, false}}};
}

}  // namespace

SurfaceTraits traits_of(const Material& m, float least_alpha) {
    SurfaceTraits t;
    t.unlit = m.unlit;
    t.alpha = is_partly_there(m, least_alpha);
    t.emits = m.emission != black;
    const auto textures = textures_of(m);
    t.textured =
        std::any_of(textures.begin(), textures.end(), [](const NamedTexture& n) { return n.texture->has_value(); });
    if (m.unlit) return t;
    const bool dielectric = m.metallic < 1.0f || m.metallic_roughness_texture;
    const bool opaque = m.transmission < 1.0f || m.transmission_texture;
    t.metal = m.metallic > 0.0f && !is_black_metal(m);
    t.diffuse = dielectric && opaque && m.base_color != black;
    t.coat = dielectric && opaque && m.specular > 0.0f;
    t.glass = is_glass(m);
    t.thin = t.glass && !is_solid_glass(m);
    t.absorbs = t.glass && !t.thin && std::isfinite(m.attenuation_distance) && m.attenuation_color != white;
    t.disperses = t.glass && !t.thin && m.dispersion > 0.0f && m.ior > 1.0f;
    t.rough = m.roughness > 0.0f;
    t.clearcoat = m.clearcoat > 0.0f;
    t.rough_clearcoat = t.clearcoat && m.clearcoat_roughness > 0.0f;
    const bool reaches_zero = m.roughness == 0.0f || m.metallic_roughness_texture;
    t.smooth = ((t.metal || t.coat || t.glass) && reaches_zero) || (t.glass && m.ior == 1.0f) ||
               (t.clearcoat && (m.clearcoat_roughness == 0.0f || m.clearcoat_roughness_texture));
    t.normal_map = m.normal_texture || (t.clearcoat && m.clearcoat_normal_texture);
    return t;
}

std::vector<SurfaceTraits> traits_of(const Scene& scene) {
    const std::vector<float> alphas = least_alphas(scene);
    std::vector<SurfaceTraits> traits;
    for (std::size_t i = 0; i < alphas.size(); ++i) traits.push_back(traits_of(scene.materials[i], alphas[i]));
    return traits;
}

gpu::SurfaceMaterial surface_of(const Material& m, const SurfaceTraits& traits, double scale, TextureTable& table) {
    gpu::SurfaceMaterial surface{};
    surface.color = m.base_color;
    surface.emission = m.emission;
    surface.ior = m.ior == 0.0f ? infinite_ior : m.ior;
    surface.metallic = is_black_metal(m) ? 0.0f : m.metallic;
    surface.roughness = m.roughness;
    surface.transmission = is_black_metal(m) ? 0.0f : m.transmission;
    surface.specular = is_black_metal(m) ? 0.0f : m.specular;
    surface.specular_color = m.specular_color;
    surface.opacity = m.opacity;
    if (traits.absorbs) {
        const glm::dvec3 color = glm::max(glm::dvec3(m.attenuation_color), glm::dvec3(1e-30));  // black is very dark
        surface.absorption = glm::vec3(-glm::log(color) / (double(m.attenuation_distance) * scale));
    }
    if (traits.disperses) {
        // Abbe number V = (n_d - 1) / (n_F - n_C), lines d, F, C of the spectrum; micrometres.
        const double abbe = 20.0 / double(m.dispersion);
        surface.cauchy = float((double(m.ior) - 1.0) / (abbe * (1.0 / (0.4861 * 0.4861) - 1.0 / (0.6563 * 0.6563))));
    }
    surface.clearcoat = m.clearcoat;
    surface.clearcoat_roughness = m.clearcoat_roughness;
    surface.alpha_cutoff = m.alpha_cutoff;
    surface.normal_scale = m.normal_scale;
    surface.clearcoat_normal_scale = m.clearcoat_normal_scale;
    const auto textures = textures_of(m);
    for (std::size_t i = 0; i < textures.size(); ++i)
        surface.texture[i] = table.add(*textures[i].texture, textures[i].srgb);
    if (m.double_sided) surface.flags |= SURFACE_DOUBLE_SIDED;
    if (traits.thin) surface.flags |= SURFACE_THIN;
    if (traits.alpha) surface.flags |= m.alpha == Material::Alpha::mask ? SURFACE_MASK : SURFACE_BLEND;
    if (traits.unlit) surface.flags |= SURFACE_UNLIT;
    if (traits.textured) surface.flags |= SURFACE_TEXTURED;
    return surface;
}

std::string describe_material(const Material& m, const SurfaceTraits& t) {
    std::vector<std::string> parts;
    const auto roughness = [](float r) { return r > 0.0f ? fmt::format("roughness {:g}", r) : std::string("smooth"); };
    if (t.unlit) parts.push_back(fmt::format("unlit, seen as {}", text(m.base_color)));
    if (t.diffuse)
        parts.push_back(fmt::format("diffuse {}",
                                    text(m.base_color * (1.0f - (m.metallic_roughness_texture ? 0.0f : m.metallic)))));
    if (t.metal)
        parts.push_back(fmt::format("metal {}{}, {}", m.metallic < 1.0f ? fmt::format("{:g} of ", m.metallic) : "",
                                    text(m.base_color), roughness(m.roughness)));
    if (t.coat)
        parts.push_back(fmt::format("coat of ior {:g}{}, {}", m.ior,
                                    m.specular < 1.0f ? fmt::format(", weight {:g}", m.specular) : "",
                                    roughness(m.roughness)));
    if (t.glass) {
        std::string glass = fmt::format("{} of ior {:g}, tint {}, {}", t.thin ? "thin-walled glass" : "solid glass",
                                        m.ior, text(m.base_color), roughness(m.roughness));
        if (m.transmission < 1.0f) glass += fmt::format(", {:g} of the surface", m.transmission);
        if (t.absorbs) glass += fmt::format(", {} after {:g} m", text(m.attenuation_color), m.attenuation_distance);
        if (t.disperses) glass += fmt::format(", Abbe number {:g}", 20.0f / m.dispersion);
        parts.push_back(glass);
    }
    if (t.clearcoat) parts.push_back(fmt::format("clearcoat {:g}, {}", m.clearcoat, roughness(m.clearcoat_roughness)));
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
