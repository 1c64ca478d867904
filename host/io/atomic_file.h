#pragma once
// Files that are written whole or not at all.

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace vkcppm {

/// Whether the name means standard output, "-" or "/dev/stdout": it is then written to as it is, neither whole nor
/// replaced.
bool is_standard_output(const std::filesystem::path& file);

/// Writes `bytes` to a temporary file in the same folder and renames it to `file`, so that `file` holds either what it
/// held before or all of `bytes`. A symbolic link stays a link: what it points to is replaced, and keeps who may read
/// and write it. Bytes for a device such as /dev/null, or for a named pipe, are written to it as they are.
/// Throws Error(cannot_write) with the file and the reason, after removing the temporary file.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The same of several parts, one after another.
void write_file(const std::filesystem::path& file, std::initializer_list<std::string_view> parts);

/// Throws Error(cannot_write) where write_file would fail for want of a folder or of permission. Leaves no trace.
void check_writable(const std::filesystem::path& file);

}  // namespace vkcppm
