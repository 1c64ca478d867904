#pragma once
// How radii go on after the first iterations of a render, its pilot, where later ones know nothing of each other.
//
// Progressive photon mapping gives an iteration the radius that those before it have led to. Of a pixel whose radius is
// R_M after a pilot of M iterations it is fixed here for all that follow: R^2(i) = R_M^2 (i / M)^-e, iterations counted
// from 0. The exponent is that of the estimator's own law, where it has one (`later` of shared/estimators.h), else 1/3,
// with which noise and bias fall at the same rate (Kaplanyan and Dachsbacher 2013). Exponents of each pixel, as its
// radius has shrunk in the pilot, came no nearer to one machine's picture: tests/bench/results/many_machines.md.

#include <cstdint>

#include "render/settings.h"

namespace vkcppm {

/// e of the settings' estimator, between 0 and 1.
double shrink_exponent(const Settings& settings);

/// Mean of R^2(i) / R_M^2 over the iterations from `first` on, `count` of them, by its integral. Bias of a disc is
/// proportional to R^2 where light is smooth, so that one radius stands for those of all of them.
double mean_shrink(double exponent, std::uint32_t pilot, std::uint32_t first, std::uint32_t count);

}  // namespace vkcppm
