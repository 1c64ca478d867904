#pragma once
// EXT_meshopt_compression: the bytes of a bufferView from a fraction of them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace vkcppm {

/// [byteStride * count] bytes that `compressed` expands to. `extension` is the bufferView's (checked by the schema),
/// named `object` in messages; `size` the view's byteLength, which the result must have. Throws Error(bad_scene) where
/// the two disagree, a number does not suit the mode or the filter, or the data is broken.
std::vector<std::uint8_t> decode_meshopt(const nlohmann::json& extension, std::span<const std::uint8_t> compressed,
                                         std::size_t size, const std::string& object, const std::string& file);

}  // namespace vkcppm
