#include "core/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
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

/// The measures once more: other formulas, a full sort instead of a selection, thresholds of the inverse transfer
/// function instead of the function, long double.
struct SecondOpinion {
    long double ratio[3];
    std::map<std::string, long double> measures;  // by Metric::name
    long double psnr;
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

/// Adds the mean of the pixels' values as `name`, and that without the largest thousandth as `name`_trimmed.
void add_means(SecondOpinion& opinion, const std::string& name, std::vector<long double> values) {
    const std::size_t count = values.size();
    std::sort(values.begin(), values.end());
    const std::size_t kept = count - std::size_t(std::floor(0.001L * count + 1e-9L));
    for (std::size_t i = 0; i < count; ++i) {
        opinion.measures[name] += values[i] / count;
        opinion.measures[name + "_trimmed"] += i < kept ? values[i] / kept : 0.0L;
    }
}

SecondOpinion second_opinion(const Image& image, const Image& reference) {
    const std::size_t count = image.rgb.size();
    SecondOpinion result{};
    std::vector<long double> square(count), relative(count), symmetric(count), levels(count);
    for (int c = 0; c < 3; ++c) {
        long double mean_x = 0.0L;
        long double mean_r = 0.0L;
        for (std::size_t i = 0; i < count; ++i) {
            const long double x = image.rgb[i][c];
            const long double r = reference.rgb[i][c];
            mean_x += x / count;
            mean_r += r / count;
            square[i] += (x * x - 2 * x * r + r * r) / 3;
            relative[i] += std::pow((x - r) / std::hypot(r, 0.1L), 2.0L) / 3;
            // Of opposite signs the distance is the sum; of one sign it is what the smaller lacks of the larger.
            const long double small = std::min(std::abs(x), std::abs(r)), sum = std::abs(x) + std::abs(r);
            symmetric[i] += (sum == 0.0L ? 0.0L : x * r < 0.0L ? 1.0L : 1.0L - 2 * small / sum) / 3;
            levels[i] += std::pow((long double)(srgb_level(x) - srgb_level(r)), 2.0L) / 3;
        }
        result.ratio[c] = mean_x / mean_r;
    }
    add_means(result, "mse", square);
    add_means(result, "relmse", relative);
    add_means(result, "smape", symmetric);
    add_means(result, "srgb_mse", levels);
    for (const std::string part : {"", "_trimmed"}) {
        result.measures["rmse" + part] = std::exp(std::log(result.measures.at("mse" + part)) / 2);
    }
    result.psnr = 20 * std::log10(255.0L) - 10 * std::log10(result.measures.at("srgb_mse"));
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
    EXPECT_EQ(srgb_byte(0.5), 188);     // 187.516
    EXPECT_EQ(srgb_byte(0.18), 118);    // 117.6
    EXPECT_EQ(srgb_byte(0.2140), 127);  // 126.99
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
    EXPECT_DOUBLE_EQ(c.rmse.all, std::sqrt(1.0 / 6.0));
    EXPECT_NEAR(c.smape.all, (0.5 / 2.5 + 1.0 + 0.5 / 1.5 + 1.0) / 6, 1e-15);
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
    EXPECT_EQ(metrics().size(), expected.measures.size());
    for (const Metric& metric : metrics()) {
        const std::string name(metric.name);
        ASSERT_TRUE(expected.measures.contains(name)) << name;
        const auto value = double(expected.measures.at(name));
        EXPECT_NEAR(metric.of(c) / value, 1.0, 1e-11) << name << " " << metric.of(c) << ", second opinion " << value;
        if (!name.ends_with("_trimmed")) {
            EXPECT_LT(expected.measures.at(name + "_trimmed"), 0.999 * expected.measures.at(name))
                << name << ": leaving out the worst changes too little to tell a wrong trimming from a right one";
        }
    }
    EXPECT_NEAR(c.psnr, double(expected.psnr), 1e-9);
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
    for (const Metric& metric : metrics()) EXPECT_EQ(metric.of(c), 0.0) << metric.name;
    EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, BlackIsAsBrightAsBlack) {
    const Image black{{3, 2}, std::vector<glm::vec3>(6, glm::vec3(0.0f))};
    Image red = black;
    red.rgb[4].r = 1.0f;
    EXPECT_EQ(compare(black, black).mean_ratio, glm::dvec3(1.0));
    EXPECT_EQ(compare(red, black).mean_ratio, glm::dvec3(std::numeric_limits<double>::infinity(), 1.0, 1.0));
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
    for (const Metric& metric : metrics()) {
        EXPECT_EQ(metric.of(c), metric.of(rest)) << metric.name;
        EXPECT_TRUE(std::isfinite(metric.of(c))) << metric.name << " " << metric.of(c);
    }
    EXPECT_EQ(c.psnr, rest.psnr);
}

TEST(Metrics, OfPicturesWithoutAFinitePixelAreNotANumber) {
    const Image image = picture(1, 1, {glm::vec3(std::numeric_limits<float>::quiet_NaN())});
    const Comparison c = compare(image, image);
    EXPECT_EQ(c.pixels, 0u);
    for (const Metric& metric : metrics()) EXPECT_TRUE(std::isnan(metric.of(c))) << metric.name << " " << metric.of(c);
}

TEST(Metrics, AreFoundByTheirNames) {
    for (const Metric& metric : metrics()) EXPECT_EQ(&find_metric("--stop-at", metric.name), &metric) << metric.name;
    const auto error = test::thrown_by([] { find_metric("--stop-at", "relMSE"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
    for (const char* part : {"--stop-at", "'relMSE'", "relmse_trimmed", "srgb_mse"}) {
        EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << part << " is not in: " << error->what();
    }
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
