#pragma once
// EXT_ and KHR_meshopt_compression: the bytes of a bufferView from a fraction of them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace vkcppm {

/// The extension by which a bufferView is compressed, or a buffer is a fallback: EXT_meshopt_compression or its
/// successor, KHR_meshopt_compression; null where it has neither.
const char* meshopt_extension(const nlohmann::json& object);

/// [byteStride * count] bytes that `compressed` expands to. `view` is a bufferView (checked by the schema) with such an
/// extension, named `view_name` in messages. Throws Error(bad_input) where the sizes of the two disagree, a number does
/// not suit the mode or the filter, or the data is broken.
std::vector<std::uint8_t> decode_meshopt(const nlohmann::json& view, std::span<const std::uint8_t> compressed,
                                         const std::string& view_name, const std::string& file);

}  // namespace vkcppm
