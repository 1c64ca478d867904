#include "support/files/pictures.h"

#include <stdexcept>

#include <png.h>
#include <turbojpeg.h>
#include <webp/encode.h>

namespace vkcppm::test {

std::string encode_png(Extent size, const PngFormat& format, const std::vector<std::uint8_t>& rows) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);  // errors abort
    png_infop info = png_create_info_struct(png);
    std::string bytes;
    const auto write = [](png_structp writer, png_bytep data, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<char*>(data), count);
    };
    png_set_write_fn(png, &bytes, write, nullptr);
    png_set_IHDR(png, info, size.width, size.height, format.bit_depth, format.color_type,
                 format.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!format.palette.empty()) {
        std::vector<png_color> palette;
        for (std::size_t i = 0; i < format.palette.size(); i += 3) {
            palette.push_back({format.palette[i], format.palette[i + 1], format.palette[i + 2]});
        }
        png_set_PLTE(png, info, palette.data(), int(palette.size()));
    }
    if (!format.palette_alpha.empty()) {
        png_set_tRNS(png, info, format.palette_alpha.data(), int(format.palette_alpha.size()), nullptr);
    }
    if (format.transparent_gray >= 0) {
        png_color_16 color{};
        color.gray = png_uint_16(format.transparent_gray);
        png_set_tRNS(png, info, nullptr, 0, &color);
    }
    if (format.gamma > 0.0) png_set_gAMA(png, info, format.gamma);
    png_write_info(png, info);
    const std::size_t stride = rows.size() / size.height;
    std::vector<png_bytep> pointers;
    for (std::size_t y = 0; y < size.height; ++y) pointers.push_back(const_cast<png_bytep>(rows.data()) + y * stride);
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

std::string encode_png(Extent size, const std::vector<std::uint8_t>& rgba) {
    return encode_png(size, {.color_type = PNG_COLOR_TYPE_RGBA, .bit_depth = 8}, rgba);
}

std::string one_texel_png(const std::array<std::uint8_t, 4>& rgba) {
    return encode_png({1, 1}, std::vector<std::uint8_t>(rgba.begin(), rgba.end()));
}

std::string encode_jpeg(Extent size, const std::vector<std::uint8_t>& samples, bool is_gray) {
    tjhandle encoder = tjInitCompress();
    unsigned char* data = nullptr;
    unsigned long count = 0;
    const int failure =
        tjCompress2(encoder, samples.data(), int(size.width), 0, int(size.height), is_gray ? TJPF_GRAY : TJPF_RGB,
                    &data, &count, is_gray ? TJSAMP_GRAY : TJSAMP_444, 100, TJFLAG_ACCURATEDCT);
    if (failure != 0) throw std::runtime_error(tjGetErrorStr2(encoder));
    std::string bytes(reinterpret_cast<char*>(data), count);
    tjFree(data);
    tjDestroy(encoder);
    return bytes;
}

std::string encode_webp(Extent size, const std::vector<std::uint8_t>& rgba, bool is_lossless) {
    WebPConfig config;
    WebPPicture picture;
    if (!WebPConfigInit(&config) || !WebPPictureInit(&picture)) throw std::runtime_error("libwebp's version");
    config.lossless = is_lossless;
    config.exact = 1;  // colours below no alpha as well
    config.quality = 95;
    picture.use_argb = is_lossless;
    picture.width = int(size.width);
    picture.height = int(size.height);
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    const bool is_written =
        WebPPictureImportRGBA(&picture, rgba.data(), 4 * picture.width) && WebPEncode(&config, &picture);
    const std::string bytes(reinterpret_cast<const char*>(writer.mem), writer.size);
    WebPPictureFree(&picture);
    WebPMemoryWriterClear(&writer);
    if (!is_written) throw std::runtime_error("libwebp writes no such picture");
    return bytes;
}

}  // namespace vkcppm::test
