// FLIP against its authors' program: flip_values makes flip_values.json with it.

#include "core/flip.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/display.h"
#include "support/files/places.h"

namespace vkcppm {
namespace {

constexpr Extent size{40, 30};

/// A multiple of 2^-16 in [0, 1), by the finalizer of MurmurHash3.
double uniform(std::uint32_t x, std::uint32_t y, std::uint32_t c, std::uint32_t seed) {
    std::uint32_t h = x + size.width * (y + size.height * (c + 3 * seed));
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    return double((h ^ (h >> 16)) >> 16) / 65536.0;
}

using Function = std::function<double(std::uint32_t x, std::uint32_t y, std::uint32_t c)>;

double ramp(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
    if (x >= 12 && x < 18 && y >= 6 && y < 12) return 24.0;
    return (0.25 + 0.75 * (x % 8) / 8) * std::exp2(int(x / 8) - 3) *
           (0.5 + double(y * (c + 1) % size.height) / size.height);
}

double board(std::uint32_t x, std::uint32_t y, std::uint32_t c) {
    if (x >= 24) return 0.0;
    return ((x / 4 + y / 4) % 2 ? 1.5 : 0.125) * (0.75 + 0.5 * uniform(x, y, c, 9));
}

/// Reference and test.
const std::map<std::string, std::pair<Function, Function>> cases = {
    {"same", {ramp, ramp}},
    {"noise", {ramp, [](auto x, auto y, auto c) { return ramp(x, y, c) * (0.75 + 0.5 * uniform(x, y, c, 1)); }}},
    {"brighter", {ramp, [](auto x, auto y, auto c) { return 1.25 * ramp(x, y, c); }}},
    {"firefly", {ramp, [](auto x, auto y, auto c) { return x == 30 && y == 20 ? 64.0 : ramp(x, y, c); }}},
    {"shifted", {board, [](auto x, auto y, auto c) { return board(x + 1, y, c); }}},
    {"colours", {board, [](auto x, auto y, auto c) { return board(x, y, y < 15 ? 2 - c : c); }}},
    {"black", {board, [](auto, auto, auto) { return 0.0; }}},
};

Image picture(const Function& function) {
    Image image{size, {}};
    for (std::uint32_t y = 0; y < size.height; ++y) {
        for (std::uint32_t x = 0; x < size.width; ++x) {
            image.rgb.emplace_back(float(function(x, y, 0)), float(function(x, y, 1)), float(function(x, y, 2)));
        }
    }
    return image;
}

/// Theirs is in single precision: 1e-5 is some tens of its rounding errors and far below what an eye sees. At colours
/// that are nearly the same the power 0.7 of a rounding error is larger.
void expect_same(const Flip& flip, const nlohmann::json& wanted) {
    EXPECT_NEAR(flip.mean, wanted["mean"].get<double>(), 2e-5);
    std::size_t i = 0;
    for (std::uint32_t y = 3; y < size.height; y += 8) {
        for (std::uint32_t x = 2; x < size.width; x += 9, ++i) {
            EXPECT_NEAR(flip.error[y * size.width + x], wanted["errors"][i].get<double>(), 2e-4) << x << "," << y;
        }
    }
    EXPECT_EQ(i, wanted["errors"].size());
}

TEST(Flip, IsThatOfItsAuthorsProgram) {
    std::ifstream file(test::source_folder() / "tests" / "unit" / "flip_values.json");
    const auto values = nlohmann::json::parse(file);
    ASSERT_EQ(values.size(), cases.size());
    for (const auto& [name, functions] : cases) {
        SCOPED_TRACE(name);
        const Image reference = picture(functions.first), image = picture(functions.second);
        const auto& hdr = values[name]["hdr"];
        const std::vector<double> exposures = flip_exposures(reference);
        EXPECT_EQ(exposures.size(), hdr["exposures"].get<std::size_t>());
        EXPECT_NEAR(exposures.front(), hdr["start"].get<double>(), 1e-5);
        EXPECT_NEAR(exposures.back(), hdr["stop"].get<double>(), 1e-5);
        expect_same(hdr_flip(image, reference), hdr);
        expect_same(ldr_flip(image, reference), values[name]["ldr"]);
    }
}

TEST(Flip, OfTheSamePictureIsNothingAndOfBlackAndWhiteAsMuchAsThereIs) {
    Image black{{8, 8}, std::vector<glm::vec3>(64, glm::vec3(0.0f))}, white = black;
    for (glm::vec3& pixel : white.rgb) pixel = glm::vec3(1.0f);
    EXPECT_EQ(ldr_flip(white, white).mean, 0.0);
    EXPECT_EQ(hdr_flip(white, white).mean, 0.0);
    EXPECT_EQ(hdr_flip(black, black).mean, 0.0);
    // HyAB of black and white is 100, of green and blue in Hunt's colours 203: beyond the knee at 0.4 of its power.
    EXPECT_NEAR(ldr_flip(black, white).mean, 0.967, 0.01);
}

TEST(Flip, PixelsThatAreNotFiniteDoNotCount) {
    const Image reference = picture(ramp);
    Image image = reference;
    image.rgb[100].g = std::numeric_limits<float>::quiet_NaN();
    image.rgb[200].r = std::numeric_limits<float>::infinity();
    EXPECT_EQ(hdr_flip(image, reference).mean, 0.0);
    EXPECT_EQ(ldr_flip(image, reference).mean, 0.0);
    image.rgb.assign(image.rgb.size(), glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    EXPECT_TRUE(std::isnan(hdr_flip(image, reference).mean)) << "no pixel counts";
}

}  // namespace
}  // namespace vkcppm
