#pragma once
// How likely a lamp of the light tree is, in double precision and by angles.

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "shared/types.h"

namespace vkcppm::oracle {

/// At a point, of the lamp that is that child of that branch: branch << 1 | which.
double lamp_probability(std::span<const gpu::LightBranch> tree, std::uint32_t lamp, const glm::dvec3& position);

}  // namespace vkcppm::oracle
