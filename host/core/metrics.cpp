#include "core/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/srgb.h"

namespace vkcppm {
namespace {

constexpr double relative_epsilon = 0.01;  // keeps black pixels of the reference from deciding relMSE
constexpr std::size_t trimmed_one_in = 1000;

bool finite(const glm::vec3& pixel) {
    return std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b);
}

double mean(const std::vector<double>& values, std::size_t count) {
    return std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(count), 0.0) / double(count);
}

std::string text(const Extent& extent) {
    return std::to_string(extent.width) + "x" + std::to_string(extent.height);
}

}  // namespace

Comparison compare(const Image& image, const Image& reference) {
    if (image.extent != reference.extent) {
        throw Error(ExitCode::usage, "the image is " + text(image.extent) + " pixels, the reference " +
                                         text(reference.extent) + ": only pictures of one size can be compared");
    }
    Comparison result;
    result.extent = image.extent;
    glm::dvec3 image_sum{0.0};
    glm::dvec3 reference_sum{0.0};
    std::vector<double> relative;  // [pixels compared] mean over the channels
    relative.reserve(image.rgb.size());
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const bool image_finite = finite(image.rgb[i]);
        const bool reference_finite = finite(reference.rgb[i]);
        result.image_non_finite += !image_finite;
        result.reference_non_finite += !reference_finite;
        if (!image_finite || !reference_finite) {
            continue;
        }
        double relative_pixel = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double x = image.rgb[i][c];
            const double r = reference.rgb[i][c];
            const double squared = (x - r) * (x - r);
            const double levels = double(srgb_byte(x)) - double(srgb_byte(r));
            image_sum[c] += x;
            reference_sum[c] += r;
            result.mse += squared;
            result.srgb_mse += levels * levels;
            relative_pixel += squared / (r * r + relative_epsilon);
        }
        relative.push_back(relative_pixel / 3.0);
    }
    result.pixels = relative.size();
    result.mean_ratio = image_sum / reference_sum;
    result.mse /= 3.0 * double(result.pixels);
    result.srgb_mse /= 3.0 * double(result.pixels);
    result.psnr = 10.0 * std::log10(255.0 * 255.0 / result.srgb_mse);
    result.relative_mse = mean(relative, result.pixels);
    const std::size_t kept = result.pixels - result.pixels / trimmed_one_in;
    std::nth_element(relative.begin(), relative.begin() + std::ptrdiff_t(kept), relative.end());
    result.trimmed_relative_mse = mean(relative, kept);
    return result;
}

}  // namespace vkcppm
