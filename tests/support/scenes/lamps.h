#pragma once
// Rooms of many lamps.

#include <cstdint>

#include "scene/scene.h"

namespace vkcppm::test {

/// Lamps of every kind at random places in [-1, 1]^3 m: triangles, squares, those that shine on both sides, points,
/// spots, some with a range. Their powers are 10 to the power of a number in [-decades, decades].
Scene lamps_of_every_kind(std::uint32_t count, double decades, std::uint32_t seed);

/// A closed diffuse room of 4 m x 2 m x 2 m with a box on its floor and `count` square lamps of 6 cm below the ceiling,
/// at random places; every third has a hundred times the radiance of the others. One camera.
Scene many_lamp_room(std::uint32_t count);

/// Nine square lamps of 40 cm over a sheet of metal of that roughness, which alone the camera sees: asking for a lamp
/// and following the metal's lobe find about as much.
Scene lamps_over_metal(float roughness);

}  // namespace vkcppm::test
