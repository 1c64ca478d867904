#pragma once
// How radii go on after the first iterations of a render, its pilot, where later ones know nothing of each other.
//
// Progressive photon mapping gives an iteration the radius that those before it have led to. Of a pixel whose radius is
// R_M after a pilot of M iterations it is fixed here for all that follow: R^2(i) = R_M^2 (i / M)^-e, iterations counted
// from 0, which is the rule of Knaus and Zwicker (2011) for e = 1 - alpha. Bias of a disc is proportional to R^2 where
// light is smooth, so that the mean over a slice of iterations stands for each of them.

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "render/settings.h"
#include "shared/types.h"

namespace vkcppm {

/// [P] e. before, after: what pixels remember after M / 2 and M iterations.
std::vector<float> exponents_of(const Settings& settings, const Extent& extent, std::span<const gpu::PixelState> before,
                                std::span<const gpu::PixelState> after);

/// Mean of R^2(i) / R_M^2 over the iterations from `first` on, `count` of them; by its integral.
double mean_shrink(double exponent, std::uint32_t pilot, std::uint32_t first, std::uint32_t count);

}  // namespace vkcppm
