#pragma once
// What KHR_meshopt_compression has beyond EXT_meshopt_compression: version 1 of the codec of attributes, and the filter
// COLOR. The library of the systems that this program is built on knows neither.

#include <cstddef>
#include <cstdint>
#include <span>

namespace vkcppm {

/// Whether `encoded` begins like version 1 of the codec of attributes.
bool is_meshopt_v1(std::span<const std::uint8_t> encoded);

/// Decodes `encoded` into `elements` of `stride` bytes, a multiple of 4 up to 256, that fill it
/// (KHR_meshopt_compression, appendix A, mode 0). False where the stream is none, is too short or is longer than it
/// says; what is written then means nothing.
bool decode_meshopt_v1(std::span<const std::uint8_t> encoded, std::size_t stride, std::span<std::uint8_t> elements);

/// Turns elements of four components of 8 or 16 bits, luma, chroma and alpha, into red, green, blue and alpha in place
/// (appendix B, filter 4). stride: 4 or 8 bytes.
void decode_meshopt_colors(std::span<std::uint8_t> elements, std::size_t stride);

}  // namespace vkcppm
