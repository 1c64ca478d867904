#pragma once
// The bytes that a scene file names by URI, and the hash that tells one set of bytes from another.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkcppm {

using Bytes = std::vector<std::uint8_t>;

/// The first `limit` bytes of a regular file, or all; nothing, and why, where it fails. A pipe or a device could block.
std::optional<Bytes> read_bytes(const std::filesystem::path& path, std::size_t limit, std::string& why);

/// The folder below which a scene's files may lie where none is given: the scene's own, for a stranger's scene is not
/// to show what lies beside it. `file` exists.
std::filesystem::path default_root(const std::filesystem::path& file);

/// The bytes of a data URI, or the first `limit` of the file that a relative URI means from the folder of `file` on,
/// which go into `hash` as well; nothing, and why, where there is no such file or it lies outside of `root`, a
/// canonical folder, be it by a link. `object` has the URI, for messages. Throws Error(bad_input) where a data URI is
/// malformed.
std::optional<Bytes> read_uri(const std::string& uri, std::size_t limit, const std::string& object,
                              const std::string& file, const std::filesystem::path& root, std::uint64_t& hash,
                              std::string& why);

}  // namespace vkcppm
