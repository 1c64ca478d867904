#pragma once
// How far a picture is from its reference, in the measures that the field uses.

#include <cstddef>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

/// Means run over the pixels that are finite in both pictures, and over channels where not said otherwise.
/// x is the image's value, r the reference's. Without any such pixel every measure is NaN.
struct Comparison {
    Extent extent;
    std::size_t image_non_finite = 0;      // pixels with NaN or infinity in a channel of the image
    std::size_t reference_non_finite = 0;  // the same in the reference
    std::size_t pixels = 0;                // pixels compared: finite in both
    glm::dvec3 mean_ratio{0.0};            // mean(x) / mean(r) a channel; infinite or NaN where the reference is black
    double mse = 0.0;                      // mean((x - r)^2)
    double relative_mse = 0.0;             // mean((x - r)^2 / (r^2 + 0.01))
    double trimmed_relative_mse = 0.0;     // the same without the floor(pixels / 1000) pixels where it is largest
    double srgb_mse = 0.0;                 // mean((X - R)^2) of the 8-bit sRGB encodings, 0..255^2
    double psnr = 0.0;                     // dB, 10 log10(255^2 / srgb_mse); infinite where srgb_mse is 0
};

/// Throws Error(usage) where the sizes differ.
Comparison compare(const Image& image, const Image& reference);

}  // namespace vkcppm
