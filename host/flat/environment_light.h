#pragma once
// The environment as a light: an alias table over the pixels of its map.

#include <vector>

#include "flat/flat_scene.h"
#include "flat/weighed_light.h"
#include "scene/scene.h"

namespace vkcppm {

/// Fills flat.environment, its size and its alias table, where the scene has an environment, and adds it to `lights`,
/// where it is not black. The bounds and the radius must be there.
void add_environment(const Scene& scene, FlatScene& flat, std::vector<WeighedLight>& lights);

}  // namespace vkcppm
