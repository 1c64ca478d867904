#include "core/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/srgb.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

Image picture(std::uint32_t width, std::uint32_t height, std::vector<glm::vec3> rgb) {
    return {{width, height}, std::move(rgb)};
}

/// Radiances over six decades, some black, as a noisy picture has them.
std::pair<Image, Image> noisy_pair(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> exponent(-4.0f, 2.0f);
    std::normal_distribution<float> noise(1.0f, 0.3f);
    Image reference = picture(width, height, {});
    Image image = reference;
    for (std::size_t i = 0; i < reference.extent.pixels(); ++i) {
        glm::vec3 r(0.0f);
        glm::vec3 x(0.0f);
        for (int c = 0; c < 3; ++c) {
            r[c] = i % 17 == 0 ? 0.0f : std::pow(10.0f, exponent(engine));
            x[c] = r[c] * noise(engine) + (i % 23 == 0 ? 0.5f : 0.0f);
        }
        reference.rgb.push_back(r);
        image.rgb.push_back(x);
    }
    return {image, reference};
}

/// The measures once more: planes instead of pixels, a full sort instead of a selection, thresholds of the inverse
/// transfer function instead of the function, long double.
struct SecondOpinion {
    long double ratio[3];
    long double mse, relative, trimmed, srgb, psnr;
};

/// Linear values at which the next level of the encoding begins, [255].
std::vector<long double> srgb_thresholds() {
    std::vector<long double> thresholds;
    for (int level = 0; level < 255; ++level) {
        const long double edge = (level + 0.5L) / 255.0L;
        thresholds.push_back(edge <= 0.04045L ? edge / 12.92L : std::pow((edge + 0.055L) / 1.055L, 2.4L));
    }
    return thresholds;
}

int srgb_level(long double linear) {
    static const std::vector<long double> thresholds = srgb_thresholds();
    return int(std::upper_bound(thresholds.begin(), thresholds.end(), linear) - thresholds.begin());
}

SecondOpinion second_opinion(const Image& image, const Image& reference) {
    const std::size_t count = image.rgb.size();
    SecondOpinion result{};
    std::vector<long double> relative(count, 0.0L);
    for (int c = 0; c < 3; ++c) {
        long double mean_x = 0.0L;
        long double mean_r = 0.0L;
        for (std::size_t i = 0; i < count; ++i) {
            const long double x = image.rgb[i][c];
            const long double r = reference.rgb[i][c];
            mean_x += x / count;
            mean_r += r / count;
            result.mse += (x * x - 2 * x * r + r * r) / (3 * count);
            const long double levels = srgb_level(x) - srgb_level(r);
            result.srgb += levels * levels / (3 * count);
            relative[i] += std::pow((x - r) / std::hypot(r, 0.1L), 2.0L) / 3;
        }
        result.ratio[c] = mean_x / mean_r;
    }
    std::sort(relative.begin(), relative.end());
    const std::size_t kept = count - std::size_t(std::floor(0.001L * count + 1e-9L));
    for (std::size_t i = 0; i < count; ++i) {
        result.relative += relative[i] / count;
        result.trimmed += i < kept ? relative[i] / kept : 0.0L;
    }
    result.psnr = 20 * std::log10(255.0L) - 10 * std::log10(result.srgb);
    return result;
}

TEST(Srgb, HasTheStandardsValues) {
    EXPECT_EQ(srgb_encode(0.0), 0.0);
    EXPECT_NEAR(srgb_encode(1.0), 1.0, 1e-15);
    EXPECT_NEAR(srgb_encode(0.5), 0.735356983, 1e-9);
    EXPECT_NEAR(srgb_encode(0.0031308), 0.040449936, 1e-9);
    // The two pieces meet within what the standard's rounding of its constants leaves.
    EXPECT_NEAR(srgb_encode(0.0031308), srgb_encode(0.00313081), 1e-6);
}

TEST(Srgb, BytesAreClampedAndRounded) {
    EXPECT_EQ(srgb_byte(0.5), 188);    // 187.516
    EXPECT_EQ(srgb_byte(0.18), 118);   // 117.6
    EXPECT_EQ(srgb_byte(0.2140), 127); // 126.99
    EXPECT_EQ(srgb_byte(1.0), 255);
    EXPECT_EQ(srgb_byte(7.0), 255);
    EXPECT_EQ(srgb_byte(-1.0), 0);
    EXPECT_EQ(srgb_byte(std::numeric_limits<double>::infinity()), 255);
    EXPECT_EQ(srgb_byte(std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(Metrics, OfTwoPixelsByHand) {
    const Image reference = picture(2, 1, {{1.0f, 0.5f, 0.0f}, {1.0f, 0.5f, 0.25f}});
    const Image image = picture(2, 1, {{1.5f, 0.5f, 0.5f}, {0.5f, 0.0f, 0.25f}});
    const Comparison c = compare(image, reference);
    EXPECT_EQ(c.pixels, 2u);
    EXPECT_DOUBLE_EQ(c.mean_ratio.r, 1.0);
    EXPECT_DOUBLE_EQ(c.mean_ratio.g, 0.5);
    EXPECT_DOUBLE_EQ(c.mean_ratio.b, 3.0);
    EXPECT_DOUBLE_EQ(c.mse.all, 4 * 0.25 / 6);
    const double relative = (0.25 / 1.01 + 0.25 / 0.01 + 0.25 / 1.01 + 0.25 / 0.26) / 6;
    EXPECT_NEAR(c.relmse.all, relative, 1e-14);
    EXPECT_NEAR(c.relmse.trimmed, relative, 1e-14) << "of two pixels none is the worst 0.1 %";
    // Levels: 1 -> 255, 1.5 -> 255, 0.5 -> 188, 0.25 -> 137, 0 -> 0.
    const double levels = (188.0 * 188.0 + 67.0 * 67.0 + 188.0 * 188.0) / 6;
    EXPECT_NEAR(c.srgb_mse.all, levels, 1e-9);
    EXPECT_NEAR(c.psnr, 10 * std::log10(65025.0 / levels), 1e-12);
}

TEST(Metrics, AgreeWithASecondImplementation) {
    const auto [image, reference] = noisy_pair(123, 77, 5);
    const Comparison c = compare(image, reference);
    const SecondOpinion expected = second_opinion(image, reference);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(c.mean_ratio[channel], double(expected.ratio[channel]), 1e-11);
    }
    EXPECT_NEAR(c.mse.all / double(expected.mse), 1.0, 1e-11);
    EXPECT_NEAR(c.relmse.all / double(expected.relative), 1.0, 1e-11);
    EXPECT_NEAR(c.relmse.trimmed / double(expected.trimmed), 1.0, 1e-11);
    EXPECT_NEAR(c.srgb_mse.all / double(expected.srgb), 1.0, 1e-11);
    EXPECT_NEAR(c.psnr, double(expected.psnr), 1e-9);
    EXPECT_LT(c.relmse.trimmed, c.relmse.all);
}

TEST(Metrics, TrimmingDropsExactlyOnePixelInAThousand) {
    // 2999 pixels of value 1 and two fireflies: floor(3001 / 1000) = 3 pixels go, both fireflies among them.
    Image reference = picture(3001, 1, std::vector<glm::vec3>(3001, glm::vec3(1.0f)));
    Image image = picture(3001, 1, std::vector<glm::vec3>(3001, glm::vec3(1.5f)));
    image.rgb[7] = glm::vec3(1000.0f);
    image.rgb[3000] = glm::vec3(500.0f, 1.0f, 1.0f);
    EXPECT_NEAR(compare(image, reference).relmse.trimmed, 0.25 / 1.01, 1e-12);
    // A fourth one is left in.
    image.rgb[11] = glm::vec3(2.0f);
    image.rgb[12] = glm::vec3(2.0f);
    EXPECT_NEAR(compare(image, reference).relmse.trimmed, (2997 * 0.25 + 1.0) / 2998 / 1.01, 1e-12);
}

TEST(Metrics, IdenticalPicturesHaveNoError) {
    const Image reference = noisy_pair(31, 17, 9).second;
    const Comparison c = compare(reference, reference);
    EXPECT_EQ(c.mean_ratio, glm::dvec3(1.0));
    EXPECT_EQ(c.mse.all, 0.0);
    EXPECT_EQ(c.relmse.all, 0.0);
    EXPECT_EQ(c.relmse.trimmed, 0.0);
    EXPECT_EQ(c.srgb_mse.all, 0.0);
    EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, NonFinitePixelsAreCountedAndLeftOut) {
    auto [image, reference] = noisy_pair(40, 25, 2);
    image.rgb[3].g = std::numeric_limits<float>::quiet_NaN();
    image.rgb[500].b = -std::numeric_limits<float>::infinity();
    reference.rgb[3].r = std::numeric_limits<float>::infinity();
    reference.rgb[999].r = std::numeric_limits<float>::quiet_NaN();
    const Comparison c = compare(image, reference);
    EXPECT_EQ(c.image_non_finite, 2u);
    EXPECT_EQ(c.reference_non_finite, 2u);
    EXPECT_EQ(c.pixels, 997u);

    Image image_rest = image;
    Image reference_rest = reference;
    for (const std::size_t i : {999, 500, 3}) {
        image_rest.rgb.erase(image_rest.rgb.begin() + std::ptrdiff_t(i));
        reference_rest.rgb.erase(reference_rest.rgb.begin() + std::ptrdiff_t(i));
    }
    image_rest.extent = reference_rest.extent = {997, 1};
    const Comparison rest = compare(image_rest, reference_rest);
    EXPECT_EQ(c.mse.all, rest.mse.all);
    EXPECT_EQ(c.relmse.all, rest.relmse.all);
    EXPECT_EQ(c.psnr, rest.psnr);
    EXPECT_TRUE(std::isfinite(c.mse.all));
}

TEST(Metrics, OfPicturesWithoutAFinitePixelAreNotANumber) {
    const Image image = picture(1, 1, {glm::vec3(std::numeric_limits<float>::quiet_NaN())});
    const Comparison c = compare(image, image);
    EXPECT_EQ(c.pixels, 0u);
    EXPECT_TRUE(std::isnan(c.mse.all));
    EXPECT_TRUE(std::isnan(c.relmse.all));
    EXPECT_TRUE(std::isnan(c.relmse.trimmed));
}

TEST(Metrics, RefuseDifferentSizes) {
    const Image a = picture(2, 1, std::vector<glm::vec3>(2));
    const Image b = picture(1, 2, std::vector<glm::vec3>(2));
    const auto error = test::thrown_by([&] { compare(a, b); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
    EXPECT_NE(std::string(error->what()).find("2x1"), std::string::npos) << error->what();
    EXPECT_NE(std::string(error->what()).find("1x2"), std::string::npos) << error->what();
}

}  // namespace
}  // namespace vkcppm
