#pragma once
// The picture that lights a scene from outside, from a file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Pixels an environment may have: 4096 x 2048.
inline constexpr std::size_t most_environment_pixels = std::size_t(1) << 23;

/// Reads an OpenEXR or Radiance picture of all directions (read_exr, decode_hdr), W m^-2 sr^-1, and continues `hash`
/// with the file's bytes. Which of the two it is follows from the file's first bytes. What is negative becomes 0, and
/// what is infinite 65504, with a line in `warnings`. Throws Error: no_input where the file is missing, bad_input where
/// it is neither, is too large, or where a pixel is no number or -infinity.
Image read_environment(const std::filesystem::path& file, std::uint64_t& hash, std::vector<std::string>& warnings);

/// The picture turned about the vertical axis, counter-clockwise seen from above (+x goes towards -z). Between whole
/// columns a pixel's light is shared by the two that it comes to lie on, so that none is lost.
Image turned(const Image& image, double degrees);

}  // namespace vkcppm
