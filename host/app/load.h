#pragma once
// The scene of a command line.

#include "app/options.h"
#include "scene/scene.h"

namespace vkcppm {

/// Loads the file, puts the environment round it and makes thin glass solid where that is asked for. Scene::hash covers
/// the environment too, and Scene::warnings ends with what diagnose() finds. Throws like load_gltf and
/// read_environment.
Scene load_scene(const SceneOptions& options);

}  // namespace vkcppm
