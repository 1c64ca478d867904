#include "flat/bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vkcppm {

double bounds_radius(const FlatScene& flat) { return flat.radius > 0.0 ? flat.radius + 2.0 * bounds_padding : 0.0; }

glm::dvec3 face_areas(const FlatScene& flat) {
    const glm::dvec3 extent = glm::dvec3(flat.high) - glm::dvec3(flat.low);
    return {extent.y * extent.z, extent.z * extent.x, extent.x * extent.y};
}

double entry_area(const FlatScene& flat, double box) {
    return std::min(box, std::numbers::pi * std::pow(bounds_radius(flat), 2));
}

}  // namespace vkcppm
