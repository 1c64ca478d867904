#pragma once
// The emissive triangles of a scene as one light to sample.

#include <cstdint>
#include <random>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm::oracle {

/// Triangles are chosen in proportion to area and brightest channel of the emission, without its texture.
class AreaLights {
public:
    /// Keeps a reference to `scene`, which has to outlive it.
    explicit AreaLights(const Scene& scene);

    bool empty() const { return triangles_.empty(); }

    struct Point {
        std::uint32_t triangle;
        glm::dvec3 barycentric;
        glm::dvec3 position;  // m
    };
    Point sample(std::mt19937_64& random) const;

    /// Probability density of sample(), 1/m^2, on a triangle.
    double density(std::uint32_t triangle) const;

private:
    const Scene& scene_;
    std::vector<std::uint32_t> triangles_;
    std::vector<double> cumulative_;
    double total_ = 0.0;
};

}  // namespace vkcppm::oracle
