#include "flat/coincidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include <boost/geometry/strategies/strategies.hpp>  // the tree needs it, and Boost 1.83 does not bring it along
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_sort.h>

namespace vkcppm {
namespace {

constexpr float half_ulps_8 = 4.8e-7f;  // 8 x 2^-24, rounded up; the same in shaders/include/light.glsl

namespace geometry = boost::geometry;
using Point = geometry::model::point<float, 3, geometry::cs::cartesian>;
using Box = geometry::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;  // of a triangle

bool is_before(const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

/// The corners from the least one on, in the same sense.
Corners from_least(const Corners& c) {
    const int first = int(std::min_element(c.begin(), c.end(), is_before) - c.begin());
    return {c[first], c[(first + 1) % 3], c[(first + 2) % 3]};
}

Corners reversed(const Corners& c) { return from_least({c[0], c[2], c[1]}); }

bool is_before(const Corners& a, const Corners& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                        [](const glm::vec3& p, const glm::vec3& q) { return is_before(p, q); });
}

/// Twice the area times the normal of the front.
glm::dvec3 area_vector(const Corners& c) { return glm::cross(glm::dvec3(c[1] - c[0]), glm::dvec3(c[2] - c[0])); }

glm::dvec3 unit_normal(const Corners& c) { return glm::normalize(area_vector(c)); }

/// False where rounding of the edges decides about the normal, as in a triangle without an area.
bool has_normal(const Corners& c) {
    const auto length2 = [](const glm::vec3& v) { return glm::dot(glm::dvec3(v), glm::dvec3(v)); };
    const double longest2 = std::max({length2(c[1] - c[0]), length2(c[2] - c[1]), length2(c[0] - c[2])});
    return glm::length(area_vector(c)) > double(std::numeric_limits<float>::epsilon()) * longest2;
}

/// Triangles in the order of their corners, from the least one on.
struct SortedTriangles {
    std::vector<Corners> keys;         // of all triangles
    std::vector<std::uint32_t> order;  // of the same key, ascending

    explicit SortedTriangles(std::span<const Corners> corners) : order(corners.size()) {
        keys.reserve(corners.size());
        for (const Corners& c : corners) keys.push_back(from_least(c));
        std::iota(order.begin(), order.end(), 0u);
        tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return is_before(keys[a], keys[b]) || (keys[a] == keys[b] && a < b);
        });
    }

    /// The triangles with the corners of that key.
    std::span<const std::uint32_t> equal(const Corners& key) const {
        const auto first =
            std::partition_point(order.begin(), order.end(), [&](std::uint32_t i) { return is_before(keys[i], key); });
        const auto last = std::partition_point(first, order.end(), [&](std::uint32_t i) { return keys[i] == key; });
        return {first, last};
    }
};

Box box_of(const Corners& c, float margin) {
    const glm::vec3 low = glm::min(c[0], glm::min(c[1], c[2])) - margin;
    const glm::vec3 high = glm::max(c[0], glm::max(c[1], c[2])) + margin;
    return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

/// Of points along an axis.
struct Interval {
    double low, high;

    Interval(const Corners& c, const glm::dvec3& axis) {
        const auto at = [&](int corner) { return glm::dot(glm::dvec3(c[corner]), axis); };
        std::tie(low, high) = std::minmax({at(0), at(1), at(2)});
    }
};

/// True where b lies in the plane of a within `tolerance` and they share more than an edge.
bool lies_on(const Corners& a, const Corners& b, double tolerance) {
    const glm::dvec3 n = unit_normal(a);
    if (std::abs(glm::dot(n, unit_normal(b))) < 0.999) return false;
    const double height = glm::dot(glm::dvec3(a[0]), n);
    const Interval heights(b, n);
    if (heights.low < height - tolerance || heights.high > height + tolerance) return false;
    // Within the plane two triangles are apart where an edge of one of them separates them.
    for (const Corners* triangle : {&a, &b}) {
        for (int c = 0; c < 3; ++c) {
            const glm::dvec3 across = glm::cross(n, glm::dvec3((*triangle)[(c + 1) % 3] - (*triangle)[c]));
            const glm::dvec3 axis = glm::normalize(across);
            const Interval in_a(a, axis), in_b(b, axis);
            if (std::min(in_a.high, in_b.high) - std::max(in_a.low, in_b.low) <= 4.0 * tolerance) return false;
        }
    }
    return true;
}

}  // namespace

float position_error(const Corners& c) {
    const glm::vec3 extent = glm::abs(c[0]) + glm::abs(c[1] - c[0]) + glm::abs(c[2] - c[0]);
    return half_ulps_8 * std::max({extent.x, extent.y, extent.z});
}

std::vector<std::uint32_t> distinct_triangles(std::span<const Corners> corners, std::span<const FaceTraits> faces) {
    const SortedTriangles sorted(corners);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < sorted.order.size();) {
        const Corners& key = sorted.keys[sorted.order[i]];
        std::uint32_t chosen = sorted.order[i];
        for (; i < sorted.order.size() && sorted.keys[sorted.order[i]] == key; ++i) {
            if (faces[sorted.order[i]].emits && !faces[chosen].emits) chosen = sorted.order[i];
        }
        if (has_normal(key)) kept.push_back(chosen);
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

void part_touching_faces(std::vector<Corners>& corners, std::span<const FaceTraits> faces) {
    std::vector<float> shifts(corners.size(), 0.0f);  // towards the front
    const auto move = [&](std::uint32_t i, std::uint32_t other, float side) {
        const float gap = 2.0f * (position_error(corners[i]) + position_error(corners[other]));
        if (gap > std::abs(shifts[i])) shifts[i] = side * gap;
    };

    const SortedTriangles sorted(corners);
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (faces[i].is_solid) continue;
        for (const std::uint32_t twin : sorted.equal(reversed(corners[i]))) {
            const bool same = faces[twin].material == faces[i].material && !faces[i].emits;
            if (!faces[twin].is_solid && !same) move(i, twin, 1.0f);
        }
    }

    std::vector<Entry> movable;
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (faces[i].is_solid || faces[i].emits) {
            movable.emplace_back(box_of(corners[i], position_error(corners[i])), i);
        }
    }
    const geometry::index::rtree<Entry, geometry::index::quadratic<16>> tree(movable);
    for (std::uint32_t other = 0; other < corners.size(); ++other) {
        const auto near = geometry::index::intersects(box_of(corners[other], position_error(corners[other])));
        for (auto entry = tree.qbegin(near); entry != tree.qend(); ++entry) {
            const std::uint32_t i = entry->second;
            if (i == other || (!faces[i].is_solid && faces[other].emits)) continue;
            const double facing = glm::dot(area_vector(corners[i]), area_vector(corners[other]));
            if (faces[i].is_solid && facing >= 0.0) continue;
            const double tolerance = double(position_error(corners[i]) + position_error(corners[other]));
            if (lies_on(corners[i], corners[other], tolerance)) move(i, other, faces[i].is_solid ? -1.0f : 1.0f);
        }
    }

    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (shifts[i] == 0.0f) continue;
        const glm::vec3 shift = glm::vec3(unit_normal(corners[i]) * double(shifts[i]));
        for (glm::vec3& corner : corners[i]) corner += shift;
    }
}

}  // namespace vkcppm
