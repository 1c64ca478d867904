#include "study/false_colour.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

TEST(FalseColour, GoesFromBlueOverYellowToRed) {
    EXPECT_EQ(false_colour(0.0), glm::u8vec3(49, 54, 149));
    EXPECT_EQ(false_colour(0.5), glm::u8vec3(255, 255, 191));
    EXPECT_EQ(false_colour(1.0), glm::u8vec3(165, 0, 38));
    EXPECT_EQ(false_colour(0.05), glm::u8vec3(59, 86, 165)) << "half way between two classes";
    EXPECT_EQ(false_colour(-3.0), false_colour(0.0));
    EXPECT_EQ(false_colour(7.0), false_colour(1.0));
}

TEST(FalseColour, NoTwoPartsOfTheScaleLookAlike) {
    for (int i = 0; i <= 20; ++i) {
        for (int j = 0; j < i; ++j) {
            const glm::ivec3 difference = glm::ivec3(false_colour(i / 20.0)) - glm::ivec3(false_colour(j / 20.0));
            EXPECT_GT(std::hypot(difference.x, difference.y, difference.z), 12.0) << i << " and " << j << " of 20";
        }
    }
}

TEST(FalseColour, ScalesAreLinearOrLogarithmic) {
    const ColourScale linear{1.0, 5.0, false}, logarithmic{0.01, 100.0, true};
    EXPECT_DOUBLE_EQ(*linear.position(2.0), 0.25);
    EXPECT_DOUBLE_EQ(*linear.position(0.0), 0.0);
    EXPECT_DOUBLE_EQ(*linear.position(9.0), 1.0);
    EXPECT_NEAR(*logarithmic.position(0.1), 0.25, 1e-15);
    EXPECT_DOUBLE_EQ(*logarithmic.position(1e-9), 0.0);
    EXPECT_FALSE(logarithmic.position(0.0));
    EXPECT_FALSE(logarithmic.position(-1.0));
    EXPECT_FALSE(linear.position(NAN));
    EXPECT_FALSE(linear.position(INFINITY));
    EXPECT_DOUBLE_EQ(*(ColourScale{0.0, 0.0, false}).position(0.0), 0.0) << "a map of nothing but zeros";
}

TEST(FalseColour, MapsAreGrayWhereThereIsNoValue) {
    const std::vector<float> values = {0.0f, 1.0f, NAN};
    const Bitmap map = false_colours({3, 1}, values, {0.0, 1.0, false});
    EXPECT_EQ(map.rgb, (std::vector<glm::u8vec3>{{49, 54, 149}, {165, 0, 38}, {128, 128, 128}}));
}

TEST(FalseColour, QuantilesLeaveOutWhatIsNotPositive) {
    const std::vector<float> values = {5.0f, NAN, 1.0f, 0.0f, 3.0f, INFINITY, 2.0f, -7.0f, 4.0f};
    EXPECT_EQ(positive_quantile(values, 0.0), 1.0);
    EXPECT_EQ(positive_quantile(values, 0.5), 3.0);
    EXPECT_EQ(positive_quantile(values, 1.0), 5.0);
    EXPECT_EQ(positive_quantile(std::vector<float>{0.0f, NAN}, 0.5), 0.0);
}

}  // namespace
}  // namespace vkcppm
