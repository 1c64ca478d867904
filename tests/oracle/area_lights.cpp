#include "oracle/area_lights.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "oracle/bsdf.h"

namespace vkcppm::oracle {
namespace {

double emission(const Scene& scene, std::uint32_t triangle) {
    const Material& material = scene.materials[scene.triangles[triangle].material];
    return material.unlit ? 0.0 : std::max({material.emission.x, material.emission.y, material.emission.z});
}

}  // namespace

AreaLights::AreaLights(const Scene& scene) : scene_(scene) {
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const auto& v = scene.triangles[i].vertex;
        const glm::dvec3& p = scene.positions[v[0]];
        const double area = glm::length(glm::cross(scene.positions[v[1]] - p, scene.positions[v[2]] - p)) / 2.0;
        if (const double weight = area * emission(scene, i); weight > 0.0) {
            triangles_.push_back(i);
            cumulative_.push_back(total_ += weight);
        }
    }
}

AreaLights::Point AreaLights::sample(std::mt19937_64& random) const {
    const double place = uniform(random) * total_;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), place);
    const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), triangles_.size() - 1);
    const double u = uniform(random), v = uniform(random);
    const double root = std::sqrt(u);
    const glm::dvec3 weight(1.0 - root, root * (1.0 - v), root * v);
    const auto& corner = scene_.triangles[triangles_[i]].vertex;
    return {triangles_[i], weight,
            weight.x * scene_.positions[corner[0]] + weight.y * scene_.positions[corner[1]] +
                weight.z * scene_.positions[corner[2]]};
}

double AreaLights::density(std::uint32_t triangle) const {
    return total_ > 0.0 ? emission(scene_, triangle) / total_ : 0.0;
}

}  // namespace vkcppm::oracle
