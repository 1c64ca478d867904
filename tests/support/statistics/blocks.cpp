#include "support/statistics/blocks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>

#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

/// Mean of a channel over a block of every picture: mean and variance of that mean.
std::pair<double, double> moments(const Pictures& pictures, std::uint32_t x0, std::uint32_t y0, std::uint32_t side,
                                  int channel) {
    std::vector<double> means;
    for (const Image& image : pictures) {
        double sum = 0.0;
        for (std::uint32_t y = y0; y < y0 + side; ++y) {
            for (std::uint32_t x = x0; x < x0 + side; ++x) sum += image.at(x, y)[channel];
        }
        means.push_back(sum / (double(side) * side));
    }
    const double n = double(means.size());
    double mean = 0.0, square = 0.0;
    for (const double m : means) mean += m / n;
    for (const double m : means) square += (m - mean) * (m - mean);
    return {mean, square / (n - 1.0) / n};
}

/// Welch's test, two-sided, of a difference beyond `allowed`: v1 is the variance of a mean of n pictures, v2 is known
/// from so many samples that only v1 is uncertain.
double p_value(double difference, double allowed, double v1, double v2, double n) {
    const double beyond = std::abs(difference) - allowed;
    if (beyond <= 0.0) return 1.0;
    if (v1 + v2 == 0.0) return 0.0;
    if (v1 == 0.0) return std::erfc(beyond / std::sqrt(2.0 * v2));
    const double freedom = (n - 1.0) * (1.0 + v2 / v1) * (1.0 + v2 / v1);
    return 2.0 * cdf(complement(boost::math::students_t(freedom), beyond / std::sqrt(v1 + v2)));
}

}  // namespace

oracle::PathTracerSettings oracle_settings(const Settings& settings, std::uint32_t samples) {
    oracle::PathTracerSettings oracle;
    oracle.size = *settings.size;
    oracle.samples = samples;
    oracle.seed = settings.seed;
    oracle.max_depth = settings.max_depth;
    oracle.aperture = settings.aperture;
    oracle.focus_distance = settings.focus_distance.value_or(1.0);
    return oracle;
}

Pictures render_photons(const Scene& scene, const Settings& settings, std::uint32_t parts) {
    assert(settings.iterations % parts == 0);
    Rig run(scene, settings, plain_device());
    Pictures pictures;
    Image before{*settings.size, std::vector<glm::vec3>(settings.size->pixels(), glm::vec3(0.0f))};
    for (std::uint32_t part = 0; part < parts; ++part) {
        run.integrator.run(settings.iterations / parts);
        Image now = run.integrator.resolve();  // the mean over all parts so far
        Image& picture = pictures.emplace_back(now);
        for (std::size_t i = 0; i < now.rgb.size(); ++i) {
            picture.rgb[i] = float(part + 1) * now.rgb[i] - float(part) * before.rgb[i];
        }
        before = std::move(now);
    }
    return pictures;
}

TwoWays render_two_ways(const Scene& scene, const Settings& settings, std::uint32_t parts, std::uint32_t samples) {
    return {render_photons(scene, settings, parts), oracle::path_trace(scene, oracle_settings(settings, samples))};
}

TwoScenes render_two_scenes(const Scene& one, const Scene& other, const Settings& settings, std::uint32_t parts) {
    return {render_photons(one, settings, parts), render_photons(other, settings, parts)};
}

TwoWays render_two_ways_extrapolated(const Scene& scene, Settings settings, std::uint32_t parts,
                                     std::uint32_t samples) {
    TwoWays pictures = render_two_ways(scene, settings, parts, samples);
    settings.photons = 4 * settings.photons.value_or(usual_light_paths);
    ++settings.seed;
    const Pictures fine = render_photons(scene, settings, parts);
    for (std::uint32_t part = 0; part < parts; ++part) {
        Image& image = pictures.photons[part];
        for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = 2.0f * fine[part].rgb[i] - image.rgb[i];
    }
    return pictures;
}

namespace {

/// Mean of a channel over a block, and the variance of that mean.
using BlockMoments = std::function<std::pair<double, double>(std::uint32_t x0, std::uint32_t y0, int channel)>;

/// Those of a picture that knows its standard errors.
BlockMoments moments_of(const oracle::PathTracing& picture, std::uint32_t side) {
    return [&picture, side](std::uint32_t x0, std::uint32_t y0, int c) {
        const double n = double(side) * side;
        double mean = 0.0, variance = 0.0;
        for (std::uint32_t y = y0; y < y0 + side; ++y) {
            for (std::uint32_t x = x0; x < x0 + side; ++x) {
                const double error = picture.standard_error.at(x, y)[c];
                mean += picture.mean.at(x, y)[c] / n;
                variance += error * error / (n * n);
            }
        }
        return std::pair(mean, variance);
    };
}

/// The p-value of a difference of means beyond `allowed`, given their variances.
using BlockTest = std::function<double(double difference, double allowed, double v1, double v2)>;

BlockComparison compare(Extent size, const BlockSettings& settings, const BlockMoments& photons,
                        const BlockMoments& paths, const BlockTest& test) {
    const std::uint32_t columns = size.width / settings.side, rows = size.height / settings.side;
    const double each = sidak(settings.level, std::size_t(3) * columns * rows);
    BlockComparison result;
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            for (int c = 0; c < 3; ++c) {
                const auto [m1, v1] = photons(column * settings.side, row * settings.side, c);
                const auto [m2, v2] = paths(column * settings.side, row * settings.side, c);
                const bool counts = std::sqrt(v2) <= settings.noise * m2;
                const bool differs = counts && test(m1 - m2, settings.bias * m2, v1, v2) < each;
                result.counted += counts ? 1 : 0;
                result.differing += differs ? 1 : 0;
                result.table += fmt::format(" {}{:.3f}({:.3f})",
                                            differs  ? "!"
                                            : counts ? ""
                                                     : "?",
                                            m1 / m2, std::sqrt(v1 + v2) / m2);
            }
        }
        result.table += "\n";
    }
    return result;
}

}  // namespace

namespace {

Image mean_of(const Pictures& pictures) {
    Image mean{pictures.front().extent, std::vector<glm::vec3>(pictures.front().rgb.size(), glm::vec3(0.0f))};
    for (const Image& one : pictures) {
        for (std::size_t i = 0; i < one.rgb.size(); ++i) mean.rgb[i] += one.rgb[i] / float(pictures.size());
    }
    return mean;
}

void expect_agreement(const BlockComparison& blocks, const std::string& ways, const Image& got, const Image& wanted) {
    if (blocks.differing == 0) return;
    ADD_FAILURE() << blocks.differing << " blocks differ; " << ways << ", a block and channel:\n" << blocks.table;
    leave_pictures(got, wanted, ways);
}

}  // namespace

BlockComparison expect_blocks_agree(const TwoWays& pictures, const BlockSettings& settings) {
    const BlockComparison blocks = compare_blocks(pictures, settings);
    expect_agreement(blocks, "photons over paths", mean_of(pictures.photons), pictures.paths.mean);
    return blocks;
}

BlockComparison expect_blocks_agree(const oracle::PathTracing& picture, const oracle::PathTracing& paths,
                                    const BlockSettings& settings, const std::string& ways) {
    const BlockComparison blocks = compare_blocks(picture, paths, settings);
    expect_agreement(blocks, ways, picture.mean, paths.mean);
    return blocks;
}

BlockComparison expect_blocks_agree(const TwoScenes& pictures, const BlockSettings& settings, const std::string& ways) {
    Pictures differences = pictures.one;
    for (std::size_t part = 0; part < differences.size(); ++part) {
        Image& image = differences[part];
        for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] -= pictures.other[part].rgb[i];
    }
    const double n = double(pictures.one.size());
    const BlockComparison blocks = compare(
        pictures.one.front().extent, settings,
        [&](std::uint32_t x0, std::uint32_t y0, int c) {
            const double mean = moments(pictures.one, x0, y0, settings.side, c).first;
            return std::pair(mean, moments(differences, x0, y0, settings.side, c).second);
        },
        [&](std::uint32_t x0, std::uint32_t y0, int c) {
            return std::pair(moments(pictures.other, x0, y0, settings.side, c).first, 0.0);
        },
        [n](double difference, double allowed, double v1, double v2) {
            return p_value(difference, allowed, v1, v2, n);
        });
    expect_agreement(blocks, ways, mean_of(pictures.one), mean_of(pictures.other));
    return blocks;
}

BlockComparison compare_blocks(const TwoWays& pictures, const BlockSettings& settings) {
    const auto of_parts = [&](std::uint32_t x0, std::uint32_t y0, int c) {
        return moments(pictures.photons, x0, y0, settings.side, c);
    };
    const double n = double(pictures.photons.size());
    return compare(pictures.photons.front().extent, settings, of_parts, moments_of(pictures.paths, settings.side),
                   [n](double difference, double allowed, double v1, double v2) {
                       return p_value(difference, allowed, v1, v2, n);
                   });
}

BlockComparison compare_blocks(const oracle::PathTracing& picture, const oracle::PathTracing& paths,
                               const BlockSettings& settings) {
    return compare(picture.mean.extent, settings, moments_of(picture, settings.side), moments_of(paths, settings.side),
                   [](double difference, double allowed, double v1, double v2) {
                       const double beyond = std::abs(difference) - allowed;
                       return beyond <= 0.0 ? 1.0 : std::erfc(beyond / std::sqrt(2.0 * (v1 + v2)));
                   });
}

}  // namespace vkcppm::test
