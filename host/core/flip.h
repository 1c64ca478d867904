#pragma once
// FLIP: what an observer sees who flips between a picture and its reference (Andersson, Nilsson, Akenine-Moeller,
// Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM CGIT 3(2), 2020;
// Andersson, Nilsson, Shirley and Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range Images",
// Eurographics 2021 short papers).

#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Pixels to a degree of sight, as both papers have it: 3,840 on a screen of 0.7 m, seen from 0.7 m.
inline constexpr double flip_pixels_a_degree = 67.02064327658225;

struct Flip {
    std::vector<float> error;  // [pixels] 0..1; 0 where a picture is not finite
    double mean = 0.0;         // over the pixels that are finite in both; NaN where there are none
};

/// LDR-FLIP of the 8-bit sRGB encodings of radiance (srgb_byte). Asserts that the sizes are the same.
Flip ldr_flip(const Image& image, const Image& reference);

/// HDR-FLIP: at every pixel the largest LDR-FLIP over exposures about a stop apart, from that at which the reference's
/// brightest pixel is 85 % of white to that at which its median is, by aces_curve. Negative radiance is black.
Flip hdr_flip(const Image& image, const Image& reference);

/// The exposures of the reference, stops, in ascending order; one of 0 where it is black.
std::vector<double> flip_exposures(const Image& reference);

}  // namespace vkcppm
