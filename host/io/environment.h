#pragma once
// The picture that lights a scene from outside, from a file.

#include <cstdint>
#include <filesystem>

#include "core/image.h"

namespace vkcppm {

/// Pixels an environment may have: 4096 x 2048.
inline constexpr std::size_t most_environment_pixels = std::size_t(1) << 23;

/// Reads an OpenEXR (R, G, B; float or half) or Radiance (RGBE) picture of all directions, W m^-2 sr^-1, and continues
/// `hash` with the file's bytes. Which of the two it is follows from the file's first bytes. Throws Error: no_input
/// where the file is missing, bad_scene where it is neither, is too large, or where a pixel is negative or not finite.
Image read_environment(const std::filesystem::path& file, std::uint64_t& hash);

}  // namespace vkcppm
