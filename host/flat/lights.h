#pragma once
// Where photons start: every light of a scene in one alias table, in proportion to its power.

#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "flat/flatten.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// Fills flat.lights and, where the scene has one, flat.environment and flat.environment_alias. The triangles, their
/// materials, the bounds and the radius must be there. A textured emitter is cut into parts that are drawn in
/// proportion to what they emit.
void add_lights(const Scene& scene, FlatScene& flat);

/// Of a sphere about the origin by which light from infinity enters, frame units: padded as the bounds are, 0 where all
/// corners coincide.
double bounds_radius(const FlatScene& flat);

}  // namespace vkcppm
