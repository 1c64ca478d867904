#pragma once
// Scenes by name.

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/gltf.h"
#include "support/files/places.h"

namespace vkcppm::test {

/// A scene of the project: scenes/<name>.gltf.
inline Scene project_scene(const std::string& name) { return load_gltf(source_folder() / "scenes" / (name + ".gltf")); }

/// Why a test is skipped that goes over files which the project does not have: tests/README.md says which.
inline constexpr const char* no_collections = "the collections of tests/README.md do not stand beside the project";

/// A file or folder of those collections; none where it is not there.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
    const auto file = source_folder() / ".." / "shared" / "scenes" / name;
    return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

/// Every .gltf and .glb below a folder, sorted.
inline std::vector<std::filesystem::path> gltf_files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace vkcppm::test
