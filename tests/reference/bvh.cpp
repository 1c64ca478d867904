#include "reference/bvh.h"

#include <algorithm>
#include <numeric>

#include <glm/common.hpp>

namespace vkcppm::reference {
namespace {

constexpr std::uint32_t leaf_size = 4;

glm::dvec3 centroid(const Scene& scene, std::uint32_t triangle) {
    const auto& v = scene.triangles[triangle].vertex;
    return (scene.positions[v[0]] + scene.positions[v[1]] + scene.positions[v[2]]) / 3.0;
}

/// Slab test; a box that the ray touches counts.
bool meets(const glm::dvec3& low, const glm::dvec3& high, const Ray& ray, double t_max) {
    double near = ray.t_min, far = t_max;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0.0) {
            if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) {
                return false;
            }
            continue;
        }
        const double t0 = (low[axis] - ray.origin[axis]) / ray.direction[axis];
        const double t1 = (high[axis] - ray.origin[axis]) / ray.direction[axis];
        near = std::max(near, std::min(t0, t1));
        far = std::min(far, std::max(t0, t1));
    }
    return near <= far;
}

}  // namespace

Bvh::Bvh(const Scene& scene) : scene_(scene), order_(scene.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) {
        build(0, static_cast<std::uint32_t>(order_.size()));
    }
}

std::uint32_t Bvh::build(std::uint32_t first, std::uint32_t count) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    glm::dvec3 low_center(low), high_center(high);
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (const std::uint32_t v : scene_.triangles[order_[i]].vertex) {
            low = glm::min(low, scene_.positions[v]);
            high = glm::max(high, scene_.positions[v]);
        }
        low_center = glm::min(low_center, centroid(scene_, order_[i]));
        high_center = glm::max(high_center, centroid(scene_, order_[i]));
    }
    // Rounding of a hit point must not put it outside the box that holds its triangle.
    const glm::dvec3 margin = 1e-9 * (high - low) + 1e-12 * (glm::abs(low) + glm::abs(high));
    nodes_[index].low = low - margin;
    nodes_[index].high = high + margin;
    if (count <= leaf_size) {
        nodes_[index].first = first;
        nodes_[index].count = count;
        return index;
    }
    const glm::dvec3 extent = high_center - low_center;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return centroid(scene_, a)[axis] < centroid(scene_, b)[axis];
                     });
    build(first, half);  // the left child follows its parent
    const std::uint32_t right = build(first + half, count - half);
    nodes_[index].first = right;
    return index;
}

std::optional<Hit> Bvh::nearest(const Ray& ray) const {
    std::optional<Hit> nearest;
    Ray shrinking = ray;
    std::vector<std::uint32_t> stack;
    if (!nodes_.empty()) {
        stack.push_back(0);
    }
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        const Node& node = nodes_[index];
        stack.pop_back();
        if (!meets(node.low, node.high, ray, shrinking.t_max)) {
            continue;
        }
        if (node.count == 0) {
            stack.push_back(node.first);
            stack.push_back(index + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (const auto hit = intersect(scene_, order_[i], shrinking)) {
                nearest = hit;
                shrinking.t_max = hit->t;
            }
        }
    }
    return nearest;
}

}  // namespace vkcppm::reference
