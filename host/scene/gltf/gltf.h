#pragma once
// glTF 2.0 (.gltf and .glb) to a Scene.

#include <filesystem>

#include "scene/gltf/sharing.h"
#include "scene/scene.h"

namespace vkcppm {

/// Loads the default scene of a .gltf or .glb file (or its first scene; or all root nodes where it has no scene).
/// Throws Error: no_input where the file is missing or unreadable, bad_scene where it is malformed or requires what
/// is not there, each with object, value, limit and file. What is merely odd becomes a line in Scene::warnings.
Scene load_gltf(const std::filesystem::path& file, Sharing sharing = Sharing::by_cost);

}  // namespace vkcppm
