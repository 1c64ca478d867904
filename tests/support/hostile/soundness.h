#pragma once
// Whether a scene holds what Scene promises.

#include <string>

#include "scene/scene.h"

namespace vkcppm::test {

/// The first thing in `scene` that is not what host/scene/scene.h says; empty where all is.
std::string unsoundness(const Scene& scene);

}  // namespace vkcppm::test
