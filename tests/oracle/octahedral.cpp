#include "oracle/octahedral.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace vkcppm::oracle {

glm::dvec3 unpack_direction(std::uint32_t word) {
    const double x = std::int16_t(word & 0xffffu) / 32767.0, y = std::int16_t(word >> 16) / 32767.0;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    if (z >= 0.0) return glm::normalize(glm::dvec3(x, y, z));
    // The lower half was reflected in the line |x| + |y| = 1 of its own quadrant.
    return glm::normalize(glm::dvec3(std::copysign(1.0 - std::abs(y), x), std::copysign(1.0 - std::abs(x), y), z));
}

}  // namespace vkcppm::oracle
