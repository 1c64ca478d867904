// What noise explains: right pictures fail as often as is said, and wrong ones are found. Pictures are made of batches
// of normal noise, as those of a renderer are, with errors from the spread of the batches.

#include "study/significance.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/blocks.h"
#include "study/batch_mean.h"

namespace vkcppm {
namespace {

constexpr Extent extent{32, 24};
constexpr double noise = 0.02;  // relative standard error of a pixel
constexpr int pairs = 200;

using Truth = std::function<glm::dvec3(double x, double y)>;

/// A floor that darkens, under a round light.
glm::dvec3 room(double x, double y) {
    const double light = std::exp(-((x - 20.0) * (x - 20.0) + (y - 9.0) * (y - 9.0)) / 32.0);
    return glm::dvec3(0.5, 0.4, 0.3) * (0.6 + 0.01 * x) + glm::dvec3(light);
}

struct Noise {
    bool coloured = false;     // another number for each channel
    int reach = 0;             // pixels about one that share photons
    bool knows_blocks = true;  // the picture has errors of blocks
    std::uint32_t batches = 16;
};

/// [pixels] of variance 1, means over (2 reach + 1)^2 pixels of white noise.
std::vector<double> noise_field(std::mt19937& engine, int reach) {
    std::normal_distribution<double> normal;
    const int width = int(extent.width), height = int(extent.height), around = 2 * reach + 1;
    const int columns = width + 2 * reach;
    std::vector<double> white(std::size_t(columns) * std::size_t(height + 2 * reach));
    for (double& value : white) value = normal(engine);
    std::vector<double> field;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double sum = 0.0;
            for (int v = y; v < y + around; ++v) {
                for (int u = x; u < x + around; ++u) sum += white[std::size_t(v * columns + u)];
            }
            field.push_back(sum / around);
        }
    }
    return field;
}

std::vector<float> told(const BatchMean& means, std::size_t count) {
    std::vector<float> errors;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 squared = means.squared_error(i);
        errors.push_back(float(std::sqrt((squared.r + squared.g + squared.b) / 3.0)));
    }
    return errors;
}

NoisyPicture noisy(const Truth& truth, std::uint32_t seed, const Noise& kind = {}) {
    std::mt19937 engine(seed);
    BatchMean pixels(extent);
    std::map<std::uint32_t, BatchMean> blocks;
    for (const std::uint32_t side : block_sides(extent)) blocks.emplace(side, blocks_of(extent, side));
    for (std::uint32_t batch = 0; batch < kind.batches; ++batch) {
        std::vector<double> fields[3];
        for (auto& field : fields) {
            if (&field == fields || kind.coloured) field = noise_field(engine, kind.reach);
        }
        std::vector<glm::dvec3> values;
        for (std::size_t i = 0; i < extent.pixels(); ++i) {
            glm::dvec3 value = truth(double(i % extent.width), double(i / extent.width));
            const double scale = noise * std::sqrt(double(kind.batches));
            for (int c = 0; c < 3; ++c) value[c] *= 1.0 + scale * fields[kind.coloured ? c : 0][i];
            values.push_back(value);
        }
        pixels.add(values);
        for (auto& [side, means] : blocks) means.add(block_means(extent, side, values));
    }
    NoisyPicture picture;
    picture.mean.extent = extent;
    for (const glm::dvec3& mean : pixels.mean()) picture.mean.rgb.emplace_back(mean);
    picture.standard_error = told(pixels, extent.pixels());
    if (kind.knows_blocks) {
        for (const auto& [side, means] : blocks)
            picture.block_error[side] = told(means, blocks_of(extent, side).pixels());
    }
    picture.batches = kind.batches;
    return picture;
}

/// Of so many pairs of right pictures those that fail.
int failures(double level, const Noise& kind) {
    int count = 0;
    for (std::uint32_t i = 0; i < pairs; ++i) {
        const NoisyPicture image = noisy(room, 2 * i, kind), reference = noisy(room, 2 * i + 1, kind);
        count += test_difference(image, reference, level).differs() ? 1 : 0;
    }
    return count;
}

TEST(Significance, RightPicturesFailAtTheStatedRate) {
    // Of 200, binomial: more than 8 at a level of 1 % by chance 2e-4; at 20 %, where conservative tests would show, 40,
    // with a standard deviation of 5.7.
    EXPECT_LE(failures(0.01, {}), 8);
    const int often = failures(0.2, {});
    EXPECT_LE(often, 61);
    EXPECT_GE(often, 20);
}

TEST(Significance, HoweverTheirNoiseHangsTogether) {
    EXPECT_LE(failures(0.01, {.coloured = true}), 8);
    EXPECT_LE(failures(0.01, {.reach = 2}), 8) << "pixels share photons";
    EXPECT_LE(failures(0.01, {.reach = 2, .knows_blocks = false}), 8);
    EXPECT_LE(failures(0.01, {.batches = 8}), 8) << "few batches";
}

/// Of 20 seeds those in which the wrong picture is found; `pixels`: by single pixels.
struct Found {
    int all = 0;
    int by_pixels = 0;
};
Found found(const Truth& wrong, const Noise& kind = {}) {
    Found found;
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Significance test = test_difference(noisy(wrong, 2 * seed, kind), noisy(room, 2 * seed + 1, kind), 0.01);
        found.all += test.differs() ? 1 : 0;
        found.by_pixels += test.scales.front().differing > 0 ? 1 : 0;
    }
    return found;
}

TEST(Significance, AnAlbedoOfOnePercentIsFoundByTheWholePictureAlone) {
    const Found albedo = found([](double x, double y) { return 1.01 * room(x, y); });
    EXPECT_EQ(albedo.all, 20) << "0.35 standard errors of a pixel";
    EXPECT_LE(albedo.by_pixels, 3) << "by chance";
}

TEST(Significance, ALampThatMovedAndABlobThatIsLostAreFound) {
    EXPECT_EQ(found([](double x, double y) { return room(x + 1.0, y); }).all, 20);
    const auto blob = [](double x, double y) {
        return room(x, y) * (x >= 8.0 && x < 14.0 && y >= 16.0 && y < 22.0 ? 0.92 : 1.0);
    };
    const Found lost = found(blob);
    EXPECT_EQ(lost.all, 20) << "3 standard errors of a pixel, in 36 pixels of a block";
    EXPECT_LT(lost.by_pixels, 20);
}

TEST(Significance, AFireflyIsFoundWhereItIs) {
    NoisyPicture image = noisy(room, 1);
    image.mean.rgb[5 * extent.width + 7] *= 1.5f;
    const Significance test = test_difference(image, noisy(room, 2), 0.01);
    ASSERT_TRUE(test.differs());
    EXPECT_LT(test.p_value, 1e-6);
    EXPECT_EQ(test.scales[0].differing, 1u);
    EXPECT_EQ(test.scales[0].worst_at, 5u * extent.width + 7u);
    EXPECT_TRUE(test.scales[0].differs[5 * extent.width + 7]);
}

TEST(Significance, EveryPixelThatDiffersIsCounted) {
    NoisyPicture image = noisy(room, 1);
    for (const std::size_t i : {10u, 200u, 500u})
        image.mean.rgb[i] *= i == 200u ? 3.0f : 1.5f;  // the worst comes second
    EXPECT_EQ(test_difference(image, noisy(room, 2), 0.01).scales[0].differing, 3u);
    const double p = test_difference(noisy(room, 3), noisy(room, 4), 0.01).p_value;
    EXPECT_GT(p, 0.01);
    EXPECT_LT(p, 1.0) << "told of right pictures, too";
}

TEST(Significance, TheSamePictureHasNoDifferenceAndWhatIsNoNumberDoesNotCount) {
    NoisyPicture image = noisy(room, 1);
    EXPECT_EQ(test_difference(image, image, 0.01).p_value, 1.0);
    NoisyPicture holed = image;
    holed.mean.rgb[3].g = std::numeric_limits<float>::quiet_NaN();
    const Significance test = test_difference(holed, image, 0.01);
    EXPECT_FALSE(test.differs());
    EXPECT_EQ(test.scales[0].tests, extent.pixels() - 1);
    for (glm::vec3& pixel : holed.mean.rgb) pixel = glm::vec3(std::numeric_limits<float>::infinity());
    EXPECT_FALSE(test_difference(holed, image, 0.01).differs()) << "nothing is left to compare";
}

TEST(Significance, WithoutNoiseAnythingButRoundingDiffers) {
    NoisyPicture reference;
    reference.mean = {{2, 1}, {glm::vec3(1.0f), glm::vec3(0.0f)}};
    reference.standard_error = {0.0f, 0.0f};
    NoisyPicture image = reference;
    image.mean.rgb[0] *= 1.0f + 0x1p-12f;
    EXPECT_FALSE(test_difference(image, reference, 0.01).differs()) << "a half float rounds it away";
    image.mean.rgb[0] *= 1.01f;
    EXPECT_TRUE(test_difference(image, reference, 0.01).differs());
    image = reference;
    image.mean.rgb[1] = glm::vec3(1e-6f);
    EXPECT_TRUE(test_difference(image, reference, 0.01).differs()) << "light where there was none";
}

TEST(Blocks, CoverThePicture) {
    EXPECT_EQ(block_sides({64, 48}), (std::vector<std::uint32_t>{8, 64}));
    EXPECT_EQ(block_sides({65, 2}), (std::vector<std::uint32_t>{8, 64, 512}));
    EXPECT_EQ(block_sides({1, 1}), std::vector<std::uint32_t>{});
    EXPECT_EQ(blocks_of({20, 9}, 8), (Extent{3, 2}));
    std::vector<glm::dvec3> values;
    for (int i = 0; i < 20 * 9; ++i) values.emplace_back(i % 20, i / 20, 1.0);
    const std::vector<glm::dvec3> means = block_means({20, 9}, 8, values);
    EXPECT_EQ(means[0], glm::dvec3(3.5, 3.5, 1.0));
    EXPECT_EQ(means[5], glm::dvec3(17.5, 8.0, 1.0)) << "what is within the picture";
    EXPECT_EQ(block_at({20, 9}, 8, 8 * 20 + 19), 5u);
}

}  // namespace
}  // namespace vkcppm
