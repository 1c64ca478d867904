#include "scene/gltf/picture.h"

#include <array>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include "core/sixteen_bits.h"

namespace vkcppm {

namespace {

using Encoded = std::span<const std::uint8_t>;

bool starts_with(Encoded bytes, std::string_view signature) {
    return bytes.size() >= signature.size() && std::memcmp(bytes.data(), signature.data(), signature.size()) == 0;
}

bool is_png(Encoded bytes) { return starts_with(bytes, "\x89PNG\r\n\x1a\n"); }
bool is_jpeg(Encoded bytes) { return starts_with(bytes, "\xff\xd8\xff"); }

[[noreturn]] void refuse_format() { throw std::runtime_error("neither PNG, JPEG nor WebP"); }

/// libpng's state, which goes with its owner even where that one's constructor throws.
struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    PngState() = default;
    PngState(const PngState&) = delete;
    PngState& operator=(const PngState&) = delete;
    ~PngState() { png_destroy_read_struct(&png, &info, nullptr); }
};

/// libpng over bytes in memory. Its errors are long jumps: they cross no frame but libpng's and guarded()'s, and none
/// of them holds anything to destroy.
class PngReader {
public:
    explicit PngReader(Encoded bytes) : rest_(bytes) {
        state_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        state_.info = state_.png ? png_create_info_struct(state_.png) : nullptr;
        if (!state_.info) throw std::bad_alloc();
        png_set_read_fn(state_.png, this, on_read);
        guarded([](PngReader& reader) { png_read_info(reader.state_.png, reader.state_.info); });
    }

    Extent size() const {
        return {png_get_image_width(state_.png, state_.info), png_get_image_height(state_.png, state_.info)};
    }

    bool has_16_bits() const { return png_get_bit_depth(state_.png, state_.info) == 16; }

    Picture picture() {
        const bool is_fine = has_16_bits();
        std::vector<std::uint8_t> bytes = texels(is_fine ? 8 : 4);
        return is_fine ? split(bytes) : Picture{std::move(bytes), {}, {}};
    }

private:
    /// As in the file, 4 numbers a texel of so many bytes.
    std::vector<std::uint8_t> texels(std::size_t texel_bytes) {
        guarded([](PngReader& reader) {
            png_set_expand(reader.state_.png);
            png_set_gray_to_rgb(reader.state_.png);
            png_set_add_alpha(reader.state_.png, reader.has_16_bits() ? 0xffff : 0xff, PNG_FILLER_AFTER);
            png_set_interlace_handling(reader.state_.png);
            png_read_update_info(reader.state_.png, reader.state_.info);
        });
        const std::size_t stride = texel_bytes * size().width;
        std::vector<std::uint8_t> texels(stride * size().height);
        rows_.resize(size().height);
        for (std::size_t y = 0; y < rows_.size(); ++y) rows_[y] = texels.data() + y * stride;
        guarded([](PngReader& reader) { png_read_image(reader.state_.png, reader.rows_.data()); });
        return texels;
    }

    /// Of numbers of two bytes, the higher one first.
    static Picture split(const std::vector<std::uint8_t>& numbers) {
        Picture picture{
            std::vector<std::uint8_t>(numbers.size() / 2), std::vector<std::int8_t>(numbers.size() / 2), {}};
        bool is_exact = true;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
            const auto [byte, rest] = split_16_bits(256u * numbers[2 * i] + numbers[2 * i + 1]);
            picture.rgba[i] = byte;
            picture.rest[i] = rest;
            is_exact = is_exact && rest == 0;
        }
        if (is_exact) picture.rest = {};
        return picture;
    }

    void guarded(void (*step)(PngReader&)) {
        if (!completes(step)) throw std::runtime_error(fmt::format("broken PNG: {}", message_.data()));
    }

    bool completes(void (*step)(PngReader&)) {
        if (setjmp(png_jmpbuf(state_.png))) return false;
        step(*this);
        return true;
    }

    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
        std::strncpy(reader.message_.data(), message, reader.message_.size() - 1);
        png_longjmp(png, 1);
    }

    static void on_warning(png_structp, png_const_charp) {}  // of chunks that mean nothing here

    static void on_read(png_structp png, png_bytep out, std::size_t size) {
        auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
        if (size > reader.rest_.size()) png_error(png, "the data ends early");
        std::memcpy(out, reader.rest_.data(), size);
        reader.rest_ = reader.rest_.subspan(size);
    }

    Encoded rest_;
    PngState state_;
    std::vector<png_bytep> rows_;
    std::array<char, 200> message_{};
};

class JpegReader {
public:
    explicit JpegReader(Encoded bytes) : bytes_(bytes), decoder_(tjInitDecompress(), tjDestroy) {
        if (!decoder_) throw std::bad_alloc();
        int subsampling, color_space;
        check(tjDecompressHeader3(decoder_.get(), bytes_.data(), bytes_.size(), &width_, &height_, &subsampling,
                                  &color_space));
        if (width_ <= 0 || height_ <= 0) {
            throw std::runtime_error("broken JPEG: its header has no picture");  // tables alone
        }
        if (color_space == TJCS_CMYK || color_space == TJCS_YCCK) {
            throw std::runtime_error("a JPEG of four inks (CMYK) has no colours that glTF defines");
        }
    }

    Extent size() const { return {std::uint32_t(width_), std::uint32_t(height_)}; }

    Picture picture() {
        Picture picture{std::vector<std::uint8_t>(4 * size().pixels()), {}, {}};
        // A small file may hold endless passes over the picture: the flag ends them at 500.
        const int result = tjDecompress2(decoder_.get(), bytes_.data(), bytes_.size(), picture.rgba.data(), width_,
                                         4 * width_, height_, TJPF_RGBA, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS);
        // Of all warnings that of bytes too many alone is not about data that is missing or wrong.
        if (result != 0 && message().find("extraneous bytes before marker") != std::string::npos) {
            picture.flaw = message();
        } else {
            check(result);
        }
        return picture;
    }

private:
    void check(int result) {
        if (result != 0) throw std::runtime_error(fmt::format("broken JPEG: {}", message()));
    }

    std::string message() { return tjGetErrorStr2(decoder_.get()); }

    Encoded bytes_;
    std::unique_ptr<void, int (*)(tjhandle)> decoder_;
    int width_ = 0, height_ = 0;
};

class WebpReader {
public:
    explicit WebpReader(Encoded bytes) : bytes_(bytes) {
        check(WebPGetFeatures(bytes_.data(), bytes_.size(), &features_));
        if (features_.has_animation) throw std::runtime_error("a WebP that moves is no texture");
    }

    Extent size() const { return {std::uint32_t(features_.width), std::uint32_t(features_.height)}; }

    std::vector<std::uint8_t> rgba() {
        std::vector<std::uint8_t> texels(4 * size().pixels());
        WebPDecoderConfig config;
        if (!WebPInitDecoderConfig(&config)) throw std::runtime_error("libwebp is of another version");
        config.output.colorspace = MODE_RGBA;
        config.output.is_external_memory = 1;
        config.output.u.RGBA = {texels.data(), 4 * features_.width, texels.size()};
        check(WebPDecode(bytes_.data(), bytes_.size(), &config));
        return texels;
    }

private:
    /// That memory is out libwebp 1.5 says of wrong data too; the texels, which take the most of it, are ours.
    void check(VP8StatusCode status) {
        if (status == VP8_STATUS_OK) return;
        const bool ends_early = status == VP8_STATUS_NOT_ENOUGH_DATA || status == VP8_STATUS_SUSPENDED;
        throw std::runtime_error(fmt::format("broken WebP: {}", ends_early ? "the data ends early" : "wrong data"));
    }

    Encoded bytes_;
    WebPBitstreamFeatures features_{};
};

}  // namespace

bool is_webp(Encoded bytes) {
    return starts_with(bytes, "RIFF") && bytes.size() >= 12 && starts_with(bytes.subspan(8), "WEBP");
}

std::string_view foreign_format(Encoded bytes) {
    struct Format {
        std::size_t offset;
        std::string_view signature, name;
    };
    using namespace std::string_view_literals;
    static constexpr Format formats[] = {
        {0, "\xabKTX 20\xbb", "KTX2"}, {0, "\xabKTX 11\xbb", "KTX"}, {0, "DDS ", "DDS"},
        {4, "ftypavif", "AVIF"},       {0, "GIF8", "GIF"},           {0, "BM", "BMP"},
        {0, "II*\0"sv, "TIFF"},        {0, "MM\0*"sv, "TIFF"},       {0, "v/1\1", "OpenEXR"},
        {0, "#?", "Radiance"},         {0, "\xff\x0a", "JPEG XL"},   {4, "JXL ", "JPEG XL"},
    };
    for (const Format& format : formats) {
        if (bytes.size() >= format.offset && starts_with(bytes.subspan(format.offset), format.signature)) {
            return format.name;
        }
    }
    return {};
}

Extent picture_size(Encoded bytes) {
    if (is_png(bytes)) return PngReader(bytes).size();
    if (is_jpeg(bytes)) return JpegReader(bytes).size();
    if (is_webp(bytes)) return WebpReader(bytes).size();
    refuse_format();
}

bool has_16_bits(Encoded bytes) { return is_png(bytes) && PngReader(bytes).has_16_bits(); }

Picture decode_picture(Encoded bytes) {
    if (is_png(bytes)) return PngReader(bytes).picture();
    if (is_jpeg(bytes)) return JpegReader(bytes).picture();
    if (is_webp(bytes)) return {WebpReader(bytes).rgba(), {}, {}};
    refuse_format();
}

}  // namespace vkcppm
