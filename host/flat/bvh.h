#pragma once
// A four-wide BVH over triangles and instances of meshes, quantised to 64 bytes a node, for
// shaders/include/traverse.glsl.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "shared/types.h"

namespace vkcppm {

struct Bvh {
    std::vector<gpu::BvhNode> nodes;            // root first, a node before those below it
    std::vector<std::uint32_t> order;           // [triangles] leaf order: position -> index of the input
    std::uint32_t stack = 1;                    // nodes, at most, of which children can wait while one is traversed
    std::vector<std::uint32_t> instance_nodes;  // [instances] the InstanceNode of each
};

struct BvhBox {
    glm::vec3 low{0.0f};
    glm::vec3 high{0.0f};
};

/// By which boxes grow for the rounding error of the slab test: a few ulp of coordinates within [-1, 1].
inline constexpr float bvh_padding = 1e-6f;

/// Builds a binary tree by binned surface area heuristic (Wald 2007), all cores, the same tree on any number of
/// threads; then cuts it at the least cost by the same heuristic into four-wide nodes and leaves (Ylitie, Karras and
/// Laine 2017) and quantises boxes outwards. triangles [T][3]: corners in the scene frame, finite, coordinates within
/// [-1, 1]. instances: the boxes of instances, of which each is a child of its own; of their nodes only the index is
/// set. padding: at least bvh_padding. O(n log n) of both. There may be none of either: one node without children.
Bvh build_bvh(std::span<const std::array<glm::vec3, 3>> triangles, std::span<const BvhBox> instances = {},
              float padding = bvh_padding);

/// Adds the tree of a mesh, whose triangles come `first_triangle` after the first of all; returns its root. The stack
/// is left to the caller.
std::uint32_t append_tree(Bvh& bvh, const Bvh& mesh, std::uint32_t first_triangle);

/// A child of a node, as the kernels find it: a node where `node` is not 0, a leaf where `count` is not 0, or none.
struct BvhChild {
    std::uint32_t node = 0;
    std::uint32_t first = 0;  // triangle
    std::uint32_t count = 0;
};
BvhChild child_of(const Bvh& bvh, std::uint32_t index, int c);

/// Box of child `c` of a node, as the kernels decode it.
BvhBox child_box(const gpu::BvhNode& node, int c);

}  // namespace vkcppm
