#pragma once
// The one form of every complaint about a scene file.

#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace vkcppm {

/// Throws Error(bad_input) "<file>: <object> is <value>; <limit>", e.g. "a.gltf: nodes[3].mesh is 7; meshes has 2".
[[noreturn]] inline void bad_scene(std::string_view file, std::string_view object, std::string_view value,
                                   std::string_view limit) {
    throw Error(ExitCode::bad_input, fmt::format("{}: {} is {}; {}", file, object, value, limit));
}

}  // namespace vkcppm
