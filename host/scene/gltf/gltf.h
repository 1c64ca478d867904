#pragma once
// glTF 2.0 (.gltf and .glb) to a Scene.

#include <filesystem>
#include <optional>
#include <string>

#include "scene/gltf/lights.h"
#include "scene/gltf/material_changes.h"
#include "scene/gltf/sharing.h"
#include "scene/scene.h"

namespace vkcppm {

/// How a file is read.
struct GltfOptions {
    std::optional<std::filesystem::path> root{};  // what the file names lies below; by default default_root()
    std::string animation{};                      // by name or index, or "all"; empty: at rest
    double at = 0.0;                              // s, of the animation
    std::string variant{};                        // KHR_materials_variants, by name or index; empty: none
    std::vector<MaterialChange> set{};            // of its materials, one after the other
    PunctualUnits punctual_units = PunctualUnits::by_generator;
    Sharing sharing = Sharing::by_cost;
};

/// Loads the default scene of a .gltf or .glb file (or its first scene; or all root nodes where it has no scene).
/// Throws Error: no_input where the file is missing or unreadable, usage where it has no such animation, variant or
/// material, bad_input where it is malformed or requires what is not there, each with object, value, limit and file.
/// What is merely odd becomes a line in Scene::warnings.
Scene load_gltf(const std::filesystem::path& file, const GltfOptions& options = {});

}  // namespace vkcppm
