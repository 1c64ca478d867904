#include "io/hdr.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/thrown.h"

namespace vkcppm {
namespace {

Image decode(const std::string& bytes, std::size_t most_pixels = 1000000) {
    return decode_hdr({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, "sky.hdr", most_pixels);
}

std::string header(const std::string& size, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n") {
    return "#?RADIANCE\n" + lines + "\n" + size + "\n";
}

std::string bytes(const std::vector<int>& values) { return std::string(values.begin(), values.end()); }

TEST(Hdr, ReadsFlatPixels) {
    const Image image = decode(header("-Y 2 +X 2") + bytes({128, 64, 32, 129,  //
                                                            255, 0, 1, 128,    //
                                                            200, 100, 50, 0,   //
                                                            128, 128, 128, 136}));
    ASSERT_EQ(image.extent, (Extent{2, 2}));
    EXPECT_EQ(image.at(0, 0), glm::vec3(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(image.at(1, 0), glm::vec3(255.0f / 256.0f, 0.0f, 1.0f / 256.0f));
    EXPECT_EQ(image.at(0, 1), glm::vec3(0.0f)) << "the exponent 0 is black";
    EXPECT_EQ(image.at(1, 1), glm::vec3(128.0f));
}

TEST(Hdr, ReadsTheWholeRangeOfExponents) {
    const Image image = decode(header("-Y 1 +X 2") + bytes({1, 128, 255, 255, 1, 128, 255, 1}));
    EXPECT_EQ(image.at(0, 0), glm::vec3(0x1p119f, 0x1p126f, 255.0f * 0x1p119f));
    EXPECT_EQ(image.at(1, 0), glm::vec3(0x1p-135f, 0x1p-128f, 255.0f * 0x1p-135f));
}

TEST(Hdr, ReadsAllOrdersOfRowsAndColumns) {
    // Six pixels in the order of the file, told apart by their exponents: 2^0 to 2^5.
    std::vector<int> pixels;
    for (int i = 0; i < 6; ++i) pixels.insert(pixels.end(), {128, 128, 128, 129 + i});
    // Where they lie, first row on top.
    const std::vector<std::pair<std::string, std::vector<int>>> orders = {
        {"-Y 2 +X 3", {0, 1, 2, 3, 4, 5}}, {"+Y 2 +X 3", {3, 4, 5, 0, 1, 2}}, {"-Y 2 -X 3", {2, 1, 0, 5, 4, 3}},
        {"+Y 2 -X 3", {5, 4, 3, 2, 1, 0}}, {"+X 3 -Y 2", {0, 2, 4, 1, 3, 5}}, {"-X 3 -Y 2", {4, 2, 0, 5, 3, 1}},
        {"+X 3 +Y 2", {1, 3, 5, 0, 2, 4}}, {"-X 3 +Y 2", {5, 3, 1, 4, 2, 0}}};
    for (const auto& [order, places] : orders) {
        const Image image = decode(header(order) + bytes(pixels));
        ASSERT_EQ(image.extent, (Extent{3, 2})) << order;
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(image.rgb[i].r, float(1 << places[i])) << order << ", pixel " << i;
        }
    }
}

/// A row of 8 in the newer encoding: red 10 runs, green and blue as they are, the exponent in two runs.
const std::vector<int> new_row = {2,       2,   0,       8,                        //
                                  128 + 8, 10,                                     //
                                  8,       1,   2,       3,  4,       5, 6, 7, 8,  //
                                  3,       9,   9,       9,  128 + 5, 7,           //
                                  128 + 4, 136, 128 + 4, 137};

TEST(Hdr, ReadsTheNewerRunLengthEncoding) {
    std::vector<int> rows = new_row;
    rows.insert(rows.end(), new_row.begin(), new_row.end());
    const Image image = decode(header("-Y 2 +X 8") + bytes(rows));
    for (std::uint32_t y = 0; y < 2; ++y) {
        for (std::uint32_t x = 0; x < 8; ++x) {
            const float scale = x < 4 ? 1.0f : 2.0f;
            EXPECT_EQ(image.at(x, y), scale * glm::vec3(10, x + 1, x < 3 ? 9 : 7)) << x << ", " << y;
        }
    }
}

TEST(Hdr, ReadsTheOlderRunLengthEncoding) {
    // 1 pixel, 2 repetitions, 1 pixel, 1 + 1 * 256 repetitions.
    const Image image = decode(header("-Y 1 +X 261") + bytes({5, 6, 7, 136, 1, 1, 1, 2, 8, 9, 10, 136,  //
                                                              1, 1, 1, 1,   1, 1, 1, 1}));
    ASSERT_EQ(image.rgb.size(), 261u);
    for (std::uint32_t x = 0; x < 261; ++x) {
        EXPECT_EQ(image.at(x, 0), x < 3 ? glm::vec3(5, 6, 7) : glm::vec3(8, 9, 10)) << x;
    }
}

TEST(Hdr, AWideRowIsFlatWhereItHasNoMarker) {
    std::vector<int> pixels;
    for (int x = 0; x < 9; ++x) pixels.insert(pixels.end(), {128, x, 0, 129});
    const Image image = decode(header("-Y 1 +X 9") + bytes(pixels));
    EXPECT_EQ(image.at(8, 0), glm::vec3(1.0f, 8.0f / 128.0f, 0.0f));
}

TEST(Hdr, DividesByExposureAndColourCorrection) {
    const std::string lines =
        "# made by hand\nEXPOSURE=4\nSOFTWARE=none\nEXPOSURE= 0.5\nCOLORCORR=1 2 4\n"
        "FORMAT=32-bit_rle_rgbe\n";
    const Image image = decode(header("-Y 1 +X 1", lines) + bytes({128, 128, 128, 132}));
    EXPECT_EQ(image.at(0, 0), glm::vec3(4.0f, 2.0f, 1.0f));
}

TEST(Hdr, RefusesEveryBadFileAndSaysWhy) {
    const std::string pixel = bytes({128, 128, 128, 129});
    struct Bad {
        std::string bytes;
        std::string told;
    };
    const auto row_of_8 = [&](std::vector<int> row) { return header("-Y 1 +X 8") + bytes(row); };
    const std::vector<Bad> all = {
        {"", "header"},
        {"RADIANCE\n", "#?"},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "no end"},
        {header("-Y 1 +X 1", "FORMAT=32-bit_rle_xyze\n") + pixel, "32-bit_rle_xyze"},
        {header("-Y 1 +X 1", "EXPOSURE=0\n") + pixel, "'0'"},
        {header("-Y 1 +X 1", "EXPOSURE=nan\n") + pixel, "'nan'"},
        {header("-Y 1 +X 1", "EXPOSURE=\n") + pixel, "factor"},
        {header("-Y 1 +X 1", "COLORCORR=1 2\n") + pixel, "factor"},
        {header("-Y 1 +Y 1") + pixel, "'-Y 1 +Y 1'"},
        {header("Y 1 X 1") + pixel, "'Y 1 X 1'"},
        {header("-Y 1"), "'-Y 1'"},
        {header("-Y 0 +X 1"), "'-Y 0 +X 1'"},
        {header("-Y -1 +X 1"), "'-Y -1 +X 1'"},
        {header("-Y 1 +X 1 1") + pixel, "'-Y 1 +X 1 1'"},
        {header("-Y 4294967295 +X 4294967295"), "4294967295x4294967295 pixels, more than 1000000"},
        {header("-Y 99999999999999999999 +X 1"), "size"},
        {header("-Y 2 +X 1") + pixel, "row 1 is cut short"},
        {header("-Y 1 +X 1") + pixel.substr(0, 3), "row 0 is cut short"},
        {header("-Y 1 +X 2") + bytes({1, 1, 1, 2}), "repeats"},
        {header("-Y 1 +X 2") + pixel + bytes({1, 1, 1, 2}), "repeats a pixel 2 times at column 1 of 2"},
        {header("-Y 1 +X 2") + pixel + bytes({1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0}), "repeats"},
        {row_of_8({2, 2, 0, 9}), "9 columns, the picture 8"},
        {row_of_8({2, 2, 0, 8, 128 + 9, 1}), "run of 9 at column 0 of 8"},
        {row_of_8({2, 2, 0, 8, 4, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5}), "run of 5 at column 4 of 8"},
        {row_of_8({2, 2, 0, 8, 0}), "run of 0"},
        {row_of_8({2, 2, 0, 8, 128 + 8}), "row 0 is cut short"},
        {row_of_8({2, 2, 0, 8, 128 + 8, 1, 128 + 8, 1, 128 + 8, 1}), "row 0 is cut short"},
    };
    for (const Bad& bad : all) {
        const auto error = test::thrown_by([&] { decode(bad.bytes); });
        ASSERT_TRUE(error) << "accepted, though it should tell of " << bad.told;
        const std::string message = error->what();
        EXPECT_EQ(error->code(), ExitCode::bad_input) << message;
        EXPECT_TRUE(message.starts_with("sky.hdr: ")) << message;
        EXPECT_NE(message.find(bad.told), message.npos) << "'" << bad.told << "' is not in: " << message;
    }
}

}  // namespace
}  // namespace vkcppm
