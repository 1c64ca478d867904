#pragma once
// A four-wide BVH over triangles, quantised to 64 bytes a node, for shaders/include/traverse.glsl.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "shared/types.h"

namespace vkcppm {

struct Bvh {
    std::vector<gpu::BvhNode> nodes;   // root first, a node before those below it
    std::vector<std::uint32_t> order;  // [triangles] leaf order: position -> index of the input
    std::uint32_t stack = 1;           // nodes, at most, of which children can wait while one is traversed
};

/// Builds a binary tree by binned surface area heuristic (Wald 2007), all cores, the same tree on any number of
/// threads; then cuts it at the least cost by the same heuristic into four-wide nodes and leaves (Ylitie, Karras and
/// Laine 2017) and quantises boxes outwards. triangles [T][3]: corners in the scene frame, finite, coordinates within
/// [-1, 1]. O(T log T). T may be 0: one node without children.
Bvh build_bvh(std::span<const std::array<glm::vec3, 3>> triangles);

/// A child of a node, as the kernels find it: a node where `node` is not 0, a leaf where `count` is not 0, or none.
struct BvhChild {
    std::uint32_t node = 0;
    std::uint32_t first = 0;  // triangle
    std::uint32_t count = 0;
};
BvhChild child_of(const Bvh& bvh, std::uint32_t index, int c);

/// Box of child `c` of a node, as the kernels decode it.
struct BvhBox {
    glm::vec3 low{0.0f};
    glm::vec3 high{0.0f};
};
BvhBox child_box(const gpu::BvhNode& node, int c);

}  // namespace vkcppm
