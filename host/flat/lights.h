#pragma once
// Where photons start: every light of a scene in one alias table, in proportion to its power.

#include "flat/flat_scene.h"
#include "scene/scene.h"

namespace vkcppm {

/// Fills flat.lights and, where the scene has one, flat.environment and flat.environment_alias. The triangles, their
/// materials, the bounds and the radius must be there. A textured emitter is cut into parts that are drawn in
/// proportion to what they emit. Then lights as they are asked for: flat.asked, flat.asked_lights and, of local ones
/// that are more than one lamp, flat.light_tree and flat.lamps.
void add_lights(const Scene& scene, FlatScene& flat);

}  // namespace vkcppm
