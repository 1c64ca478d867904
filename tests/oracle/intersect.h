#pragma once
// Ray against triangles in double precision, by signed volumes (the GPU uses Moller-Trumbore in a BVH).

#include <cstdint>
#include <limits>
#include <optional>

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm::oracle {

struct Ray {
    glm::dvec3 origin;                                       // m
    glm::dvec3 direction;                                    // any length but zero; t counts in its lengths
    double t_min = 0.0;                                      // exclusive
    double t_max = std::numeric_limits<double>::infinity();  // exclusive
};

struct Hit {
    double t = 0.0;
    glm::dvec3 barycentric{0.0};  // weights of vertex 0, 1, 2; sum 1
    std::uint32_t triangle = 0;   // into Scene::triangles
};

/// Where the line of the ray meets the triangle, edges included, both sides; none where the ray lies in its plane,
/// where the triangle has no area, or where t is not inside (t_min, t_max).
std::optional<Hit> intersect(const Scene& scene, std::uint32_t triangle, const Ray& ray);

/// The hit with the smallest t over all triangles, one by one; of equals the triangle with the lowest index.
std::optional<Hit> nearest_hit(const Scene& scene, const Ray& ray);

}  // namespace vkcppm::oracle
