#pragma once
// A light before all are in one table.

#include <glm/vec3.hpp>

#include "shared/types.h"

namespace vkcppm {

/// A light and what it is drawn in proportion to: the mean channel of its flux, about.
struct WeighedLight {
    gpu::Light light;  // power: flux, in frame units (W times scale^2)
    double weight = 0.0;
};

inline double mean_channel(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

}  // namespace vkcppm
