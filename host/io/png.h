#pragma once
// PNG files: a picture for the eye.

#include <filesystem>
#include <string>

#include "core/display.h"
#include "core/image.h"

namespace vkcppm {

/// Bits of a number.
enum class PngDepth { eight, sixteen };

/// `image` as shown(), clamped to [0, 1] and encoded as 8-bit sRGB; NaN becomes black.
Bitmap to_bitmap(const Image& image, const Display& display = {});

/// The bytes of a PNG file.
std::string encode_png(const Bitmap& bitmap);

/// Writes the image as shown(), as to_bitmap does or by 16 bits. The file is written whole or not at all (write_file).
/// Throws Error(cannot_write).
void write_png(const std::filesystem::path& file, const Image& image, const Display& display = {},
               PngDepth depth = PngDepth::eight);

}  // namespace vkcppm
