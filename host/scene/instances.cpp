#include "scene/instances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace vkcppm {
namespace {

constexpr int cells_a_side = 4;

/// The box round a box that is transformed.
SceneBox transformed(const glm::dmat4x3& transform, const SceneBox& box) {
    const glm::dvec3 centre = transform * glm::dvec4(0.5 * (box.low + box.high), 1.0);
    const glm::dvec3 half = 0.5 * (box.high - box.low);
    const glm::dvec3 extent =
        glm::abs(transform[0]) * half.x + glm::abs(transform[1]) * half.y + glm::abs(transform[2]) * half.z;
    return {centre - extent, centre + extent};
}

template <typename Use> void each_corner(const Scene& scene, const TriangleRange& triangles, Use use) {
    for (std::uint32_t i = triangles.first; i < triangles.last; ++i) {
        for (const std::uint32_t vertex : scene.triangles[i].vertex) use(scene.positions[vertex]);
    }
}

}  // namespace

TriangleRange world_triangles(const Scene& scene) {
    return {0, scene.meshes.empty() ? std::uint32_t(scene.triangles.size()) : scene.meshes.front().first_triangle};
}

TriangleRange triangles_of_mesh(const Scene& scene, std::uint32_t mesh) {
    const bool last = mesh + 1 == scene.meshes.size();
    return {scene.meshes[mesh].first_triangle,
            last ? std::uint32_t(scene.triangles.size()) : scene.meshes[mesh + 1].first_triangle};
}

std::optional<std::uint32_t> mesh_of(const Scene& scene, std::uint32_t triangle) {
    const auto next = std::ranges::upper_bound(scene.meshes, triangle, {}, &SharedMesh::first_triangle);
    if (next == scene.meshes.begin()) return std::nullopt;
    return std::uint32_t(next - scene.meshes.begin() - 1);
}

std::size_t shown_triangles(const Scene& scene) {
    std::size_t shown = world_triangles(scene).count();
    for (const Instance& instance : scene.instances) shown += triangles_of_mesh(scene, instance.mesh).count();
    return shown;
}

SceneBox SceneBox::nothing() {
    const glm::dvec3 infinity(std::numeric_limits<double>::infinity());
    return {infinity, -infinity};
}

void SceneBox::grow(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
}

void SceneBox::grow(const SceneBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
}

SceneBox box_of(const Scene& scene, const TriangleRange& triangles) {
    constexpr std::size_t least_of_a_task = 1 << 12;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::uint32_t>(triangles.first, triangles.last, least_of_a_task), SceneBox::nothing(),
        [&](const tbb::blocked_range<std::uint32_t>& range, SceneBox box) {
            each_corner(scene, {range.begin(), range.end()}, [&](const glm::dvec3& p) { box.grow(p); });
            return box;
        },
        [](SceneBox a, const SceneBox& b) {
            a.grow(b);
            return a;
        });
}

std::vector<SceneBox> cells_of(const Scene& scene, const TriangleRange& triangles) {
    const SceneBox whole = box_of(scene, triangles);
    std::vector<SceneBox> cells(cells_a_side * cells_a_side * cells_a_side, SceneBox::nothing());
    const glm::dvec3 extent = glm::max(whole.high - whole.low, glm::dvec3(1e-300));
    each_corner(scene, triangles, [&](const glm::dvec3& p) {
        const glm::ivec3 at = glm::min(glm::ivec3((p - whole.low) / extent * double(cells_a_side)), cells_a_side - 1);
        cells[std::size_t((at.x * cells_a_side + at.y) * cells_a_side + at.z)].grow(p);
    });
    std::erase_if(cells, [](const SceneBox& cell) { return cell.is_empty(); });
    return cells;
}

std::vector<SceneBox> instance_boxes(const Scene& scene) {
    std::vector<std::vector<SceneBox>> cells(scene.meshes.size());
    for (std::uint32_t mesh = 0; mesh < cells.size(); ++mesh) {
        cells[mesh] = cells_of(scene, triangles_of_mesh(scene, mesh));
    }
    std::vector<SceneBox> boxes(scene.instances.size(), SceneBox::nothing());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, boxes.size()), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const Instance& instance = scene.instances[i];
            for (const SceneBox& cell : cells[instance.mesh]) boxes[i].grow(transformed(instance.to_world, cell));
        }
    });
    return boxes;
}

SceneBox world_box(const Scene& scene) {
    SceneBox box = box_of(scene, world_triangles(scene));
    for (const SceneBox& instance : instance_boxes(scene)) box.grow(instance);
    return box;
}

bool is_shareable(const glm::dmat4& to_world) {
    // What rounding of either matrix does to a point that goes there and back, in roundings: 1 of turns and of scales
    // along the mesh's axes, more where axes that were square are no longer.
    constexpr double most = 16.0;
    // Of its axes: a mesh that is flat along one that is longer by more would leave the range of floats in the frame.
    constexpr double least_ratio = 1e-12;
    glm::dmat3 linear(to_world);
    const auto [least, size] = std::minmax({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    if (!(least > least_ratio * size)) return false;
    linear /= size;
    const glm::dmat3 back = glm::inverse(linear);
    for (int row = 0; row < 3; ++row) {
        double sum = 0.0;
        for (int column = 0; column < 3; ++column) {
            for (int k = 0; k < 3; ++k) sum += std::abs(linear[k][row] * back[column][k]);
        }
        if (!(sum <= most)) return false;
    }
    return true;
}

}  // namespace vkcppm
