#include "oracle/surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "oracle/texture.h"

namespace vkcppm::oracle {
namespace {

Scattering classify(const Bsdf& bsdf) {
    if (bsdf.coat == 0.0 && bsdf.film == 0.0 && bsdf.sheen_color == glm::dvec3(0.0)) {
        if (bsdf.transmission == 1.0 && !bsdf.thin && bsdf.metallic == 0.0 && bsdf.alpha == 0.0 &&
            bsdf.anisotropy == 0.0 && bsdf.base_color == glm::dvec3(1.0)) {
            return Scattering::glass;
        }
        if (bsdf.metallic == 1.0 && bsdf.alpha == 0.0 && bsdf.anisotropy == 0.0) return Scattering::mirror;
        if (bsdf.metallic == 0.0 && bsdf.specular == 0.0 && bsdf.transmission == 0.0) return Scattering::lambert;
    }
    return Scattering::mixed;
}

/// A vertex attribute at the hit, not normalised.
template <typename Wide, typename Value>
Wide interpolate(const std::vector<Value>& values, const Scene& scene, const Hit& hit) {
    const auto& v = scene.triangles[hit.triangle].vertex;
    return hit.barycentric.x * Wide(values[v[0]]) + hit.barycentric.y * Wide(values[v[1]]) +
           hit.barycentric.z * Wide(values[v[2]]);
}

glm::dvec4 vertex_color(const Scene& scene, const Hit& hit) {
    return scene.colors.empty() ? glm::dvec4(1.0) : interpolate<glm::dvec4>(scene.colors, scene, hit);
}

/// glTF's tangent space about the interpolated normal, as the front sees it: x along growing u, y along falling v, of
/// coordinates as KHR_texture_transform leaves them.
struct TangentSpace {
    glm::dvec3 tangent{0.0}, bitangent{0.0};  // unit; zero where the texture coordinates span no plane
};

/// texture: for which it is; none: of the first coordinates.
TangentSpace tangent_space(const Scene& scene, const Hit& hit, const glm::dvec3& normal,
                           const std::optional<Texture>& texture) {
    const auto& v = scene.triangles[hit.triangle].vertex;
    if (!scene.tangents.empty() && scene.tangents[v[0]].w != 0.0f) {
        const glm::dvec3 tangent = glm::normalize(glm::dvec3(interpolate<glm::dvec4>(scene.tangents, scene, hit)));
        return {tangent, glm::normalize(glm::cross(normal, tangent)) * double(scene.tangents[v[0]].w)};
    }
    const auto& uv = scene.uv[texture ? texture->uv_set : 0];
    const glm::dmat2 matrix(texture ? texture->matrix : glm::mat2(1.0f));
    if (uv.empty()) {
        return {};
    }
    const glm::dvec3 e1 = scene.positions[v[1]] - scene.positions[v[0]];
    const glm::dvec3 e2 = scene.positions[v[2]] - scene.positions[v[0]];
    const glm::dvec2 d1 = matrix * (glm::dvec2(uv[v[1]]) - glm::dvec2(uv[v[0]]));
    const glm::dvec2 d2 = matrix * (glm::dvec2(uv[v[2]]) - glm::dvec2(uv[v[0]]));
    const double determinant = d1.x * d2.y - d1.y * d2.x;
    const glm::dvec3 along_u = (e1 * d2.y - e2 * d1.y) * (determinant < 0.0 ? -1.0 : 1.0);
    const glm::dvec3 along_v = (e2 * d1.x - e1 * d2.x) * (determinant < 0.0 ? -1.0 : 1.0);
    const glm::dvec3 flat = along_u - glm::dot(along_u, normal) * normal;
    if (determinant == 0.0 || glm::length(flat) == 0.0) {
        return {};
    }
    const glm::dvec3 tangent = glm::normalize(flat), bitangent = glm::cross(normal, tangent);
    return {tangent, glm::dot(bitangent, along_v) > 0.0 ? -bitangent : bitangent};
}

/// normalize(T x scale + B y scale + N z) of a normal texture; `normal` where there is none.
glm::dvec3 mapped_normal(const Scene& scene, const Hit& hit, const glm::dvec3& normal,
                         const std::optional<Texture>& texture, double scale) {
    if (!texture) return normal;
    const TangentSpace space = tangent_space(scene, hit, normal, texture);
    const glm::dvec3 v = 2.0 * glm::dvec3(lookup(scene, hit, texture, Encoding::linear)) - 1.0;
    const glm::dvec3 sum = scale * v.x * space.tangent + scale * v.y * space.bitangent + v.z * normal;
    return glm::length(sum) > 0.0 ? glm::normalize(sum) : normal;
}

/// KHR_materials_anisotropy: strength, and the direction where facets are wider, about the normal as the front sees it.
/// Its tangent space is that of the normal texture, else of its own texture, else of the first coordinates; without one
/// there is no anisotropy.
void set_anisotropy(const Scene& scene, const Hit& hit, const glm::dvec3& normal, const Material& material,
                    Bsdf& bsdf) {
    if (material.anisotropy == 0.0f) return;
    const std::optional<Texture>& texture = material.anisotropy_texture;
    const TangentSpace space =
        tangent_space(scene, hit, normal, material.normal_texture ? material.normal_texture : texture);
    const glm::dvec3 tangent = space.tangent - glm::dot(space.tangent, normal) * normal;
    if (glm::length(tangent) == 0.0) return;
    glm::dvec3 direction(1.0, 0.0, 1.0);  // and strength
    if (texture) {
        const glm::dvec4 texel = lookup(scene, hit, texture, Encoding::linear);
        direction = {2.0 * texel.r - 1.0, 2.0 * texel.g - 1.0, texel.b};
    }
    const double angle = std::atan2(direction.y, direction.x) + double(material.anisotropy_rotation);
    const glm::dvec3 x = glm::normalize(tangent);
    const glm::dvec3 y = glm::cross(normal, x) * (glm::dot(glm::cross(normal, x), space.bitangent) < 0.0 ? -1.0 : 1.0);
    bsdf.anisotropy = material.anisotropy * direction.z;
    bsdf.tangent = std::cos(angle) * x + std::sin(angle) * y;
}

}  // namespace

Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction) {
    const Triangle& triangle = scene.triangles[hit.triangle];
    const auto& v = triangle.vertex;
    const Material& material = scene.materials[triangle.material];
    Surface surface;
    surface.position = interpolate<glm::dvec3>(scene.positions, scene, hit);
    surface.geometric_normal = glm::normalize(
        glm::cross(scene.positions[v[1]] - scene.positions[v[0]], scene.positions[v[2]] - scene.positions[v[0]]));
    surface.front = glm::dot(surface.geometric_normal, direction) < 0.0;
    if (!surface.front) surface.geometric_normal = -surface.geometric_normal;
    const glm::dvec3 vertex_normal = glm::normalize(interpolate<glm::dvec3>(scene.normals, scene, hit));
    const double side = glm::dot(vertex_normal, surface.geometric_normal) < 0.0 ? -1.0 : 1.0;
    surface.shading_normal =
        side * mapped_normal(scene, hit, vertex_normal, material.normal_texture, material.normal_scale);
    surface.base_color = glm::dvec3(material.base_color) * glm::dvec3(vertex_color(scene, hit)) *
                         glm::dvec3(lookup(scene, hit, material.base_color_texture, Encoding::srgb));
    surface.ior = material.ior;
    if ((surface.front || material.double_sided) && !material.unlit) {
        surface.emission =
            glm::dvec3(material.emission) * glm::dvec3(lookup(scene, hit, material.emissive_texture, Encoding::srgb));
    }

    Bsdf& bsdf = surface.bsdf;
    bsdf.geometric_normal = surface.geometric_normal;
    bsdf.normal = surface.shading_normal;
    bsdf.base_color = surface.base_color;
    const glm::dvec4 metallic_roughness = lookup(scene, hit, material.metallic_roughness_texture, Encoding::linear);
    const double roughness = material.roughness * metallic_roughness.g;
    bsdf.metallic = material.metallic * metallic_roughness.b;
    bsdf.alpha = roughness * roughness;
    bsdf.transmission = material.transmission * lookup(scene, hit, material.transmission_texture, Encoding::linear).r;
    bsdf.ior = bsdf.refraction_ior = material.ior;
    bsdf.specular = material.specular * lookup(scene, hit, material.specular_texture, Encoding::linear).a;
    bsdf.specular_color = glm::dvec3(material.specular_color) *
                          glm::dvec3(lookup(scene, hit, material.specular_color_texture, Encoding::srgb));
    bsdf.coat = material.clearcoat * lookup(scene, hit, material.clearcoat_texture, Encoding::linear).r;
    const double coat_roughness =
        material.clearcoat_roughness * lookup(scene, hit, material.clearcoat_roughness_texture, Encoding::linear).g;
    bsdf.coat_alpha = coat_roughness * coat_roughness;
    bsdf.coat_normal = side * mapped_normal(scene, hit, vertex_normal, material.clearcoat_normal_texture,
                                            material.clearcoat_normal_scale);
    // Where the coat's normal faces away the face's stands in.
    const double facing = -glm::dot(bsdf.coat_normal, direction);
    const double coat_cosine = facing > 0.0 ? facing : -glm::dot(surface.geometric_normal, direction);
    const double coat_fresnel = 0.04 + 0.96 * std::pow(1.0 - coat_cosine, 5.0);
    surface.emission *= 1.0 - bsdf.coat * coat_fresnel;  // KHR_materials_clearcoat, Emission
    bsdf.film = material.iridescence * lookup(scene, hit, material.iridescence_texture, Encoding::linear).r;
    bsdf.film_ior = material.iridescence_ior;
    bsdf.film_thickness =
        glm::mix(double(material.iridescence_thickness_minimum), double(material.iridescence_thickness_maximum),
                 lookup(scene, hit, material.iridescence_thickness_texture, Encoding::linear).g);
    bsdf.sheen_color =
        glm::dvec3(material.sheen_color) * glm::dvec3(lookup(scene, hit, material.sheen_color_texture, Encoding::srgb));
    const double sheen_roughness =
        material.sheen_roughness * lookup(scene, hit, material.sheen_roughness_texture, Encoding::linear).a;
    bsdf.sheen_alpha = sheen_roughness * sheen_roughness;
    bsdf.thin = material.thickness == 0.0f;
    bsdf.front = surface.front;
    set_anisotropy(scene, hit, side * surface.shading_normal, material, bsdf);
    surface.scattering = classify(bsdf);
    return surface;
}

double coverage(const Scene& scene, const Hit& hit) {
    const Material& material = scene.materials[scene.triangles[hit.triangle].material];
    if (material.alpha == Material::Alpha::opaque) return 1.0;
    const double alpha = material.opacity * vertex_color(scene, hit).a *
                         lookup(scene, hit, material.base_color_texture, Encoding::srgb).a;
    return material.alpha == Material::Alpha::mask ? (alpha >= material.alpha_cutoff ? 1.0 : 0.0) : alpha;
}

glm::dvec3 absorption(const Material& material) {
    return std::isinf(material.attenuation_distance)
               ? glm::dvec3(0.0)
               : -glm::log(glm::dvec3(material.attenuation_color)) / double(material.attenuation_distance);
}

Ray leave(const Surface& surface, const glm::dvec3& direction) {
    const double size =
        std::max({std::abs(surface.position.x), std::abs(surface.position.y), std::abs(surface.position.z), 1e-3});
    const double side = glm::dot(direction, surface.geometric_normal) < 0.0 ? -1.0 : 1.0;
    return {surface.position + side * 1e-9 * size * surface.geometric_normal, direction};
}

}  // namespace vkcppm::oracle
