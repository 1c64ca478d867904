#include "scene/diagnosis/shell.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/instances.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A number for every position that the triangles use, by vertex; vertices at one position share theirs.
struct Welding {
    std::vector<std::uint32_t> point;  // [V], none where no triangle uses the vertex
    std::uint32_t points = 0;
};

struct Vertex {
    double x, y, z;
    std::uint32_t mesh;  // positions in different spaces are never one
    std::uint32_t index;
    auto position() const { return std::tie(mesh, x, y, z); }
};

/// Takes coordinates of one space that rounding alone tells apart for the least of them. Seams have some: a sphere that
/// is made in floats ends at sin(2 pi), which is -1.7e-7, and in doubles -2.4e-16, where it has begun at 0.
void round(std::span<Vertex> vertices) {
    constexpr double rounding = 1.0 / (1 << 22);  // of the largest extent
    const std::array axes = {&Vertex::x, &Vertex::y, &Vertex::z};
    double extent = 0.0;
    for (const auto axis : axes) {
        const auto [low, high] = std::ranges::minmax(vertices, {}, axis);
        extent = std::max(extent, high.*axis - low.*axis);
    }
    for (const auto axis : axes) {
        std::ranges::sort(vertices, {}, axis);
        double least = vertices.front().*axis;
        for (Vertex& vertex : vertices) {
            if (vertex.*axis - least > rounding * extent) least = vertex.*axis;
            vertex.*axis = least;
        }
    }
}

Welding weld(const Scene& scene, std::span<const std::uint32_t> triangles) {
    Welding welding{std::vector<std::uint32_t>(scene.positions.size(), none), 0};
    std::vector<Vertex> vertices;
    for (const std::uint32_t i : triangles) {
        const std::uint32_t mesh = mesh_of(scene, i).value_or(none);
        for (const std::uint32_t vertex : scene.triangles[i].vertex) {
            if (welding.point[vertex] != none) continue;
            welding.point[vertex] = 0;
            const glm::dvec3 p = scene.positions[vertex];
            vertices.push_back({p.x, p.y, p.z, mesh, vertex});
        }
    }
    std::ranges::sort(vertices, {}, &Vertex::mesh);
    for (auto first = vertices.begin(), last = first; first != vertices.end(); first = last) {
        last = std::ranges::upper_bound(first, vertices.end(), first->mesh, {}, &Vertex::mesh);
        round({first, last});
    }
    std::ranges::sort(vertices, [](const Vertex& a, const Vertex& b) { return a.position() < b.position(); });
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i > 0 && vertices[i].position() != vertices[i - 1].position()) ++welding.points;
        welding.point[vertices[i].index] = welding.points;
    }
    welding.points += vertices.empty() ? 0 : 1;
    return welding;
}

/// A triangle's way along an edge.
struct Side {
    std::uint32_t from;      // the lower point of the edge
    std::uint32_t to;        // the higher one
    std::uint32_t triangle;  // into the triangles that are looked at
    std::int32_t sense;      // 1: from the lower to the higher, else -1
};

/// The sides of all edges, those of one edge side by side.
std::vector<Side> sorted_sides(const Scene& scene, std::span<const std::uint32_t> triangles, const Welding& welding) {
    std::vector<std::array<std::uint32_t, 3>> corners(triangles.size());
    std::vector<std::size_t> first(std::size_t(welding.points) + 1);  // by lower point: where its sides begin
    const auto each_side = [&](auto&& use) {
        for (std::uint32_t t = 0; t < corners.size(); ++t) {
            const auto& [a, b, c] = corners[t];
            if (a == b || b == c || c == a) continue;
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
                use(from < to ? Side{from, to, t, 1} : Side{to, from, t, -1});
            }
        }
    };
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) corners[t][k] = welding.point[scene.triangles[triangles[t]].vertex[k]];
    }
    // By the lower point in two passes over the triangles, then each point's few sides by the higher one.
    each_side([&](const Side& side) { ++first[side.from + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Side> sides(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    each_side([&](const Side& side) { sides[next[side.from]++] = side; });
    for (std::uint32_t point = 0; point < welding.points; ++point) {
        std::sort(sides.begin() + std::ptrdiff_t(first[point]), sides.begin() + std::ptrdiff_t(first[point + 1]),
                  [](const Side& a, const Side& b) { return std::tie(a.to, a.triangle) < std::tie(b.to, b.triangle); });
    }
    return sides;
}

/// Sets that grow together (Tarjan 1975), each named by its lowest member.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Six times the volume between the triangle and the point, positive where the front faces away from it.
double sixfold_volume(const std::array<glm::dvec3, 3>& p, const glm::dvec3& point) {
    return glm::dot(p[0] - point, glm::cross(p[1] - point, p[2] - point));
}

void measure(Shell& shell, const Scene& scene) {
    const glm::dvec3 origin = corners_of(scene, shell.triangles.front())[0];
    shell.low = shell.high = origin;
    for (const std::uint32_t triangle : shell.triangles) {
        const std::array<glm::dvec3, 3> p = corners_of(scene, triangle);
        shell.volume += sixfold_volume(p, origin) / 6.0;
        shell.low = glm::min(shell.low, glm::min(p[0], glm::min(p[1], p[2])));
        shell.high = glm::max(shell.high, glm::max(p[0], glm::max(p[1], p[2])));
    }
}

}  // namespace

bool Shell::is_flat() const {
    constexpr double least = 1e-9;  // of the bounding box: far above the rounding of the sum
    const glm::dvec3 size = high - low;
    return std::abs(volume) <= least * size.x * size.y * size.z;
}

std::vector<Shell> find_shells(const Scene& scene, std::span<const std::uint32_t> triangles) {
    const std::vector<Side> sides = sorted_sides(scene, triangles, weld(scene, triangles));
    struct BadEdge {
        std::uint32_t triangle;
        bool open;
    };
    std::vector<BadEdge> bad;
    std::vector<bool> has_sides(triangles.size());
    DisjointSets sets(triangles.size());
    for (std::size_t i = 0, end; i < sides.size(); i = end) {
        std::int64_t sense = 0;
        for (end = i; end < sides.size() && sides[end].from == sides[i].from && sides[end].to == sides[i].to; ++end) {
            sets.join(sides[i].triangle, sides[end].triangle);
            has_sides[sides[end].triangle] = true;
            sense += sides[end].sense;
        }
        if (sense != 0) bad.push_back({sides[i].triangle, (end - i) % 2 == 1});
    }

    std::vector<Shell> shells;
    std::vector<std::uint32_t> shell_of(triangles.size(), none);  // by lowest member
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (!has_sides[t]) continue;
        std::uint32_t& shell = shell_of[sets.find(t)];
        if (shell == none) {
            shell = std::uint32_t(shells.size());
            shells.emplace_back();
        }
        shells[shell].triangles.push_back(triangles[t]);
    }
    for (const BadEdge& edge : bad) {
        Shell& shell = shells[shell_of[sets.find(edge.triangle)]];
        ++(edge.open ? shell.open_edges : shell.twisted_edges);
    }
    for (Shell& shell : shells) measure(shell, scene);
    return shells;
}

std::vector<std::span<const Shell>> by_space(const Scene& scene, std::span<const Shell> shells) {
    std::vector<std::span<const Shell>> spaces;
    for (std::size_t first = 0, last; first < shells.size(); first = last) {
        const auto mesh = mesh_of(scene, shells[first].triangles.front());
        for (last = first; last < shells.size(); ++last) {
            if (mesh_of(scene, shells[last].triangles.front()) != mesh) break;
        }
        spaces.push_back(shells.subspan(first, last - first));
    }
    return spaces;
}

std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t triangle) {
    const auto& vertex = scene.triangles[triangle].vertex;
    return {scene.positions[vertex[0]], scene.positions[vertex[1]], scene.positions[vertex[2]]};
}

double share_of_directions(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point) {
    const glm::dvec3 a = corners[0] - point, b = corners[1] - point, c = corners[2] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double y = glm::dot(a, glm::cross(b, c));
    const double x = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    // A triangle that the point lies on covers half of all directions, of which side only rounding could tell.
    const double least = 1e-9 * la * lb * lc;
    return std::abs(y) > least || x > least ? std::atan2(y, x) / (2.0 * std::numbers::pi) : 0.0;
}

double winding_number(const Scene& scene, const Shell& shell, const glm::dvec3& point) {
    double sum = 0.0;
    for (const std::uint32_t triangle : shell.triangles) sum += share_of_directions(corners_of(scene, triangle), point);
    return sum;
}

}  // namespace vkcppm
