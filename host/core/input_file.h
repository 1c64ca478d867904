#pragma once
// Files that are read.

#include <filesystem>
#include <optional>
#include <string>

namespace vkcppm {

/// Why a file cannot be read, such as "no such file" or "it is a folder"; absent where it can. Nothing but a regular
/// file is read: to open a named pipe would wait for its writer.
std::optional<std::string> why_unreadable(const std::filesystem::path& file);

/// Throws Error(no_input) where a file cannot be read.
void require_file(const std::filesystem::path& file);

}  // namespace vkcppm
