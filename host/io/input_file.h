#pragma once
// Files that are read.

#include <filesystem>

namespace vkcppm {

/// Throws Error(no_input) where there is no such file, or where it is none, such as a folder.
void require_file(const std::filesystem::path& file);

}  // namespace vkcppm
