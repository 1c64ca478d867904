#pragma once
// PNG, JPEG and WebP files for tests, made by the libraries' own writers.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"

namespace vkcppm::test {

/// How libpng stores the samples: its names of colour types, with a palette and transparency where they are given.
struct PngFormat {
    int color_type;  // PNG_COLOR_TYPE_...
    int bit_depth;   // 1, 2, 4, 8 or 16
    bool interlaced = false;
    std::vector<std::uint8_t> palette = {};        // [3 x entries]
    std::vector<std::uint8_t> palette_alpha = {};  // [entries or fewer]
    int transparent_gray = -1;                     // the sample that is transparent
    double gamma = 0.0;                            // gAMA chunk
};

/// `rows`: packed samples as in the file, 16 bits big-endian, first row on top.
std::string encode_png(Extent size, const PngFormat& format, const std::vector<std::uint8_t>& rows);

/// 8-bit RGBA.
std::string encode_png(Extent size, const std::vector<std::uint8_t>& rgba);

/// A picture of one texel.
std::string one_texel_png(const std::array<std::uint8_t, 4>& rgba);

/// `samples`: 3 a pixel, or 1 where `is_gray`. Quality 100, without chroma subsampling.
std::string encode_jpeg(Extent size, const std::vector<std::uint8_t>& samples, bool is_gray = false);

/// 8-bit RGBA; the same texels again where it is lossless.
std::string encode_webp(Extent size, const std::vector<std::uint8_t>& rgba, bool is_lossless = true);

}  // namespace vkcppm::test
