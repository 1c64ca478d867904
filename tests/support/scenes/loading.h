#pragma once
// glTF text to a scene, and what the loader said about it.

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/gltf/gltf.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

inline Scene load_text(const std::string& text) {
    const TemporaryFolder folder;
    write_bytes(folder / "scene.gltf", text);
    return load_gltf(folder / "scene.gltf");
}

inline Scene load(const GltfBuilder& builder) { return load_text(builder.gltf()); }

/// How many warnings hold all of the parts.
inline int warnings_with(const Scene& scene, const std::vector<std::string>& parts) {
    return int(std::ranges::count_if(scene.warnings, [&](const std::string& line) {
        return std::ranges::all_of(parts, [&](const std::string& part) { return line.find(part) != line.npos; });
    }));
}

inline std::string all_warnings(const Scene& scene) { return fmt::format("{}", fmt::join(scene.warnings, "\n")); }

#define EXPECT_ONE_WARNING(scene, ...)                                                       \
    EXPECT_EQ(vkcppm::test::warnings_with(scene, {__VA_ARGS__}), 1) << "the warnings are:\n" \
                                                                    << vkcppm::test::all_warnings(scene)

/// Loads `bytes` as <folder>/hostile.gltf: it must give an Error of one line that holds the file and all parts.
void expect_bad_scene(const std::string& bytes, const std::vector<std::string>& parts);

}  // namespace vkcppm::test
