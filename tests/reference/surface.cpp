#include "reference/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "reference/fresnel.h"

namespace vkcppm::reference {
namespace {

/// Cosine-distributed about `normal`: a uniform point on the unit sphere added to the normal.
glm::dvec3 sample_cosine(const glm::dvec3& normal, std::mt19937_64& random) {
    for (;;) {
        const double z = 1.0 - 2.0 * uniform(random);
        const double angle = 2.0 * std::numbers::pi * uniform(random);
        const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
        const glm::dvec3 sum = normal + glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z);
        if (const double length = glm::length(sum); length > 1e-9) {
            return sum / length;
        }
    }
}

}  // namespace

Scattering scattering(const Material& material) {
    if (material.transmission == 1.0f && material.thickness > 0.0f && material.metallic == 0.0f &&
        material.roughness == 0.0f && material.base_color == glm::vec3(1.0f) &&
        std::isinf(material.attenuation_distance)) {
        return Scattering::glass;
    }
    if (material.metallic == 1.0f && material.roughness == 0.0f) {
        return Scattering::mirror;
    }
    if (material.metallic == 0.0f && material.specular == 0.0f && material.transmission == 0.0f) {
        return Scattering::lambert;
    }
    throw std::invalid_argument("material '" + material.name + "' is none of Lambert, mirror and clear glass");
}

Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction) {
    const Triangle& triangle = scene.triangles[hit.triangle];
    const auto& v = triangle.vertex;
    const Material& material = scene.materials[triangle.material];
    Surface surface;
    surface.position = hit.barycentric.x * scene.positions[v[0]] + hit.barycentric.y * scene.positions[v[1]] +
                       hit.barycentric.z * scene.positions[v[2]];
    surface.geometric_normal = glm::normalize(glm::cross(scene.positions[v[1]] - scene.positions[v[0]],
                                                         scene.positions[v[2]] - scene.positions[v[0]]));
    surface.front = glm::dot(surface.geometric_normal, direction) < 0.0;
    if (!surface.front) {
        surface.geometric_normal = -surface.geometric_normal;
    }
    surface.shading_normal = glm::normalize(hit.barycentric.x * glm::dvec3(scene.normals[v[0]]) +
                                            hit.barycentric.y * glm::dvec3(scene.normals[v[1]]) +
                                            hit.barycentric.z * glm::dvec3(scene.normals[v[2]]));
    if (glm::dot(surface.shading_normal, surface.geometric_normal) < 0.0) {
        surface.shading_normal = -surface.shading_normal;
    }
    surface.scattering = scattering(material);
    surface.base_color = material.base_color;
    surface.ior = material.ior;
    if (surface.front || material.double_sided) {
        surface.emission = material.emission;
    }
    return surface;
}

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

Scatter sample_scatter(const Surface& surface, const glm::dvec3& direction, std::mt19937_64& random) {
    const glm::dvec3& normal = surface.shading_normal;
    if (surface.scattering == Scattering::lambert) {
        const glm::dvec3 next = sample_cosine(normal, random);
        const bool above = glm::dot(next, surface.geometric_normal) > 0.0;
        return {next, above ? surface.base_color : glm::dvec3(0.0)};
    }
    // A shading normal may face away from a grazing ray that its triangle faces: the cosine is then that of grazing.
    const double cosine = glm::clamp(-glm::dot(direction, normal), 0.0, 1.0);
    const glm::dvec3 reflected = glm::reflect(direction, normal);
    if (surface.scattering == Scattering::mirror) {
        const bool above = glm::dot(reflected, surface.geometric_normal) > 0.0;
        return {reflected, above ? fresnel_metal(surface.base_color, cosine) : glm::dvec3(0.0)};
    }
    const double ior_ratio = surface.front ? surface.ior : 1.0 / surface.ior;
    if (uniform(random) < fresnel_dielectric(cosine, ior_ratio)) {
        return {reflected, glm::dvec3(1.0)};
    }
    const double squared = std::max(0.0, 1.0 - (1.0 - cosine * cosine) / (ior_ratio * ior_ratio));
    const glm::dvec3 refracted = (direction + cosine * normal) / ior_ratio - std::sqrt(squared) * normal;
    return {glm::normalize(refracted), glm::dvec3(1.0)};
}

Ray leave(const Surface& surface, const glm::dvec3& direction) {
    const double size = std::max({std::abs(surface.position.x), std::abs(surface.position.y),
                                  std::abs(surface.position.z), 1e-3});
    const double side = glm::dot(direction, surface.geometric_normal) < 0.0 ? -1.0 : 1.0;
    return {surface.position + side * 1e-9 * size * surface.geometric_normal, direction};
}

}  // namespace vkcppm::reference
