#pragma once
// Values as colours from blue to red.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

/// 8-bit sRGB from blue (t = 0) over pale yellow to red (t = 1); t is clamped. The eleven classes of ColorBrewer's
/// RdYlBu (Harrower and Brewer 2003), which the colour-blind can tell apart, interpolated.
glm::u8vec3 false_colour(double t);

/// Where values lie from 0 to 1.
struct ColourScale {
    double low = 0.0;
    double high = 1.0;
    bool logarithmic = false;

    /// Absent for what is not finite, and for what is not > 0 on a logarithmic scale.
    std::optional<double> position(double value) const;
};

/// The value that a share of `part` (0..1) of those that are finite and > 0 do not exceed; 0 where there are none.
double positive_quantile(std::span<const float> values, double part);

/// [pixels] |x - r|, the mean over the channels, W m^-2 sr^-1; pictures of one size.
std::vector<float> absolute_difference(const Image& image, const Image& reference);

/// values [pixels of extent]; those without a position are gray.
Bitmap false_colours(Extent extent, std::span<const float> values, const ColourScale& scale);

}  // namespace vkcppm
