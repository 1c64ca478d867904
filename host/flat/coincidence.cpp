#include "flat/coincidence.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <unordered_map>

#include <boost/geometry/strategies/strategies.hpp>  // the tree needs it, and Boost 1.83 does not bring it along
#include <boost/geometry/algorithms/intersects.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>
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

std::uint64_t mixed(std::uint64_t x) {  // MurmurHash3's finaliser
    x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
    return x ^ x >> 33;
}

/// The same for the corners in any order, and for -0 as for 0.
std::uint64_t hash_of(const Corners& c) {
    std::uint64_t sum = 0;
    for (const glm::vec3& p : c) {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) hash = mixed(hash ^ std::bit_cast<std::uint32_t>(p[axis] + 0.0f));
        sum += hash;
    }
    return mixed(sum);
}

/// A triangle by its corners, from the least one on.
struct Keyed {
    Corners key;
    std::uint32_t index;
};

/// Calls use(triangles) for every set of two or more that have the same three corners, in whatever order, and perhaps
/// others with them: in the order of their keys, then of their indices. To sort a word for each triangle is all that it
/// takes where there are few such.
template <typename Use> void each_of_same_hash(std::span<const Corners> corners, Use use) {
    constexpr int index_bits = 28;
    constexpr std::uint64_t index_mask = (std::uint64_t(1) << index_bits) - 1;
    assert(corners.size() <= index_mask);
    const auto words = std::make_unique_for_overwrite<std::uint64_t[]>(corners.size());
    const std::span<std::uint64_t> sorted(words.get(), corners.size());
    tbb::parallel_for(std::size_t(0), corners.size(),
                      [&](std::size_t i) { sorted[i] = (hash_of(corners[i]) & ~index_mask) | i; });
    tbb::parallel_sort(sorted.begin(), sorted.end());
    std::vector<Keyed> same;
    for (std::size_t i = 0, end; i < sorted.size(); i = end) {
        for (end = i + 1; end < sorted.size() && ((sorted[end] ^ sorted[i]) & ~index_mask) == 0;) ++end;
        if (end - i < 2) continue;
        same.clear();
        for (std::size_t k = i; k < end; ++k) {
            const auto index = std::uint32_t(sorted[k] & index_mask);
            same.push_back({from_least(corners[index]), index});
        }
        std::ranges::sort(same, [](const Keyed& a, const Keyed& b) {
            return is_before(a.key, b.key) || (a.key == b.key && a.index < b.index);
        });
        use(std::span<const Keyed>(same));
    }
}

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
    std::vector<std::uint8_t> is_kept(corners.size());
    tbb::parallel_for(std::size_t(0), corners.size(),
                      [&](std::size_t i) { is_kept[i] = has_normal(from_least(corners[i])); });
    each_of_same_hash(corners, [&](std::span<const Keyed> same) {
        for (std::size_t i = 0, end; i < same.size(); i = end) {
            std::uint32_t chosen = same[i].index;
            const bool keep = is_kept[chosen];
            for (end = i; end < same.size() && same[end].key == same[i].key; ++end) {
                is_kept[same[end].index] = false;
                if (faces[same[end].index].emits && !faces[chosen].emits) chosen = same[end].index;
            }
            is_kept[chosen] = keep;
        }
    });
    std::vector<std::uint32_t> kept;
    kept.reserve(std::size_t(std::ranges::count(is_kept, std::uint8_t(1))));
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (is_kept[i]) kept.push_back(i);
    }
    return kept;
}

namespace {

/// A triangle that may have to be moved off another one.
struct Touching {
    std::uint32_t movable;
    std::uint32_t other;
};

/// The faces of solid glass and the lamps that lie on another face, wholly or in part, by the other face.
std::vector<Touching> touching_faces(std::span<const Corners> corners, std::span<const FaceTraits> faces) {
    std::vector<Entry> movable;
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (faces[i].is_solid || faces[i].emits) {
            movable.emplace_back(box_of(corners[i], position_error(corners[i])), i);
        }
    }
    if (movable.empty()) return {};
    const geometry::index::rtree<Entry, geometry::index::quadratic<16>> tree(movable);
    std::vector<Entry>().swap(movable);
    const Box whole = tree.bounds();
    const auto add = [&](std::uint32_t other, std::vector<Touching>& found) {
        const Box box = box_of(corners[other], position_error(corners[other]));
        if (!geometry::intersects(box, whole)) return;
        for (auto entry = tree.qbegin(geometry::index::intersects(box)); entry != tree.qend(); ++entry) {
            const std::uint32_t i = entry->second;
            if (i == other || (!faces[i].is_solid && faces[other].emits)) continue;
            const double facing = glm::dot(area_vector(corners[i]), area_vector(corners[other]));
            if (faces[i].is_solid && facing >= 0.0) continue;
            const double tolerance = double(position_error(corners[i]) + position_error(corners[other]));
            if (lies_on(corners[i], corners[other], tolerance)) found.push_back({i, other});
        }
    };
    // Block by block, each with a list of its own, so that the order does not hang on the threads.
    constexpr std::size_t block = 1 << 14;
    std::vector<std::vector<Touching>> found((corners.size() + block - 1) / block);
    tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t b) {
        const std::size_t end = std::min(corners.size(), (b + 1) * block);
        for (std::size_t other = b * block; other < end; ++other) add(std::uint32_t(other), found[b]);
    });
    std::vector<Touching> all;
    for (const std::vector<Touching>& of_block : found) all.insert(all.end(), of_block.begin(), of_block.end());
    return all;
}

}  // namespace

bool part_touching_faces(std::span<Corners> corners, std::span<const FaceTraits> faces, float least_error) {
    const auto error = [&](std::uint32_t i) { return std::max(least_error, position_error(corners[i])); };
    std::unordered_map<std::uint32_t, float> shifts;  // towards the front
    const auto gap_of = [&](const Touching& pair) { return 2.0f * (error(pair.movable) + error(pair.other)); };
    const auto move = [&](std::uint32_t i, float gap, float side) {
        float& shift = shifts[i];
        if (gap > std::abs(shift)) shift = side * gap;
    };
    each_of_same_hash(corners, [&](std::span<const Keyed> same) {
        for (const auto& [key, i] : same) {
            if (faces[i].is_solid) continue;
            const Corners back = reversed(key);
            const auto first =
                std::ranges::partition_point(same, [&](const Keyed& k) { return is_before(k.key, back); });
            for (auto twin = first; twin != same.end() && twin->key == back; ++twin) {
                const FaceTraits& other = faces[twin->index];
                const bool alike = other.material == faces[i].material && !faces[i].emits;
                if (!other.is_solid && !alike) move(i, gap_of({i, twin->index}), 1.0f);
            }
        }
    });
    // Solids after all else: what a solid touches may itself have gone to its front, towards the solid.
    const std::vector<Touching> touching = touching_faces(corners, faces);
    for (const Touching& pair : touching) {
        if (!faces[pair.movable].is_solid) move(pair.movable, gap_of(pair), 1.0f);
    }
    bool solids_touch = false;
    for (const Touching& pair : touching) {
        if (!faces[pair.movable].is_solid) continue;
        const bool both = faces[pair.other].is_solid;
        solids_touch = solids_touch || both;
        const auto moved = shifts.find(pair.other);
        const float nearer = both || moved == shifts.end() ? 0.0f : moved->second;
        move(pair.movable, gap_of(pair) + nearer, both ? 1.0f : -1.0f);
    }
    for (const auto& [i, shift] : shifts) {
        const glm::vec3 offset = glm::vec3(unit_normal(corners[i]) * double(shift));
        for (glm::vec3& corner : corners[i]) corner += offset;
    }
    return solids_touch;
}

}  // namespace vkcppm
