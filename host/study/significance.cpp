#include "study/significance.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>
#include <glm/geometric.hpp>

#include "core/blocks.h"

namespace vkcppm {
namespace {

// Files hold colours in half floats at least, 11 bits, and errors in 3 bits (app/reference_provenance.cpp): half a unit
// of the one is a standard error of its own, and the other makes an error as uncertain as so many more batches would.
constexpr double colour_rounding = 0x1p-12;
constexpr double error_freedom = 200.0;
constexpr double most_freedom = 1e6;  // the normal distribution

double square(double x) { return x * x; }

double freedom_of(std::uint32_t batches) { return 1.0 / (1.0 / (double(batches) - 1.0) + 1.0 / error_freedom); }

/// One pixel or block of both pictures.
struct Pair {
    glm::dvec3 image{0.0}, reference{0.0};
    double image_error = 0.0, reference_error = 0.0;

    /// Squared, what files leave of the colours.
    double rounding() const {
        return square(colour_rounding) * (glm::dot(image, image) + glm::dot(reference, reference)) / 3.0;
    }
    double sigma() const {
        const glm::dvec3 difference = image - reference;
        const double squared = glm::dot(difference, difference) / 3.0;
        if (squared == 0.0) return 0.0;
        return std::sqrt(squared / (square(image_error) + square(reference_error) + rounding()));
    }
    /// Welch's.
    double freedom(double image_freedom, double reference_freedom) const {
        const double v = square(image_error), w = square(reference_error);
        const double spread = v * v / image_freedom + w * w / reference_freedom;
        return spread > 0.0 ? std::min(square(v + w + rounding()) / spread, most_freedom) : most_freedom;
    }
};

/// The chance of a larger sigma.
double chance(double sigma, double freedom) {
    if (std::isinf(sigma)) return 0.0;
    return 2.0 * cdf(complement(boost::math::students_t(freedom), sigma));
}

/// The chance that any of `count` tests of a level rejects what is right; the level of one, by the inverse of their
/// number (Sidak 1967).
double any_of_level(double level, double count) { return -std::expm1(count * std::log1p(-level)); }

/// Both pictures at one scale.
struct Side {
    std::uint32_t side = 1;
    std::vector<Pair> pairs;    // [pixels or blocks]
    std::vector<double> count;  // pixels of it that are compared
};

Side pixel_side(const NoisyPicture& image, const NoisyPicture& reference) {
    Side pixels;
    for (std::size_t i = 0; i < image.mean.rgb.size(); ++i) {
        const bool compared = is_finite(image.mean.rgb[i]) && is_finite(reference.mean.rgb[i]);
        assert(!compared || (std::isfinite(image.standard_error[i]) && std::isfinite(reference.standard_error[i])));
        pixels.count.push_back(compared ? 1.0 : 0.0);
        pixels.pairs.push_back(compared ? Pair{image.mean.rgb[i], reference.mean.rgb[i], image.standard_error[i],
                                               reference.standard_error[i]}
                                        : Pair());
    }
    return pixels;
}

/// The error of a block: the file's, unless pixels of the block are left out, which it does not know of.
double error_of(const NoisyPicture& picture, std::uint32_t side, std::size_t block, bool whole, double together) {
    const auto told = picture.block_error.find(side);
    if (told == picture.block_error.end() || !whole || !std::isfinite(told->second.at(block))) return together;
    return told->second[block];
}

Side block_side(const NoisyPicture& image, const NoisyPicture& reference, const Side& pixels, std::uint32_t side) {
    const Extent extent = image.mean.extent;
    Side blocks{side, std::vector<Pair>(blocks_of(extent, side).pixels()), {}};
    blocks.count.assign(blocks.pairs.size(), 0.0);
    std::vector<bool> whole(blocks.pairs.size(), true);
    for (std::size_t i = 0; i < pixels.pairs.size(); ++i) {
        const std::size_t block = block_at(extent, side, i);
        Pair& sum = blocks.pairs[block];
        const Pair& pixel = pixels.pairs[i];
        sum.image += pixel.image;
        sum.reference += pixel.reference;
        sum.image_error += pixel.image_error;
        sum.reference_error += pixel.reference_error;
        blocks.count[block] += pixels.count[i];
        if (pixels.count[i] == 0.0) whole[block] = false;
    }
    for (std::size_t block = 0; block < blocks.pairs.size(); ++block) {
        if (blocks.count[block] == 0.0) continue;
        Pair& pair = blocks.pairs[block];
        pair.image /= blocks.count[block];
        pair.reference /= blocks.count[block];
        pair.image_error = error_of(image, side, block, whole[block], pair.image_error / blocks.count[block]);
        pair.reference_error =
            error_of(reference, side, block, whole[block], pair.reference_error / blocks.count[block]);
    }
    return blocks;
}

}  // namespace

bool Significance::differs() const {
    return std::ranges::any_of(scales, [](const Scale& scale) { return scale.differing > 0; });
}

Significance test_difference(const NoisyPicture& image, const NoisyPicture& reference, double level) {
    assert(image.mean.extent == reference.mean.extent);
    assert(level > 0.0 && level < 1.0);
    std::vector<Side> sides{pixel_side(image, reference)};
    for (const std::uint32_t side : block_sides(image.mean.extent)) {
        sides.push_back(block_side(image, reference, sides.front(), side));
    }
    Significance result;
    result.level = level;
    if (std::ranges::all_of(sides.front().count, [](double n) { return n == 0.0; })) return result;
    const double scale_level = any_of_level(level, 1.0 / double(sides.size()));
    const double image_freedom = freedom_of(image.batches), reference_freedom = freedom_of(reference.batches);
    for (const Side& side : sides) {
        const double tests = double(std::ranges::count_if(side.count, [](double n) { return n > 0.0; }));
        const double each = any_of_level(scale_level, 1.0 / tests);
        double least = 1.0;  // chance
        Scale& scale = result.scales.emplace_back();
        scale.side = side.side;
        scale.sigma.assign(side.pairs.size(), 0.0f);
        scale.differs.assign(side.pairs.size(), false);
        for (std::size_t i = 0; i < side.pairs.size(); ++i) {
            if (side.count[i] == 0.0) continue;
            ++scale.tests;
            const double sigma = side.pairs[i].sigma();
            scale.sigma[i] = float(sigma);
            if (sigma > scale.worst) {
                scale.worst = sigma;
                scale.worst_at = i;
            }
            // Student's tail is no lighter than the normal one: most are done without it.
            if (std::erfc(sigma / std::sqrt(2.0)) >= std::max(each, least)) continue;
            const double p = chance(sigma, side.pairs[i].freedom(image_freedom, reference_freedom));
            least = std::min(least, p);
            if (p < each) {
                scale.differs[i] = true;
                ++scale.differing;
            }
        }
        const double any = any_of_level(least, tests * double(sides.size()));
        result.p_value = std::min(result.p_value, any);
    }
    return result;
}

}  // namespace vkcppm
