#pragma once
// How far a picture is from its reference, in the measures that the field uses.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

/// What relMSE adds to r^2, so that black pixels of the reference do not decide it.
inline constexpr double relmse_epsilon = 0.01;

/// The share of pixels that a trimmed measure leaves out: floor(pixels / 1000).
inline constexpr std::size_t trimmed_one_in = 1000;

/// A mean of squared or relative errors over pixels.
struct Measure {
    double all = 0.0;
    double trimmed = 0.0;  // without the pixels where it is largest, one in trimmed_one_in
};

/// Means run over the pixels that are finite in both pictures, and over channels where not said otherwise.
/// x is the image's value, r the reference's. Without any such pixel every measure is NaN.
struct Comparison {
    Extent extent;
    std::size_t image_non_finite = 0;      // pixels with NaN or infinity in a channel of the image
    std::size_t reference_non_finite = 0;  // the same in the reference
    std::size_t pixels = 0;                // pixels compared: finite in both
    glm::dvec3 mean_ratio{0.0};            // mean(x) / mean(r) a channel; 1 where both are black, infinite where r is
    Measure mse;                           // (x - r)^2, (W m^-2 sr^-1)^2
    Measure rmse;                          // the square root of mse, W m^-2 sr^-1
    Measure relmse;                        // (x - r)^2 / (r^2 + 0.01)
    Measure smape;                         // |x - r| / (|x| + |r|), 0 where both are 0: 0..1
    Measure srgb_mse;                      // (X - R)^2 of the 8-bit sRGB encodings, 0..255^2
    double psnr = 0.0;                     // dB, 10 log10(255^2 / srgb_mse.all); infinite where that is 0
};

/// Throws Error(usage) where the sizes differ.
Comparison compare(const Image& image, const Image& reference);

/// A measure by its name on the command line and in files, "relmse" or "relmse_trimmed"; smaller is nearer.
struct Metric {
    std::string_view name;
    std::string_view title;  // for people
    Measure Comparison::*measure;
    double Measure::*part;
    double of(const Comparison& comparison) const { return (comparison.*measure).*part; }
};

/// All of them, in the order in which they are told.
std::span<const Metric> metrics();

/// What is told where nobody asks for another: relMSE, which compares renderers whatever the exposure, without the few
/// pixels that decide it alone.
const Metric& default_metric();

/// Their names, separated by commas.
std::string metric_names();

/// Throws Error(usage) with the names that there are; `option` is what asked for it.
const Metric& find_metric(std::string_view option, std::string_view name);

}  // namespace vkcppm
