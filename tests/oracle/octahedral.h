#pragma once
// Unit vectors as 2 x 16 signed normalised bits on the octahedron, in double precision.

#include <cstdint>

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

/// The unit vector of a packed word: low half x, high half y; z < 0 is folded over the edges |x| + |y| = 1.
glm::dvec3 unpack_direction(std::uint32_t word);

}  // namespace vkcppm::oracle
