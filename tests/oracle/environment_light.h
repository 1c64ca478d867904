#pragma once
// The environment as a light to sample.

#include <optional>
#include <random>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace vkcppm::oracle {

/// Pixels are chosen in proportion to their solid angle and brightest channel, directions uniformly within one.
class EnvironmentLight {
public:
    /// Black where there is no environment.
    explicit EnvironmentLight(const std::optional<Environment>& environment);

    bool empty() const { return total_ == 0.0; }

    /// Radiance from a unit direction.
    glm::dvec3 radiance(const glm::dvec3& direction) const;

    /// A unit direction of density density(); not where empty().
    glm::dvec3 sample(std::mt19937_64& random) const;

    /// 1/sr.
    double density(const glm::dvec3& direction) const;

private:
    std::size_t pixel(const glm::dvec3& direction) const;

    Extent size_;
    std::vector<glm::dvec3> radiance_;  // [pixels]
    std::vector<double> cumulative_;    // [pixels] solid angle * brightest channel
    double total_ = 0.0;
};

}  // namespace vkcppm::oracle
