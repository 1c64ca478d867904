#include "io/png.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

struct Decoded {
    std::uint32_t width = 0, height = 0;
    std::vector<png_byte> rgb;
};

Decoded decode(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&png, file.c_str())) << png.message;
    png.format = PNG_FORMAT_RGB;
    Decoded decoded{png.width, png.height, std::vector<png_byte>(PNG_IMAGE_SIZE(png))};
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, decoded.rgb.data(), 0, nullptr)) << png.message;
    return decoded;
}

using Bytes = std::vector<png_byte>;

TEST(Png, EncodesSrgbWithTheFirstRowOnTop) {
    const test::TemporaryFolder folder;
    // A gray of 0.2140 is byte 127, 0.5 is 188; the rows differ so that a flip shows.
    const Image image{{2, 2}, {{0.0f, 0.5f, 1.0f}, {0.2140f, 2.0f, -1.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.5f}}};
    write_png(folder / "a.png", image);
    const Decoded decoded = decode(folder / "a.png");
    EXPECT_EQ(decoded.width, 2u);
    EXPECT_EQ(decoded.height, 2u);
    EXPECT_EQ(decoded.rgb, (Bytes{0, 188, 255, 127, 255, 0, 255, 0, 0, 0, 0, 188}));
}

TEST(Png, ExposureIsInStops) {
    const test::TemporaryFolder folder;
    const Image image{{3, 1}, {glm::vec3(0.125f), glm::vec3(0.5f), glm::vec3(0.0f)}};
    write_png(folder / "up.png", image, {ToneMap::none, 2.0});
    EXPECT_EQ(decode(folder / "up.png").rgb, (Bytes{188, 188, 188, 255, 255, 255, 0, 0, 0}));
    write_png(folder / "down.png", image, {ToneMap::none, -1.0});
    EXPECT_EQ(decode(folder / "down.png").rgb, (Bytes{71, 71, 71, 137, 137, 137, 0, 0, 0}));  // 0.0625, 0.25
}

TEST(Png, SixteenBitsAreFiner) {
    const test::TemporaryFolder folder;
    const Image image{{2, 1}, {{0.0f, 0.5f, 1.0f}, {0.501f, 2.0f, -1.0f}}};
    write_png(folder / "a.png", image, {}, PngDepth::sixteen);
    EXPECT_EQ(decode(folder / "a.png").rgb, (Bytes{0, 188, 255, 188, 255, 0})) << "as 8 bits";
    const std::string bytes = test::read_bytes(folder / "a.png");
    EXPECT_EQ(int(bytes.at(24)), 16) << "bit depth of the header";
    EXPECT_NE(bytes.find("sRGB"), std::string::npos) << "what its numbers are";
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder / "a.png").c_str()));
    png.format = PNG_FORMAT_LINEAR_RGB;  // 16 bits
    std::vector<png_uint_16> linear(6);
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, linear.data(), 0, nullptr));
    // libpng takes sRGB for a power of 2.2 here, which moves both alike.
    EXPECT_NEAR(linear[3] - linear[1], 0.001 * 65535.0, 2.0) << "8 bits are 500 apart";
}

TEST(Png, ToneMapsBeforeItEncodes) {
    const test::TemporaryFolder folder;
    write_png(folder / "a.png", Image{{1, 1}, {glm::vec3(4.0f)}}, {ToneMap::reinhard, -2.0});
    EXPECT_EQ(decode(folder / "a.png").rgb, (Bytes{188, 188, 188})) << "1 / (1 + 1)";
}

TEST(Png, NonFinitePixelsAreBlackOrWhite) {
    const test::TemporaryFolder folder;
    const float infinity = std::numeric_limits<float>::infinity();
    const Image image{{1, 1}, {{std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}}};
    write_png(folder / "a.png", image);
    EXPECT_EQ(decode(folder / "a.png").rgb, (Bytes{0, 255, 0}));
}

TEST(Png, KeepsSizesThatAreNotMultiplesOfAnything) {
    const test::TemporaryFolder folder;
    Image image{{37, 5}, {}};
    for (std::size_t i = 0; i < image.extent.pixels(); ++i) {
        image.rgb.push_back(glm::vec3(i % 2 ? 1.0f : 0.0f, 0.5f, float(i == 100)));
    }
    write_png(folder / "a.png", image);
    const Decoded decoded = decode(folder / "a.png");
    EXPECT_EQ(decoded.width, 37u);
    EXPECT_EQ(decoded.height, 5u);
    for (std::size_t i = 0; i < image.extent.pixels(); ++i) {
        EXPECT_EQ(decoded.rgb[3 * i], i % 2 ? 255 : 0) << "pixel " << i;
        EXPECT_EQ(decoded.rgb[3 * i + 2], i == 100 ? 255 : 0) << "pixel " << i;
    }
}

TEST(Png, TellsWhereItCannotWrite) {
    const test::TemporaryFolder folder;
    const Image image{{1, 1}, {glm::vec3(0.5f)}};
    const auto error = test::thrown_by([&] { write_png(folder / "missing" / "a.png", image); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::cannot_write);
    EXPECT_NE(std::string(error->what()).find("missing/a.png"), std::string::npos) << error->what();
    EXPECT_TRUE(test::names_in(folder.path()).empty());
}

}  // namespace
}  // namespace vkcppm
