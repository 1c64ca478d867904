#include "oracle/bvh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include <glm/common.hpp>

namespace vkcppm::oracle {
namespace {

constexpr std::uint32_t leaf_size = 2;
constexpr std::size_t bins = 16;
constexpr std::uint32_t deepest_by_area = 24;  // below that halves, so that a stack of 64 holds any tree

glm::dvec3 centroid(const Scene& scene, std::uint32_t triangle) {
    const auto& v = scene.triangles[triangle].vertex;
    return (scene.positions[v[0]] + scene.positions[v[1]] + scene.positions[v[2]]) / 3.0;
}

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const glm::dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    /// Half its surface; 0 of none.
    double area() const {
        const glm::dvec3 d = glm::max(high - low, glm::dvec3(0.0));
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

/// Where to cut a node: its children hold the bins of `axis` up to `last`, and those behind.
struct Cut {
    int axis = -1;  // none
    std::size_t last = 0;
    double cost = std::numeric_limits<double>::infinity();  // triangles times area, of both children
};

std::size_t bin_of(double centre, double low, double extent) {
    return std::min(bins - 1, static_cast<std::size_t>(double(bins) * ((centre - low) / extent)));
}

/// Slab test: where the ray enters the box, infinite where it misses it; a box that the ray touches counts.
/// `inverse`: 1 / direction.
double enter(const glm::dvec3& low, const glm::dvec3& high, const Ray& ray, const glm::dvec3& inverse) {
    double near = ray.t_min, far = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0.0) {
            if (ray.origin[axis] < low[axis] || ray.origin[axis] > high[axis]) {
                return std::numeric_limits<double>::infinity();
            }
            continue;
        }
        const double t0 = (low[axis] - ray.origin[axis]) * inverse[axis];
        const double t1 = (high[axis] - ray.origin[axis]) * inverse[axis];
        const double first = t0 < t1 ? t0 : t1, last = t0 < t1 ? t1 : t0;
        near = first > near ? first : near;
        far = last < far ? last : far;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
}

}  // namespace

Bvh::Bvh(const Scene& scene) : scene_(scene), order_(scene.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), 0);
}

std::uint32_t Bvh::build(std::uint32_t first, std::uint32_t count, std::uint32_t depth) {
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
    // The cut between bins that rays cross least (surface area heuristic): small triangles in a room of large ones.
    Cut best;
    for (int axis = 0; axis < 3 && depth < deepest_by_area; ++axis) {
        if (!(extent[axis] > 0.0)) continue;
        std::array<Box, bins> boxes, behind;
        std::array<std::uint32_t, bins> counts{};
        for (std::uint32_t i = first; i < first + count; ++i) {
            const std::size_t bin = bin_of(centroid(scene_, order_[i])[axis], low_center[axis], extent[axis]);
            for (const std::uint32_t v : scene_.triangles[order_[i]].vertex) boxes[bin].add(scene_.positions[v]);
            ++counts[bin];
        }
        behind[bins - 1] = boxes[bins - 1];
        for (std::size_t bin = bins - 1; bin-- > 0;) (behind[bin] = boxes[bin]).add(behind[bin + 1]);
        Box before;
        std::uint32_t left = 0;
        for (std::size_t bin = 0; bin + 1 < bins; ++bin) {
            before.add(boxes[bin]);
            left += counts[bin];
            if (left == 0 || left == count) continue;
            const double cost = left * before.area() + (count - left) * behind[bin + 1].area();
            if (cost < best.cost) best = {axis, bin, cost};
        }
    }
    std::uint32_t half = count / 2;
    const auto begin = order_.begin() + first, end = begin + count;
    if (best.axis >= 0) {
        const auto middle = std::partition(begin, end, [&](std::uint32_t triangle) {
            const double centre = centroid(scene_, triangle)[best.axis];
            return bin_of(centre, low_center[best.axis], extent[best.axis]) <= best.last;
        });
        half = static_cast<std::uint32_t>(middle - begin);
    } else {
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
            return centroid(scene_, a)[axis] < centroid(scene_, b)[axis];
        });
    }
    build(first, half, depth + 1);  // the left child follows its parent
    const std::uint32_t right = build(first + half, count - half, depth + 1);
    nodes_[index].first = right;
    return index;
}

std::optional<Hit> Bvh::walk(Ray ray, bool any) const {
    std::optional<Hit> nearest;
    if (nodes_.empty()) return nearest;
    const glm::dvec3 inverse = 1.0 / ray.direction;
    struct Entry {
        std::uint32_t node;
        double t;
    };
    std::array<Entry, 64> stack;  // deepest_by_area and 32 levels of halves, which hold every index
    std::size_t height = 0;
    stack[height++] = {0, enter(nodes_[0].low, nodes_[0].high, ray, inverse)};
    while (height > 0) {
        const Entry entry = stack[--height];
        if (!(entry.t < ray.t_max)) continue;
        const Node& node = nodes_[entry.node];
        if (node.count == 0) {
            Entry left{entry.node + 1, 0.0}, right{node.first, 0.0};
            for (Entry* child : {&left, &right}) {
                child->t = enter(nodes_[child->node].low, nodes_[child->node].high, ray, inverse);
            }
            if (left.t < right.t) std::swap(left, right);
            stack[height++] = left;  // the nearer one on top
            stack[height++] = right;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            if (const auto hit = intersect(scene_, order_[i], ray)) {
                nearest = hit;
                ray.t_max = hit->t;
                if (any) return nearest;
            }
        }
    }
    return nearest;
}

std::optional<Hit> Bvh::nearest(const Ray& ray) const { return walk(ray, false); }

bool Bvh::occluded(const Ray& ray) const { return walk(ray, true).has_value(); }

}  // namespace vkcppm::oracle
