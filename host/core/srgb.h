#pragma once
// Linear light to what a screen takes (IEC 61966-2-1).

#include <cmath>
#include <cstdint>

namespace vkcppm {

/// The sRGB transfer function: linear x in [0, 1] to the encoded value in [0, 1].
inline double srgb_encode(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }

/// Its inverse: an encoded value in [0, 1] to the linear one.
inline float srgb_to_linear(float x) { return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f); }

/// Linear x, clamped to [0, 1], encoded and rounded to 8 bits. NaN becomes 0.
inline std::uint8_t srgb_byte(double x) {
    if (!(x > 0.0)) return 0;
    return std::uint8_t(std::lround(255.0 * srgb_encode(x < 1.0 ? x : 1.0)));
}

}  // namespace vkcppm
