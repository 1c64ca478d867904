#include "core/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <tbb/parallel_for.h>

#include "core/display.h"
#include "core/srgb.h"

namespace vkcppm {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double target_white = 0.85;  // of the exposures
constexpr double colour_power = 0.7, feature_power = 0.5;
constexpr double knee = 0.4, knee_error = 0.95;  // of the largest colour difference, and the error it becomes
constexpr double feature_width = 0.082;          // degrees of sight

// Linear sRGB to XYZ, and the white of D65.
const glm::dmat3 to_xyz = glm::transpose(glm::dmat3(10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794,
                                                    2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897,
                                                    1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382));
const glm::dmat3 from_xyz = glm::inverse(to_xyz);
const glm::dvec3 white = to_xyz * glm::dvec3(1.0);

using Plane = std::vector<glm::dvec4>;  // [pixels]

/// YCxCz, the opponent space in which contrast sensitivity is known; linear in linear RGB.
glm::dvec3 opponent(const glm::dvec3& linear) {
    const glm::dvec3 xyz = to_xyz * linear / white;
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

glm::dvec3 linear_of(const glm::dvec3& opponent) {
    const double y = (opponent.x + 16.0) / 116.0;
    return from_xyz * (white * glm::dvec3(y + opponent.y / 500.0, y, y - opponent.z / 200.0));
}

/// CIELAB, chroma in proportion to lightness (the effect of Hunt).
glm::dvec3 lab(const glm::dvec3& linear) {
    glm::dvec3 xyz = to_xyz * linear / white;
    constexpr double delta = 6.0 / 29.0;
    for (int c = 0; c < 3; ++c) {
        xyz[c] = xyz[c] > delta * delta * delta ? std::cbrt(xyz[c]) : xyz[c] / (3.0 * delta * delta) + 4.0 / 29.0;
    }
    const double lightness = 116.0 * xyz.y - 16.0;
    return {lightness, 0.01 * lightness * 500.0 * (xyz.x - xyz.y), 0.01 * lightness * 200.0 * (xyz.y - xyz.z)};
}

/// HyAB, the distance for large differences of colour.
double distance(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::abs(d.x) + std::hypot(d.y, d.z);
}

/// Weights of a filter along one axis for the four components, [2 radius + 1].
using Weights = std::vector<glm::dvec4>;

/// What is beyond the edge is as the edge.
Plane filtered_along_rows(const Plane& picture, Extent extent, const Weights& weights) {
    const std::size_t width = extent.width, radius = weights.size() / 2;
    Plane result(picture.size());
    tbb::parallel_for(std::size_t(0), std::size_t(extent.height), [&](std::size_t y) {
        const auto row = picture.begin() + std::ptrdiff_t(y * width);
        Plane padded(radius, row[0]);
        padded.insert(padded.end(), row, row + std::ptrdiff_t(width));
        padded.insert(padded.end(), radius, row[std::ptrdiff_t(width) - 1]);
        for (std::size_t x = 0; x < width; ++x) {
            glm::dvec4 sum(0.0);
            for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * padded[x + i];
            result[y * width + x] = sum;
        }
    });
    return result;
}

Plane filtered_along_columns(const Plane& picture, Extent extent, const Weights& weights) {
    const std::int64_t width = extent.width, height = extent.height, radius = std::int64_t(weights.size() / 2);
    Plane result(picture.size(), glm::dvec4(0.0));
    tbb::parallel_for(std::int64_t(0), height, [&](std::int64_t y) {
        for (std::int64_t i = -radius; i <= radius; ++i) {
            const std::int64_t from = std::clamp<std::int64_t>(y + i, 0, height - 1) * width;
            const glm::dvec4& weight = weights[std::size_t(i + radius)];
            for (std::int64_t x = 0; x < width; ++x) {
                result[std::size_t(y * width + x)] += weight * picture[std::size_t(from + x)];
            }
        }
    });
    return result;
}

/// The numbers over their sum.
std::vector<double> normalized(std::vector<double> values) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    for (double& value : values) value /= sum;
    return values;
}

/// Contrast sensitivity, exp(-pi^2 x^2 / b) at x degrees of sight: a Gaussian each for lightness and red-green, the sum
/// of two for blue-yellow. A sum does not part into rows and columns, its terms do: they are two components.
struct Sensitivity {
    Weights weights;      // of Y, Cx and, twice, Cz
    double narrow = 0.0;  // the part of the last component of Cz

    Sensitivity() {
        constexpr double b[] = {0.0047, 0.0053, 0.04, 0.025}, a[] = {0.0, 0.0, 34.1, 13.5};  // a: of the last two
        const int radius = int(std::ceil(3.0 * std::sqrt(b[2] / (2.0 * pi * pi)) * flip_pixels_a_degree));
        std::vector<double> gaussians[4];
        double parts[4];  // of a term: its factor times its sum over the plane
        for (int k = 0; k < 4; ++k) {
            for (int i = -radius; i <= radius; ++i) {
                const double x = i / flip_pixels_a_degree;
                gaussians[k].push_back(std::exp(-pi * pi * x * x / b[k]));
            }
            const double sum = std::accumulate(gaussians[k].begin(), gaussians[k].end(), 0.0);
            parts[k] = a[k] * std::sqrt(pi / b[k]) * sum * sum;
            gaussians[k] = normalized(gaussians[k]);
        }
        narrow = parts[3] / (parts[2] + parts[3]);
        for (std::size_t i = 0; i < gaussians[0].size(); ++i) {
            weights.emplace_back(gaussians[0][i], gaussians[1][i], gaussians[2][i], gaussians[3][i]);
        }
    }
};

/// What is left of the colours at that distance, as CIELAB with Hunt's effect. opponents: Y, Cx, Cz, Cz
Plane seen_colours(const Plane& opponents, Extent extent) {
    static const Sensitivity sensitivity;
    Plane seen = filtered_along_rows(opponents, extent, sensitivity.weights);
    seen = filtered_along_columns(seen, extent, sensitivity.weights);
    tbb::parallel_for(std::size_t(0), seen.size(), [&](std::size_t i) {
        const glm::dvec3 left(seen[i].x, seen[i].y, std::lerp(seen[i].z, seen[i].w, sensitivity.narrow));
        seen[i] = glm::dvec4(lab(glm::clamp(linear_of(left), 0.0, 1.0)), 0.0);
    });
    return seen;
}

/// A Gaussian, its first and its second derivative: positive weights of sum 1, negative ones of -1.
std::vector<glm::dvec3> feature_filters() {
    const double deviation = 0.5 * feature_width * flip_pixels_a_degree;
    const int radius = int(std::ceil(3.0 * deviation));
    std::vector<glm::dvec3> filters;
    glm::dvec3 positive(0.0), negative(0.0);
    for (int i = -radius; i <= radius; ++i) {
        const double g = std::exp(-i * i / (2.0 * deviation * deviation));
        filters.emplace_back(g, -i * g, (i * i / (deviation * deviation) - 1.0) * g);
        positive += glm::max(filters.back(), 0.0);
        negative -= glm::min(filters.back(), 0.0);
    }
    for (glm::dvec3& filter : filters) {
        for (int c = 0; c < 3; ++c) filter[c] /= filter[c] < 0.0 ? negative[c] : positive[c];
    }
    return filters;
}

/// [pixels] x: edges, the length of the gradient of the lightness; y: points, that of its second derivatives.
std::vector<glm::dvec2> features(const Plane& opponents, Extent extent) {
    Weights along_rows, along_columns;
    for (const glm::dvec3& filter : feature_filters()) {
        along_rows.emplace_back(filter.x, filter.x, filter.y, filter.z);
        along_columns.emplace_back(filter.y, filter.z, filter.x, filter.x);
    }
    Plane lightness;
    for (const glm::dvec4& pixel : opponents) lightness.emplace_back((pixel.x + 16.0) / 116.0);
    const Plane derivatives =
        filtered_along_columns(filtered_along_rows(lightness, extent, along_rows), extent, along_columns);
    std::vector<glm::dvec2> found;
    for (const glm::dvec4& d : derivatives) found.emplace_back(std::hypot(d.x, d.z), std::hypot(d.y, d.w));
    return found;
}

/// The error a pixel of two pictures, 0..1. Pictures: Y, Cx, Cz, Cz
std::vector<double> flip(const Plane& image, const Plane& reference, Extent extent) {
    static const double largest = std::pow(distance(lab({0.0, 1.0, 0.0}), lab({0.0, 0.0, 1.0})), colour_power);
    const std::vector<glm::dvec2> x = features(image, extent), r = features(reference, extent);
    const Plane image_colours = seen_colours(image, extent), reference_colours = seen_colours(reference, extent);
    std::vector<double> errors(image.size());
    tbb::parallel_for(std::size_t(0), errors.size(), [&](std::size_t i) {
        const double part =
            std::pow(distance(glm::dvec3(image_colours[i]), glm::dvec3(reference_colours[i])), colour_power) / largest;
        const double colour =
            part < knee ? part / knee * knee_error : knee_error + (part - knee) / (1.0 - knee) * (1.0 - knee_error);
        const glm::dvec2 difference = glm::abs(x[i] - r[i]);
        const double feature = std::max(difference.x, difference.y) / std::numbers::sqrt2;
        errors[i] = std::pow(colour, 1.0 - std::pow(feature, feature_power));
    });
    return errors;
}

/// Of the pictures as `screen` shows them, the largest over `exposures`.
Flip largest_flip(const Image& image, const Image& reference, const std::vector<double>& exposures,
                  const std::function<double(double radiance)>& screen) {
    assert(image.extent == reference.extent);
    Flip result{std::vector<float>(image.rgb.size(), 0.0f)};
    std::vector<bool> counts;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        counts.push_back(is_finite(image.rgb[i]) && is_finite(reference.rgb[i]));
    for (const double exposure : exposures) {
        Plane planes[2];
        const Image* pictures[] = {&image, &reference};
        for (int p = 0; p < 2; ++p) {
            for (std::size_t i = 0; i < image.rgb.size(); ++i) {
                glm::dvec3 linear(0.0);
                for (int c = 0; counts[i] && c < 3; ++c) {
                    linear[c] = screen(std::exp2(exposure) * std::max(double(pictures[p]->rgb[i][c]), 0.0));
                }
                const glm::dvec3 seen = opponent(linear);
                planes[p].emplace_back(seen, seen.z);
            }
        }
        const std::vector<double> errors = flip(planes[0], planes[1], image.extent);
        for (std::size_t i = 0; i < errors.size(); ++i) result.error[i] = std::max(result.error[i], float(errors[i]));
    }
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < result.error.size(); ++i) {
        if (!counts[i]) result.error[i] = 0.0f;
        sum += result.error[i];
        count += counts[i] ? 1.0 : 0.0;
    }
    result.mean = sum / count;
    return result;
}

/// The x at which aces_curve is `y`.
double aces_inverse(double y) {
    // y = (a x^2 + b x) / (c x^2 + d x + e), with x the radiance times 0.6
    const double square = 2.51 - 2.43 * y, linear = 0.03 - 0.59 * y, constant = -0.14 * y;
    return (-linear + std::sqrt(linear * linear - 4.0 * square * constant)) / (2.0 * square) / 0.6;
}

}  // namespace

std::vector<double> flip_exposures(const Image& reference) {
    std::vector<double> luminances;
    for (const glm::vec3& pixel : reference.rgb) {
        if (is_finite(pixel)) luminances.push_back(luminance(glm::max(pixel, 0.0f)));
    }
    if (luminances.empty()) return {0.0};
    std::ranges::sort(luminances);
    const double brightest = luminances.back();
    if (!(brightest > 0.0)) return {0.0};
    const double limit = aces_inverse(target_white);
    const double first = std::log2(limit / brightest);
    // Where most of it is black, as the authors' program does (version 1.7): the difference of 1 to the next float.
    const double median = std::max(luminances[luminances.size() / 2], std::min(brightest, 0x1p-23));
    const double last = std::log2(limit / median);
    const int steps = std::max(2, int(std::ceil(last - first)));
    std::vector<double> exposures;
    for (int i = 0; i < steps; ++i) exposures.push_back(std::lerp(first, last, double(i) / (steps - 1)));
    return exposures;
}

Flip ldr_flip(const Image& image, const Image& reference) {
    return largest_flip(image, reference, {0.0},
                        [](double x) { return double(srgb_to_linear(float(srgb_byte(x)) / 255.0f)); });
}

Flip hdr_flip(const Image& image, const Image& reference) {
    return largest_flip(image, reference, flip_exposures(reference),
                        [](double x) { return std::min(aces_curve(std::min(x, 1e30)), 1.0); });
}

}  // namespace vkcppm
