#pragma once

#include <algorithm>

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

/// The largest of the three channels.
inline double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace vkcppm::oracle
