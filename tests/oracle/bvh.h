#pragma once
// A binary tree by the surface area heuristic: enough to make the path tracer bearable.

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "oracle/intersect.h"

namespace vkcppm::oracle {

class Bvh {
public:
    /// Keeps a reference to `scene`, which has to outlive it.
    explicit Bvh(const Scene& scene);

    /// As nearest_hit(scene, ray); where two triangles share the smallest t, either of them.
    std::optional<Hit> nearest(const Ray& ray) const;

    /// Whether anything lies inside (t_min, t_max).
    bool occluded(const Ray& ray) const;

private:
    struct Node {
        glm::dvec3 low, high;
        std::uint32_t first = 0, count = 0;  // leaf: range of order_; inner (count 0): first is the right child
    };
    std::uint32_t build(std::uint32_t first, std::uint32_t count, std::uint32_t depth);
    std::optional<Hit> walk(Ray ray, bool any) const;

    const Scene& scene_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace vkcppm::oracle
