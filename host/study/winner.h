#pragma once
// Who is nearest to the reference, pixel by pixel.

#include <cstddef>
#include <span>
#include <vector>

#include "core/image.h"

namespace vkcppm {

inline constexpr int no_winner = -1;  // several are equally near, or an error is not a number

/// [pixels] index of the one with the least error. errors [entrants][pixels]
std::vector<int> winners(std::span<const std::vector<double>> errors);

/// [entrants] the part of the pixels that each wins, 0..1; with no_winner they sum to 1.
std::vector<double> winner_shares(std::span<const int> winners, std::size_t entrants);

/// [pixels] mean of the values at most `reach` columns and rows away, over those within the picture.
std::vector<double> neighbourhood_mean(Extent extent, std::span<const double> values, int reach);

}  // namespace vkcppm
