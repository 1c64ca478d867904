#pragma once
// PNG files: a picture for the eye.

#include <filesystem>
#include <string>

#include "core/image.h"

namespace vkcppm {

/// `image` times 2^exposure, clamped to [0, 1] and encoded as 8-bit sRGB; NaN becomes black. exposure: stops.
Bitmap to_bitmap(const Image& image, double exposure = 0.0);

/// How many pixels of a picture have a channel above 1 at an exposure, in stops, and at which exposure a twentieth of
/// them would.
struct Clipping {
    double share = 0.0;
    double exposure = 0.0;  // stops, rounded down to tenths
};
Clipping clipping_of(const Image& image, double exposure);

/// The bytes of a PNG file.
std::string encode_png(const Bitmap& bitmap);

/// Writes to_bitmap(image, exposure). The file is written whole or not at all (write_file). Throws Error(cannot_write).
void write_png(const std::filesystem::path& file, const Image& image, double exposure = 0.0);

}  // namespace vkcppm
