#pragma once
// Pictures in PNG, JPEG and WebP files, as textures hold them: bytes in, 8 bits a channel out, and what is beyond them.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Whether the bytes begin like a WebP: one of a single colour takes as many as it likes to have texels.
bool is_webp(std::span<const std::uint8_t> bytes);

/// The name of the format where it is a known one that this program lacks, else empty.
std::string_view foreign_format(std::span<const std::uint8_t> bytes);

/// Width and height by the header alone, before memory for the texels is needed.
/// Throws std::runtime_error with the reason where the bytes are none of the three or the header is broken.
Extent picture_size(std::span<const std::uint8_t> bytes);

/// Whether a channel has 16 bits, by the header alone.
bool has_16_bits(std::span<const std::uint8_t> bytes);

/// [4 x width x height] red, green, blue, alpha; first row on top. Grey, palettes and a transparent colour are
/// expanded, alpha is 255 where there is none. The values are as in the file: gamma, colour profiles and orientation
/// are ignored, as glTF 2.0, section 3.8.3, asks.
struct Picture {
    std::vector<std::uint8_t> rgba;  // 16 bits are rounded to 8
    std::vector<std::int8_t> rest;   // what 16 bits have beyond that (core/sixteen_bits.h); empty: nothing
    std::string flaw;                // what is odd about a file all of whose texels are there
};

/// Throws std::runtime_error with the reason where the file is broken, even in part.
Picture decode_picture(std::span<const std::uint8_t> bytes);

}  // namespace vkcppm
