#pragma once
// From a Scene to what the kernels read.

#include "flat/flat_scene.h"
#include "scene/scene.h"

namespace vkcppm {

/// Throws Error(bad_input) where a count is beyond what the kernels can index.
FlatScene flatten(const Scene& scene);

}  // namespace vkcppm
