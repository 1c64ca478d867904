#include "render/error_estimate.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "core/blocks.h"
#include "core/display.h"
#include "core/metrics.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t groups = ERROR_GROUPS;
// Of the spread's fall from groups to pairs, what it falls from groups to all, for variances ~ N^-3/2.
const double fall_of_strata = (1.0 - std::pow(groups, -0.5)) / (1.0 - std::numbers::sqrt2 / 2.0);
constexpr double rare_share = 0.5;  // of a pixel's luminance, in one group
constexpr int pooled = 2;           // pixels to each side, over which what one pixel does not tell is taken
constexpr double bound_confidence = 0.9;

glm::dvec3 colour(const glm::dvec4& sum) { return {sum.x, sum.y, sum.z}; }
double luminance_of(const glm::dvec4& sum) { return luminance(colour(sum)); }

double student(double confidence) {
    return boost::math::quantile(boost::math::students_t(double(groups - 1)), confidence);
}

/// Groups, or pairs of them, of a pixel.
template <std::size_t Count> struct Spread {
    double total = 0.0;  // iterations
    std::array<double, Count> size{};
    std::array<glm::dvec4, Count> mean{};
    glm::dvec4 mean_of_all{0.0};
    glm::dvec4 squares{0.0};  // sum of size (mean - mean_of_all)^2

    Spread(const std::array<glm::dvec4, Count>& sums, const std::array<double, Count>& sizes) : size(sizes) {
        for (std::size_t k = 0; k < Count; ++k) {
            mean[k] = sums[k] / size[k];
            mean_of_all += sums[k];
            total += size[k];
        }
        mean_of_all /= total;
        for (std::size_t k = 0; k < Count; ++k) squares += size[k] * square(mean[k] - mean_of_all);
    }

    static glm::dvec4 square(const glm::dvec4& v) { return v * v; }

    /// Squared standard error of the mean of all.
    glm::dvec4 variance() const { return squares / (total * double(Count - 1)); }

    /// Mean and squared standard error of that without one of them.
    glm::dvec4 mean_without(std::size_t k) const {
        return (total * mean_of_all - size[k] * mean[k]) / (total - size[k]);
    }
    glm::dvec4 variance_without(std::size_t k) const {
        const glm::dvec4 rest = squares - size[k] * square(mean[k] - mean_of_all) * (total / (total - size[k]));
        return glm::max(rest, 0.0) / ((total - size[k]) * double(Count - 2));
    }
};

using Groups = Spread<groups>;

constexpr std::size_t estimates = 1 + groups;  // from all groups, and without each of them

/// The picture's groups, read pixel by pixel.
class Reader {
public:
    explicit Reader(const ErrorSums& sums) : sums_(sums) { std::ranges::copy(sums.sizes, sizes_.begin()); }

    Groups groups_of(std::size_t pixel) const { return Groups(read(pixel), sizes_); }

    Spread<groups / 2> pairs_of(std::size_t pixel) const {
        const auto sums = read(pixel);
        std::array<glm::dvec4, groups / 2> pairs;
        std::array<double, groups / 2> sizes{};
        for (std::size_t k = 0; k < groups / 2; ++k) {
            pairs[k] = sums[2 * k] + sums[2 * k + 1];
            sizes[k] = sizes_[2 * k] + sizes_[2 * k + 1];
        }
        return Spread(pairs, sizes);
    }

    glm::dvec4 mean(std::size_t pixel) const {
        glm::dvec4 sum(0.0);
        for (const auto& group : sums_.of_group) sum += glm::dvec4(group[pixel]);
        return sum / double(sums_.iterations());
    }

    /// Calls visit(pixel) with those of a square about one, itself included.
    template <typename Visit> void visit_about(std::size_t pixel, const Visit& visit) const {
        const int width = int(sums_.extent.width), height = int(sums_.extent.height);
        const int x = int(pixel) % width, y = int(pixel) / width;
        for (int v = std::max(y - pooled, 0); v <= std::min(y + pooled, height - 1); ++v) {
            for (int u = std::max(x - pooled, 0); u <= std::min(x + pooled, width - 1); ++u) {
                visit(std::size_t(v) * sums_.extent.width + std::size_t(u));
            }
        }
    }

private:
    std::array<glm::dvec4, groups> read(std::size_t pixel) const {
        std::array<glm::dvec4, groups> sums;
        for (std::size_t k = 0; k < groups; ++k) sums[k] = glm::dvec4(sums_.of_group[k][pixel]);
        return sums;
    }

    const ErrorSums& sums_;
    std::array<double, groups> sizes_{};
};

/// True where one group has found more than half of the luminance.
bool is_rare(const Groups& spread) {
    double most = 0.0;
    for (std::size_t k = 0; k < groups; ++k) most = std::max(most, spread.size[k] * luminance_of(spread.mean[k]));
    return most > rare_share * spread.total * luminance_of(spread.mean_of_all);
}

/// The share of a pixel's radiance that its bias leaves: what dark pixels have from bright ones close by is not to hide
/// how wrong they are. B counts by as much as it stands out of twice its noise (shrunk as James and Stein 1961 do), and
/// never to make an error smaller.
double share_without_bias(const Groups& spread) {
    const double radiance = luminance_of(spread.mean_of_all), bias = spread.mean_of_all.w;
    if (!(radiance > 0.0) || !(bias > 0.0)) return 1.0;
    const double sure = std::max(0.0, 1.0 - 4.0 * spread.variance().w / (bias * bias));
    return std::max(0.0, 1.0 - sure * bias / radiance);
}

/// What squared errors are divided by, a channel: r^2 + 0.01, as relMSE has it. A pixel that rests on one find would
/// hide its own error: its truth r may be anything from what its neighbours have, l, to what it has itself, x. Were all
/// in between as likely, the mean of (x - r)^2 / (r^2 + 0.01) would be pi / 2 x / sqrt(l^2 + 0.01) for small l, as with
/// 2 / pi of the geometric mean of x^2 and l^2 + 0.01 for a divisor.
glm::dvec3 divisor_of(const Reader& reader, std::size_t pixel, const Groups& spread) {
    const auto divisor = [](const glm::dvec3& level) { return level * level + relmse_epsilon; };
    if (!is_rare(spread)) return divisor(colour(spread.mean_of_all) * share_without_bias(spread));
    glm::dvec3 sum(0.0);
    double count = 0.0;
    reader.visit_about(pixel, [&](std::size_t at) {
        if (at == pixel) return;
        sum += colour(reader.mean(at));
        count += 1.0;
    });
    const glm::dvec3 own = divisor(colour(spread.mean_of_all));
    return 2.0 / std::numbers::pi * glm::sqrt(own * divisor(sum / std::max(count, 1.0)));
}

/// Of a pixel, relative to x^2 + 0.01 as relMSE is.
struct PixelError {
    std::array<float, estimates> noise{};           // v, mean of the channels; without a group as if of all iterations
    std::array<float, estimates> bias{};            // B^2 - v_B
    std::array<float, estimates> noise_of_pairs{};  // the same from pairs of groups; without a group's pair
    float largest = 0.0f;                           // bias, if all of B were it
    float luminance = 0.0f;
    bool rare = false;
};

PixelError error_of(const Reader& reader, std::size_t pixel) {
    const Groups spread = reader.groups_of(pixel);
    const glm::dvec3 divisor = divisor_of(reader, pixel, spread);
    const glm::dvec3 weight = 1.0 / (3.0 * divisor);
    const double bias_weight = 1.0 / luminance(divisor);
    const auto noise = [&](const glm::dvec4& variance) { return glm::dot(colour(variance), weight); };
    const auto bias = [&](double b, double variance) { return bias_weight * (b * b - variance); };
    const glm::dvec4 of_all = spread.variance();
    PixelError error;
    error.noise[0] = float(noise(of_all));
    error.bias[0] = float(bias(spread.mean_of_all.w, of_all.w));
    for (std::size_t k = 0; k < groups; ++k) {
        const glm::dvec4 variance = spread.variance_without(k);
        error.noise[1 + k] = float(noise(variance) * (spread.total - spread.size[k]) / spread.total);
        error.bias[1 + k] = float(bias(spread.mean_without(k).w, variance.w));
    }
    const auto pairs = reader.pairs_of(pixel);
    error.noise_of_pairs[0] = float(noise(pairs.variance()));
    for (std::size_t k = 0; k < groups; ++k) {
        const double left = (pairs.total - pairs.size[k / 2]) / pairs.total;
        error.noise_of_pairs[1 + k] = float(noise(pairs.variance_without(k / 2)) * left);
    }
    error.largest = float(bias_weight * spread.mean_of_all.w * spread.mean_of_all.w);
    error.luminance = float(luminance_of(spread.mean_of_all));
    error.rare = is_rare(spread);
    return error;
}

/// The estimate and its bar by the jackknife: values of all groups, and without each.
Expected jackknife(const std::array<double, estimates>& values) {
    const double mean = std::accumulate(values.begin() + 1, values.end(), 0.0) / double(groups);
    double squares = 0.0;
    for (std::size_t k = 1; k < estimates; ++k) squares += (values[k] - mean) * (values[k] - mean);
    return {values[0], std::sqrt(double(groups - 1) / double(groups) * squares)};
}

/// What the strata of eye paths leave of the noise that the groups show, from the pixels `at`: about 1 where there is
/// no such part, by chance more. Nothing leaves less than groups that were strata of one another.
std::array<double, estimates> fall_of(const std::vector<PixelError>& errors, std::span<const std::uint32_t> at) {
    std::array<double, estimates> of_groups{}, of_pairs{}, fall{};
    for (const std::uint32_t pixel : at) {
        for (std::size_t k = 0; k < estimates; ++k) {
            of_groups[k] += errors[pixel].noise[k];
            of_pairs[k] += errors[pixel].noise_of_pairs[k];
        }
    }
    for (std::size_t k = 0; k < estimates; ++k) {
        const double ratio = of_groups[k] > 0.0 ? of_pairs[k] / of_groups[k] : 1.0;
        fall[k] = std::max(1.0 - fall_of_strata * (1.0 - ratio), 1.0 / double(groups));
    }
    return fall;
}

/// Over the pixels `at`.
ExpectedRelmse relmse_of(const std::vector<PixelError>& errors, std::span<const std::uint32_t> at,
                         const std::array<double, estimates>& fall) {
    std::array<double, estimates> noise{}, bias{}, sum{};
    for (const std::uint32_t pixel : at) {
        for (std::size_t k = 0; k < estimates; ++k) {
            noise[k] += fall[k] * errors[pixel].noise[k] / double(at.size());
            bias[k] += errors[pixel].bias[k] / double(at.size());
        }
    }
    std::ranges::transform(noise, bias, sum.begin(), std::plus<>());
    return {jackknife(sum), noise[0], bias[0]};
}

/// The median over pixels of the relative standard error.
Expected median_noise(const std::vector<PixelError>& errors, const std::array<double, estimates>& fall) {
    std::array<double, estimates> medians{};
    std::vector<float> values(errors.size());
    for (std::size_t k = 0; k < estimates; ++k) {
        std::ranges::transform(errors, values.begin(), [&](const PixelError& error) { return error.noise[k]; });
        const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
        std::ranges::nth_element(values, middle);
        medians[k] = std::sqrt(fall[k] * double(*middle));
    }
    return jackknife(medians);
}

/// The same of means over blocks: a picture whose pixels are the blocks. Without the bias.
ErrorSums in_blocks(const ErrorSums& sums, std::uint32_t side) {
    ErrorSums blocks{blocks_of(sums.extent, side), sums.sizes, {}};
    for (std::size_t k = 0; k < groups; ++k) {
        const std::vector<glm::dvec3> of_pixels(sums.of_group[k].begin(), sums.of_group[k].end());
        for (const glm::dvec3& mean : block_means(sums.extent, side, of_pixels)) {
            blocks.of_group[k].emplace_back(mean, 0.0);
        }
    }
    return blocks;
}

/// [P] Standard errors, root mean square over the channels of colour.
std::vector<float> standard_errors(const ErrorSums& sums) {
    const Reader reader(sums);
    std::vector<float> errors(sums.extent.pixels());
    tbb::parallel_for(std::size_t(0), errors.size(), [&](std::size_t pixel) {
        const glm::dvec3 squares = colour(reader.groups_of(pixel).variance());
        errors[pixel] = float(std::sqrt((squares.x + squares.y + squares.z) / 3.0));
    });
    return errors;
}

}  // namespace

std::uint32_t error_group(std::uint32_t iteration) {
    if (iteration < groups) return iteration;
    const auto octave = std::uint32_t(std::bit_width(iteration)) - 1;
    const std::uint32_t run = (iteration - (1u << octave)) / ((1u << octave) / groups);
    return octave % 2 == 0 ? run : groups - 1 - run;
}

std::array<std::uint32_t, ERROR_GROUPS> group_sizes(std::uint32_t iterations) {
    std::array<std::uint32_t, groups> sizes{};
    for (std::uint32_t group = 0; group < std::min(iterations, groups); ++group) sizes[group] = 1;
    for (std::uint64_t octave = groups; octave < iterations; octave *= 2) {
        const std::uint64_t run = octave / groups;
        for (std::uint64_t first = octave; first < std::min<std::uint64_t>(2 * octave, iterations); first += run) {
            sizes[error_group(std::uint32_t(first))] += std::uint32_t(std::min(run, iterations - first));
        }
    }
    return sizes;
}

std::uint32_t ErrorSums::iterations() const { return std::accumulate(sizes.begin(), sizes.end(), 0u); }

bool can_estimate(const ErrorSums& sums) {
    return std::ranges::all_of(sums.sizes, [](std::uint32_t size) { return size >= least_estimated / groups; });
}

double upper_bound(const Expected& expected, double confidence) {
    const double bar = student(confidence) * expected.standard_error;
    return expected.value > 0.0 ? expected.value * std::exp(bar / expected.value) : bar;
}

std::optional<std::string> warning_of(const ErrorEstimate& estimate) {
    constexpr double much = 0.01;  // what is found once is missed as often
    if (estimate.rare <= much) return std::nullopt;
    return fmt::format(
        "{:.2g} % of the picture's light is in pixels that have found most of theirs in one of {} parts of the "
        "iterations: other pixels may have missed such light, which no estimate of the error knows",
        100.0 * estimate.rare, groups);
}

std::span<const EstimatedMeasure> estimated_measures() {
    static constexpr EstimatedMeasure table[] = {
        {"relmse", [](const ErrorEstimate& e) -> const Expected& { return e.relmse.error; }},
        {"relmse_trimmed", [](const ErrorEstimate& e) -> const Expected& { return e.relmse_trimmed.error; }},
        {"noise", [](const ErrorEstimate& e) -> const Expected& { return e.noise; }},
    };
    return table;
}

double upper_bound(const Target& target, const ErrorEstimate& estimate) {
    return upper_bound(target.measure->of(estimate), target.confidence);
}

bool is_met(const Target& target, const std::optional<ErrorEstimate>& estimate) {
    return estimate && upper_bound(target, *estimate) <= target.value;
}

bool is_look(std::uint32_t iterations) {
    std::uint64_t look = 2 * least_estimated;
    while (look < iterations) look += look / 8;
    return look == iterations;
}

ErrorEstimate estimate_error(const ErrorSums& sums) {
    assert(can_estimate(sums));
    const Reader reader(sums);
    std::vector<PixelError> errors(sums.extent.pixels());
    tbb::parallel_for(std::size_t(0), errors.size(), [&](std::size_t i) { errors[i] = error_of(reader, i); });
    // The worst last, by what is expected of them.
    std::vector<std::uint32_t> order(errors.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t kept = order.size() - order.size() / trimmed_one_in;
    std::ranges::nth_element(order, order.begin() + std::ptrdiff_t(kept), {},
                             [&](std::uint32_t pixel) { return errors[pixel].noise[0] + errors[pixel].largest; });
    const std::span<const std::uint32_t> trimmed = std::span(order).first(kept);
    const std::array<double, estimates> fall = fall_of(errors, trimmed);
    ErrorEstimate estimate;
    estimate.relmse = relmse_of(errors, order, fall);
    estimate.relmse_trimmed = relmse_of(errors, trimmed, fall);
    estimate.noise = median_noise(errors, fall);
    double rare = 0.0, all = 0.0;
    for (const PixelError& error : errors) {
        rare += error.rare ? error.luminance : 0.0f;
        all += error.luminance;
    }
    estimate.rare = all > 0.0 ? rare / all : 0.0;
    return estimate;
}

std::map<std::string, std::vector<float>> error_channels(const ErrorSums& sums) {
    const Reader reader(sums);
    const std::size_t pixels = sums.extent.pixels();
    std::vector<double> of_pixels(pixels);  // B
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) of_pixels[pixel] = reader.mean(pixel).w;
    std::map<std::string, std::vector<float>> channels;
    const std::vector<float>& error = channels["StdErr"] = standard_errors(sums);
    std::vector<float>& bias = channels["Bias"];
    std::vector<float>& bound = channels["Bound"];
    const double t = student(0.5 + 0.5 * bound_confidence);  // of both sides
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        double found = 0.0, count = 0.0;
        reader.visit_about(pixel, [&](std::size_t at) {
            found += of_pixels[at];
            count += 1.0;
        });
        bias.push_back(float(found / count));
        bound.push_back(float(t * error[pixel] + std::abs(double(bias.back()))));
    }
    for (const std::uint32_t side : block_sides(sums.extent)) {
        const std::vector<float> of_blocks = standard_errors(in_blocks(sums, side));
        std::vector<float>& values = channels[fmt::format("StdErr.{}", side)];
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            values.push_back(of_blocks[block_at(sums.extent, side, pixel)]);
        }
    }
    return channels;
}

}  // namespace vkcppm
