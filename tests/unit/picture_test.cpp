// PNG, JPEG and WebP files to texels: every layout of the formats, and what is broken.

#include "scene/gltf/picture.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <png.h>

#include "support/files/pictures.h"

namespace vkcppm {
namespace {

using Texels = std::vector<std::uint8_t>;
using test::PngFormat;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Texels texels_of(const std::string& file) {
    Picture picture = decode_picture(bytes_of(file));
    EXPECT_EQ(picture.flaw, "");
    return picture.rgba;
}

/// Why a file is refused; empty where it is not.
std::string refusal(const std::string& file) {
    try {
        texels_of(file);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

TEST(Picture, ReadsEveryLayoutOfPng) {
    const Extent two = {2, 1};
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_RGBA, 8}, {1, 2, 3, 4, 5, 6, 7, 8})),
              (Texels{1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_RGB, 8}, {1, 2, 3, 4, 5, 6})),
              (Texels{1, 2, 3, 255, 4, 5, 6, 255}));
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_GRAY, 8}, {7, 200})),
              (Texels{7, 7, 7, 255, 200, 200, 200, 255}));
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {7, 8, 200, 0})),
              (Texels{7, 7, 7, 8, 200, 200, 200, 0}));
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_GRAY, 1}, {0b10000000})),
              (Texels{255, 255, 255, 255, 0, 0, 0, 255}));
    EXPECT_EQ(texels_of(test::encode_png(two, {PNG_COLOR_TYPE_GRAY, 2}, {0b01110000})),
              (Texels{85, 85, 85, 255, 255, 255, 255, 255}));
}

TEST(Picture, RoundsSixteenBitsToEight) {
    // v / 257, rounded: 0x7fff is 127.498, 0x8000 is 127.502, 0x0081 is 0.502.
    const Texels rows = {0x7f, 0xff, 0x80, 0x00, 0xff, 0xff, 0x00, 0x81};
    EXPECT_EQ(texels_of(test::encode_png({1, 1}, {PNG_COLOR_TYPE_RGBA, 16}, rows)), (Texels{127, 128, 255, 1}));
}

TEST(Picture, KeepsWhatSixteenBitsHaveBeyondEight) {
    Texels rows;
    for (int i = 0; i < 65536; ++i) rows.insert(rows.end(), {std::uint8_t(i >> 8), std::uint8_t(i & 255)});
    const std::string file = test::encode_png({256, 256}, {PNG_COLOR_TYPE_GRAY, 16}, rows);
    EXPECT_TRUE(has_16_bits(bytes_of(file)));
    const Picture picture = decode_picture(bytes_of(file));
    ASSERT_EQ(picture.rest.size(), picture.rgba.size());
    for (int i = 0; i < 65536; ++i) {
        const std::size_t red = 4 * std::size_t(i);
        // A byte has 256 values, and 257 of 65,536 are nearest to one of 256: those half-way are off by one.
        EXPECT_NEAR(257 * picture.rgba[red] + picture.rest[red], i, 1) << i;
        EXPECT_EQ(picture.rest[red + 1], picture.rest[red]) << i;
        EXPECT_EQ(picture.rest[red + 3], 0) << i;  // opaque
    }
}

TEST(Picture, SixteenBitsThatEightHoldAreEight) {
    const Texels rows = {0x7f, 0x7f, 0xff, 0xff, 0x00, 0x00, 0x81, 0x81};
    const Picture picture = decode_picture(bytes_of(test::encode_png({1, 1}, {PNG_COLOR_TYPE_RGBA, 16}, rows)));
    EXPECT_EQ(picture.rgba, (Texels{127, 255, 0, 129}));
    EXPECT_TRUE(picture.rest.empty());
}

TEST(Picture, ReadsAPaletteWithTransparencyAndATransparentGrey) {
    PngFormat palette{PNG_COLOR_TYPE_PALETTE, 4};
    palette.palette = {10, 20, 30, 40, 50, 60};
    palette.palette_alpha = {99};  // the second entry is opaque
    EXPECT_EQ(texels_of(test::encode_png({2, 1}, palette, {0x01})), (Texels{10, 20, 30, 99, 40, 50, 60, 255}));
    PngFormat gray{PNG_COLOR_TYPE_GRAY, 8};
    gray.transparent_gray = 7;
    EXPECT_EQ(texels_of(test::encode_png({2, 1}, gray, {7, 8})), (Texels{7, 7, 7, 0, 8, 8, 8, 255}));
}

TEST(Picture, ReadsAnInterlacedPngWithTheFirstRowOnTop) {
    Texels rgba;
    for (int i = 0; i < 9 * 7; ++i) rgba.insert(rgba.end(), {std::uint8_t(i), std::uint8_t(3 * i), 5, 250});
    PngFormat format{PNG_COLOR_TYPE_RGBA, 8, true};
    const std::string file = test::encode_png({9, 7}, format, rgba);
    EXPECT_EQ(picture_size(bytes_of(file)), (Extent{9, 7}));
    EXPECT_EQ(texels_of(file), rgba);
}

TEST(Picture, IgnoresTheGammaOfAPng) {
    PngFormat format{PNG_COLOR_TYPE_GRAY, 8};
    format.gamma = 1.0;
    EXPECT_EQ(texels_of(test::encode_png({1, 1}, format, {100})), (Texels{100, 100, 100, 255}));
}

TEST(Picture, ReadsAJpeg) {
    Texels red_above_blue;  // halves on blocks of the transform
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 8; ++x) {
            const std::array<std::uint8_t, 3> rgb =
                y < 8 ? std::array<std::uint8_t, 3>{250, 20, 30} : std::array<std::uint8_t, 3>{10, 40, 240};
            red_above_blue.insert(red_above_blue.end(), rgb.begin(), rgb.end());
        }
    }
    const std::string file = test::encode_jpeg({8, 16}, red_above_blue);
    EXPECT_EQ(picture_size(bytes_of(file)), (Extent{8, 16}));
    const Texels texels = texels_of(file);
    ASSERT_EQ(texels.size(), 4u * 8 * 16);
    for (std::size_t i = 0; i < 8 * 16; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(int(texels[4 * i + c]), int(red_above_blue[3 * i + c]), 3) << "texel " << i << " channel " << c;
        }
        EXPECT_EQ(texels[4 * i + 3], 255) << "texel " << i;
    }
    const Texels gray = texels_of(test::encode_jpeg({8, 8}, Texels(64, 77), true));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(int(gray[c]), c < 3 ? 77 : 255, 1) << "channel " << c;
}

TEST(Picture, ReadsAWebp) {
    Texels rgba;  // halves on blocks of the transform, the lower half transparent
    for (int i = 0; i < 16 * 32; ++i) {
        const auto half =
            i < 16 * 16 ? std::array<std::uint8_t, 4>{250, 20, 30, 255} : std::array<std::uint8_t, 4>{10, 40, 240, 7};
        rgba.insert(rgba.end(), half.begin(), half.end());
    }
    const std::string lossless = test::encode_webp({16, 32}, rgba);
    EXPECT_TRUE(is_webp(bytes_of(lossless)));
    EXPECT_EQ(picture_size(bytes_of(lossless)), (Extent{16, 32}));
    EXPECT_EQ(texels_of(lossless), rgba);
    const std::string lossy = test::encode_webp({16, 32}, rgba, false);
    EXPECT_EQ(picture_size(bytes_of(lossy)), (Extent{16, 32}));
    const Texels texels = texels_of(lossy);
    ASSERT_EQ(texels.size(), rgba.size());
    for (std::size_t y : {2, 8, 24, 29}) {  // colours are stored at half the size, and mix where the halves meet
        for (std::size_t c = 0; c < 4; ++c) {
            const std::size_t i = 4 * (16 * y + 8) + c;
            EXPECT_NEAR(int(texels[i]), int(rgba[i]), 6) << "row " << y << " channel " << c;
        }
    }
}

TEST(Picture, RefusesAWebpThatMoves) {
    // VP8X (its second flag says that it moves) of 1 x 1, and nothing behind it.
    const std::string moving("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\2\0\0\0\0\0\0\0\0\0", 30);
    EXPECT_EQ(refusal(moving), "a WebP that moves is no texture");
}

TEST(Picture, RefusesEveryTruncationOfTheTexels) {
    Texels noise;
    for (unsigned i = 0; i < 3 * 32 * 32; ++i) noise.push_back(std::uint8_t(i * i * 2654435761u >> 13));
    const std::string png = test::encode_png({32, 32}, {PNG_COLOR_TYPE_RGB, 8}, noise);
    const std::string jpeg = test::encode_jpeg({32, 32}, noise);
    Texels opaque;
    for (std::size_t i = 0; i < noise.size(); i += 3) {
        opaque.insert(opaque.end(), {noise[i], noise[i + 1], noise[i + 2], 255});
    }
    for (const bool is_lossless : {false, true}) {
        const std::string webp = test::encode_webp({32, 32}, opaque, is_lossless);
        for (std::size_t size = 0; size + 2 < webp.size(); size += 7) {
            EXPECT_NE(refusal(webp.substr(0, size)), "") << "the first " << size << " of " << webp.size() << " of WebP";
        }
    }
    const std::size_t png_trailer = 12 + 4 + 4;  // IEND, then the checksum of the texels and that of zlib
    for (std::size_t size = 0; size + png_trailer < png.size(); size += 7) {
        EXPECT_NE(refusal(png.substr(0, size)), "") << "the first " << size << " of " << png.size() << " bytes of PNG";
    }
    for (std::size_t size = 0; size + 2 < jpeg.size(); size += 7) {
        EXPECT_NE(refusal(jpeg.substr(0, size)), "") << "the first " << size << " of " << jpeg.size() << " of JPEG";
    }
}

TEST(Picture, TakesAJpegWithBytesTooMany) {
    const std::string jpeg = test::encode_jpeg({8, 8}, Texels(64, 77), true);
    std::string padded = jpeg;
    padded.insert(padded.size() - 2, 16, 'x');  // before the mark of its end
    const Picture picture = decode_picture(bytes_of(padded));
    EXPECT_EQ(picture.rgba, texels_of(jpeg));
    EXPECT_NE(picture.flaw.find("extraneous"), std::string::npos) << picture.flaw;
    EXPECT_EQ(texels_of(jpeg + "and more"), texels_of(jpeg));
}

TEST(Picture, SaysWhyAFileIsBroken) {
    std::string png = test::one_texel_png({1, 2, 3, 4});
    png[png.find("IDAT") + 6] ^= 0x55;
    EXPECT_TRUE(refusal(png).starts_with("broken PNG: ")) << refusal(png);
    EXPECT_EQ(refusal("GIF89a, or whatever it is"), "neither PNG, JPEG nor WebP");
    EXPECT_EQ(refusal(""), "neither PNG, JPEG nor WebP");
    EXPECT_TRUE(refusal("\xff\xd8\xff\xe0 nothing more").starts_with("broken JPEG: "));
    EXPECT_EQ(refusal("RIFF....WEBPVP8 "), "broken WebP: the data ends early");
    std::string webp = test::encode_webp({1, 1}, {1, 2, 3, 4});
    webp[webp.find("VP8L") + 8] = 'x';  // its signature
    EXPECT_EQ(refusal(webp), "broken WebP: wrong data");
}

TEST(Picture, KnowsTheFormatsOfExtensions) {
    EXPECT_EQ(foreign_format(bytes_of("\xabKTX 20\xbb\r\n\x1a\n")), "KTX2");
    EXPECT_EQ(foreign_format(bytes_of("RIFF....WEBPVP8 ")), "");
    EXPECT_EQ(foreign_format(bytes_of("RIFF....WAVE")), "");
    EXPECT_EQ(foreign_format(bytes_of("DDS |")), "DDS");
    EXPECT_EQ(foreign_format(bytes_of("GIF89a")), "GIF");
    EXPECT_EQ(foreign_format(bytes_of(std::string("\0\0\0\x20"
                                                  "ftypavif",
                                                  12))),
              "AVIF");
    EXPECT_EQ(foreign_format(bytes_of(std::string("MM\0*", 4))), "TIFF");
    EXPECT_EQ(foreign_format(bytes_of("BM")), "BMP");
    EXPECT_EQ(foreign_format(bytes_of("B")), "");
    EXPECT_EQ(foreign_format(bytes_of("")), "");
    EXPECT_EQ(foreign_format(bytes_of(test::one_texel_png({1, 2, 3, 4}))), "");
}

TEST(Picture, ReadsTheSizeOfAHugePictureFromTheHeader) {
    std::string jpeg = test::encode_jpeg({8, 8}, Texels(64, 9), true);
    const std::size_t frame = jpeg.find("\xff\xc0");
    for (const std::size_t i : {5, 7}) jpeg.replace(frame + i, 2, "\xff\xdc");  // the most that the library reads
    EXPECT_EQ(picture_size(bytes_of(jpeg)), (Extent{65500, 65500}));
}

}  // namespace
}  // namespace vkcppm
