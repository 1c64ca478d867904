#pragma once
// The URIs of a glTF file: data URIs, and relative paths beside the file.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace vkcppm {

/// Whether the URI carries its bytes itself ("data:...").
bool is_data_uri(std::string_view uri);

/// The bytes of a data URI of any media type, in base64 of either alphabet or percent-encoded
/// (RFC 2397); nothing where it is malformed.
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

/// The path, percent-decoded (RFC 3986), that a relative URI means from `folder` on, backslashes taken for slashes;
/// nothing where the URI has a scheme, is absolute, is empty, or holds a zero byte. Where no such file is there, but
/// one whose name is as the URI is written, it is that.
std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri);

}  // namespace vkcppm
