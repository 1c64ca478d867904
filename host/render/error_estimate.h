#pragma once
// How far a render is from the truth, without a reference.
//
// Noise: iterations fall into K groups; with n_k of N iterations in group k and its mean x_k, the squared standard
// error of the mean x is v = sum_k n_k (x_k - x)^2 / (N (K - 1)). Radii depend on earlier iterations alone, so that
// iterations are martingale differences and the groups are not correlated by them. Eye paths are stratified over the
// iterations: their part of the error falls faster than with 1 / N, as N^-3/2 where edges cross pixels, and the groups,
// which have an eighth of the iterations each, overstate it. The same v from pairs of groups tells how much: what is
// expected of all iterations is v - 2.2 (v - v_pairs), over the whole picture, since 2.2 = (1 - 8^-1/2) / (1 - 2^-1/2).
//
// Bias: what a disc finds more than its inner half, D_1 = L_R - L_(R / sqrt 2), and that more than its own, D_2 = L_(R
// / sqrt 2) - L_(R / 2), are the first terms of a series whose sum is the bias. Across a straight edge bias is
// proportional to R, each term 1 / sqrt 2 of the one before: from the second on that is taken, so that B = D_1 + (2 +
// sqrt 2) D_2. Where discs are wide for what they see D_2 is as large as D_1 or larger, and says so; where the field in
// them is smooth, bias is proportional to R^2 and B is 1.35 times it. B^2 - v_B, of which v_B is the noise of B, is
// without bias itself, if some pixels' are below 0.
//
// Error bars: the estimate without each of the groups (jackknife), and Student's t of K - 1 degrees of freedom.
//
// What it cannot see: light that no group has found.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"
#include "shared/types.h"

namespace vkcppm {

/// The group of an iteration (from 0 on). Every group has one run of iterations side by side of each octave [2^j,
/// 2^(j + 1)), for those are strata of the sequences that eye paths are drawn from: iterations taken in turn would give
/// each group parts of a lamp and of a pixel of its own. Runs go to the groups forwards and backwards by turns, so that
/// no group has late, narrow discs more than another.
std::uint32_t error_group(std::uint32_t iteration);

/// Iterations of each group, of so many in all.
std::array<std::uint32_t, ERROR_GROUPS> group_sizes(std::uint32_t iterations);

/// What an integrator has kept.
struct ErrorSums {
    Extent extent;
    std::array<std::uint32_t, ERROR_GROUPS> sizes{};  // iterations of each group
    /// [groups][P] sums over the iterations of a group: radiance, and the bias B of its luminance.
    std::array<std::vector<glm::vec4>, ERROR_GROUPS> of_group;

    std::uint32_t iterations() const;
};

/// Iterations before which nothing is estimated: two a group.
inline constexpr std::uint32_t least_estimated = 2 * ERROR_GROUPS;

/// True where every group has as many as that.
bool can_estimate(const ErrorSums& sums);

/// An expected error and the standard error of that.
struct Expected {
    double value = 0.0;
    double standard_error = 0.0;
};

/// Below which it is with that confidence, between 0 and 1: value exp(t standard_error / value), as where an estimate
/// of a variance is small by chance its bar is small as well. Not above 0: t standard_error.
double upper_bound(const Expected& expected, double confidence);

/// A relMSE and what it is made of; bias may be below 0 where there is none.
struct ExpectedRelmse {
    Expected error;  // noise + bias
    double noise = 0.0;
    double bias = 0.0;
};

struct ErrorEstimate {
    ExpectedRelmse relmse;          // core/metrics.h, against the truth
    ExpectedRelmse relmse_trimmed;  // the same without the worst 0.1 % of the pixels
    Expected noise;                 // median over pixels of the relative standard error
    /// Share of the picture's luminance in pixels of which one group has found more than half: light that is found
    /// rarely, and that other pixels may have missed.
    double rare = 0.0;
};

/// A line where light is found so rarely that no estimate of the error is to be trusted.
std::optional<std::string> warning_of(const ErrorEstimate& estimate);

/// One that a render can end at.
struct EstimatedMeasure {
    std::string_view name;
    const Expected& (*of)(const ErrorEstimate&);
};
std::span<const EstimatedMeasure> estimated_measures();

/// Where a render ends without a reference: with the first look at its own error after which the upper bound is at most
/// the value.
struct Target {
    const EstimatedMeasure* measure = nullptr;
    double value = 0.0;       // > 0
    double confidence = 0.9;  // of the bound
};

double upper_bound(const Target& target, const ErrorEstimate& estimate);
bool is_met(const Target& target, const std::optional<ErrorEstimate>& estimate);

/// True where a render looks at its own error: after 32, 36, 40, 45, ... iterations, each an eighth more. Few looks,
/// lest one of them meet the target by chance.
bool is_look(std::uint32_t iterations);

/// Asserts can_estimate(). O(P groups).
ErrorEstimate estimate_error(const ErrorSums& sums);

/// Channels [P] of a picture, W m^-2 sr^-1:
///   StdErr    standard error, root mean square over the channels of colour; strata are left out of account
///   StdErr.8, StdErr.64, ...  the same of means over blocks of so many pixels a side (core/blocks.h), in each of their
///             pixels
///   Bias      of the luminance: the mean of B over 5 x 5 pixels
///   Bound     t StdErr + |Bias|: the truth is nearer in 90 % of pixels
std::map<std::string, std::vector<float>> error_channels(const ErrorSums& sums);

}  // namespace vkcppm
