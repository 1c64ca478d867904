#pragma once
// Radiance pictures (.hdr): three mantissas and an exponent a pixel.

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/image.h"

namespace vkcppm {

/// The picture in the bytes of a Radiance file: 32-bit_rle_rgbe, rows from the top and columns from the left (-Y +X),
/// flat or in either run-length encoding. Values are divided by every EXPOSURE and COLORCORR of the header, which gives
/// W m^-2 sr^-1 (Ward, "Radiance File Formats"). `file` is named in errors.
/// Throws Error(bad_input) where it is not such a picture, is cut short, or has more than `most_pixels` pixels.
Image decode_hdr(std::span<const std::uint8_t> bytes, const std::filesystem::path& file, std::size_t most_pixels);

}  // namespace vkcppm
