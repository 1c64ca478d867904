#pragma once
// Scenes by name.

#include <filesystem>
#include <optional>
#include <string>

#include "scene/gltf.h"

namespace vkcppm::test {

/// A scene of the project: scenes/<name>.gltf.
inline Scene project_scene(const std::string& name) {
    return load_gltf(std::filesystem::path(VKCPPM_SOURCE_DIR) / "scenes" / (name + ".gltf"));
}

/// A file among the scenes and references that stand beside the project; none where they are not there.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
    const auto file = std::filesystem::path(VKCPPM_SOURCE_DIR) / ".." / "shared" / "scenes" / name;
    return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

}  // namespace vkcppm::test
