#include "oracle/intersect.h"

#include <glm/geometric.hpp>

namespace vkcppm::oracle {

std::optional<Hit> intersect(const Scene& scene, std::uint32_t triangle, const Ray& ray) {
    const auto& vertex = scene.triangles[triangle].vertex;
    const glm::dvec3 a = scene.positions[vertex[0]] - ray.origin;
    const glm::dvec3 b = scene.positions[vertex[1]] - ray.origin;
    const glm::dvec3 c = scene.positions[vertex[2]] - ray.origin;
    // Six times the signed volume of the tetrahedron (origin, edge, direction) for the edge opposite each vertex.
    const glm::dvec3 volume(glm::dot(ray.direction, glm::cross(b, c)), glm::dot(ray.direction, glm::cross(c, a)),
                            glm::dot(ray.direction, glm::cross(a, b)));
    const bool any_negative = volume.x < 0.0 || volume.y < 0.0 || volume.z < 0.0;
    const bool any_positive = volume.x > 0.0 || volume.y > 0.0 || volume.z > 0.0;
    if (any_negative == any_positive) {
        return std::nullopt;  // outside the triangle, or (all zero) in its plane
    }
    const glm::dvec3 barycentric = volume / (volume.x + volume.y + volume.z);
    const glm::dvec3 point = barycentric.x * a + barycentric.y * b + barycentric.z * c;
    const double t = glm::dot(point, ray.direction) / glm::dot(ray.direction, ray.direction);
    if (!(t > ray.t_min && t < ray.t_max)) return std::nullopt;
    return Hit{t, barycentric, triangle};
}

std::optional<Hit> nearest_hit(const Scene& scene, const Ray& ray) {
    std::optional<Hit> nearest;
    for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
        const auto hit = intersect(scene, triangle, ray);
        if (hit && (!nearest || hit->t < nearest->t)) nearest = hit;
    }
    return nearest;
}

}  // namespace vkcppm::oracle
