#pragma once
// The bounds of a scene, through which light from infinity enters it.

#include <glm/vec3.hpp>

#include "flat/flat_scene.h"

namespace vkcppm {

/// Frame units by which the box of the scene is larger than what it holds, on each side.
inline constexpr double bounds_padding = 1e-5;

/// Of a sphere about the origin by which light from infinity enters, frame units: it holds the corners of the padded
/// box, 0 where all corners of triangles coincide.
double bounds_radius(const FlatScene& flat);

/// Areas of the faces of the box across x, y and z: those of a flat scene are not 0, as the box is padded.
glm::dvec3 face_areas(const FlatScene& flat);

/// The area by which parallel light enters where the box shows that much of itself: entry_area of the kernels.
double entry_area(const FlatScene& flat, double box);

}  // namespace vkcppm
