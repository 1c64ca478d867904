#include "io/png.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <csetjmp>
#include <new>
#include <string>
#include <vector>

#include <png.h>

#include "core/error.h"
#include "core/srgb.h"
#include "io/atomic_file.h"

namespace vkcppm {

Bitmap to_bitmap(const Image& image, const Display& display) {
    Bitmap bitmap{image.extent, {}};
    bitmap.rgb.reserve(image.rgb.size());
    for (const glm::vec3& pixel : image.rgb) {
        const glm::dvec3 linear = shown(pixel, display);
        bitmap.rgb.emplace_back(srgb_byte(linear.r), srgb_byte(linear.g), srgb_byte(linear.b));
    }
    return bitmap;
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

namespace {

/// No exception may pass through libpng, which is C.
void append(png_structp writer, png_bytep bytes, std::size_t count) {
    bool failed = false;
    try {
        static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(bytes), count);
    } catch (const std::bad_alloc&) {
        failed = true;
    }
    if (failed) png_error(writer, "out of memory");
}

void flush(png_structp) {}

/// The file of rows of 16-bit sRGB numbers, their first byte the higher. libpng's simplified interface, as above, would
/// take 16-bit numbers for linear light. False where libpng fails; nothing here has a destructor that its jump could
/// leave out.
bool encode_rows(std::string& file, std::vector<png_bytep>& rows, Extent extent) {
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = writer ? png_create_info_struct(writer) : nullptr;
    if (!info || setjmp(png_jmpbuf(writer))) {
        png_destroy_write_struct(&writer, &info);
        return false;
    }
    png_set_write_fn(writer, &file, append, flush);
    png_set_IHDR(writer, info, extent.width, extent.height, 16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(writer, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_rows(writer, info, rows.data());
    png_write_png(writer, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&writer, &info);
    return true;
}

std::string encode_sixteen(const Image& image, const Display& display) {
    std::vector<png_byte> bytes;
    bytes.reserve(6 * image.rgb.size());
    for (const glm::vec3& pixel : image.rgb) {
        const glm::dvec3 linear = shown(pixel, display);
        for (int c = 0; c < 3; ++c) {
            const auto number = std::lround(65535.0 * srgb_encode(std::clamp(linear[c], 0.0, 1.0)));
            bytes.push_back(png_byte(number >> 8));
            bytes.push_back(png_byte(number & 255));
        }
    }
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < image.extent.height; ++y) rows.push_back(bytes.data() + 6 * y * image.extent.width);
    std::string file;
    if (!encode_rows(file, rows, image.extent)) throw Error(ExitCode::internal, "cannot encode a PNG picture");
    return file;
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image, const Display& display, PngDepth depth) {
    write_file(file,
               depth == PngDepth::sixteen ? encode_sixteen(image, display) : encode_png(to_bitmap(image, display)));
}

}  // namespace vkcppm
