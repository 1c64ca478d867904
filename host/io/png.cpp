#include "io/png.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

#include <png.h>

#include "core/error.h"
#include "core/srgb.h"
#include "io/atomic_file.h"

namespace vkcppm {

Bitmap to_bitmap(const Image& image, double exposure) {
    const double scale = std::exp2(exposure);
    Bitmap bitmap{image.extent, {}};
    bitmap.rgb.reserve(image.rgb.size());
    for (const glm::vec3& pixel : image.rgb) {
        glm::u8vec3 encoded;
        for (int c = 0; c < 3; ++c) encoded[c] = srgb_byte(scale * double(pixel[c]));
        bitmap.rgb.push_back(encoded);
    }
    return bitmap;
}

Clipping clipping_of(const Image& image, double exposure) {
    std::vector<float> largest;
    for (const glm::vec3& pixel : image.rgb) largest.push_back(std::max({0.0f, pixel.r, pixel.g, pixel.b}));
    if (largest.empty()) return {};
    const double white = std::exp2(-exposure);
    const auto clipped = std::ranges::count_if(largest, [&](float x) { return x > white; });
    const auto rank = largest.begin() + std::ptrdiff_t(0.95 * double(largest.size() - 1));
    std::ranges::nth_element(largest, rank);
    return {double(clipped) / double(largest.size()), *rank > 0.0f ? std::floor(-10.0 * std::log2(*rank)) / 10.0 : 0.0};
}

std::string encode_png(const Bitmap& bitmap) {
    static_assert(sizeof(glm::u8vec3) == 3);
    assert(bitmap.rgb.size() == bitmap.extent.pixels());
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = bitmap.extent.width;
    png.height = bitmap.extent.height;
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&png, bytes.data(), &size, false, bitmap.rgb.data(), 0, nullptr)) {
        throw Error(ExitCode::internal, std::string("cannot encode a PNG picture: ") + png.message);
    }
    bytes.resize(size);
    return bytes;
}

void write_png(const std::filesystem::path& file, const Image& image, double exposure) {
    write_file(file, encode_png(to_bitmap(image, exposure)));
}

}  // namespace vkcppm
