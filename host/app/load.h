#pragma once
// The scene of a command line.

#include <set>
#include <string>

#include "app/options.h"
#include "scene/scene.h"

namespace vkcppm {

/// Loads the file, puts the environment round it and makes thin glass solid where that is asked for. Scene::hash covers
/// the environment too, as it is turned and scaled, and Scene::warnings ends with what diagnose() finds. Throws like
/// load_gltf and read_environment, and Error(usage) where the environment's strength leads out of floats.
Scene load_scene(const SceneOptions& options);

/// Prints the warnings of the scene but for those that were `told` of another frame, and adds them to these. Throws
/// Error(bad_input) where there are some and none is allowed.
void tell_warnings(const Scene& scene, const SceneOptions& options, std::set<std::string>& told);
void tell_warnings(const Scene& scene, const SceneOptions& options);

}  // namespace vkcppm
