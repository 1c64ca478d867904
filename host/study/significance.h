#pragma once
// Does noise explain how two pictures differ? A test of every pixel and, for small differences that many pixels share,
// of the means over blocks, up to the whole picture.
//
// The statistic of a pixel or block is sigma = |x - r| / s, where |x - r| is the root mean square over the channels and
// s^2 the sum of both pictures' squared standard errors, likewise means over the channels. Where channels vary together
// it is |t| of Student's test; where they do not its square is a mean of squares, whose tail is lighter (Szekely and
// Bakirov 2003), so that Student's is on the safe side. Degrees of freedom are Welch's. The level is that of all tests
// together, the same part of it for pixels as for blocks of each size, of which there are far fewer (Sidak 1967: normal
// variables, however they depend on one another).

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Batches that a standard error is taken to come from where nobody says: the least that `vkcppm reference` makes.
inline constexpr std::uint32_t least_error_batches = 8;

/// A picture that knows how far it can be trusted.
struct NoisyPicture {
    Image mean;
    std::vector<float> standard_error{};  // [pixels], root mean square over the channels; finite where the mean is
    /// The same of the means over blocks, by the side of the blocks; [blocks_of(side)]. A side that is not there is
    /// taken as if the noise of all pixels of a block moved together.
    std::map<std::uint32_t, std::vector<float>> block_error{};
    std::uint32_t batches = least_error_batches;  // independent ones, of which the errors are the spread; > 1
};

/// What was found among pixels (side 1) or blocks.
struct Scale {
    std::uint32_t side = 1;
    std::size_t tests = 0;      // pixels or blocks that were compared
    std::size_t differing = 0;  // by more than noise explains
    double worst = 0.0;         // the largest sigma ...
    std::size_t worst_at = 0;   // ... and the pixel or block that has it
    std::vector<float> sigma;   // [pixels or blocks], of those that are not compared 0
    std::vector<bool> differs;  // the same
};

struct Significance {
    double level = 0.0;    // that a right picture fails by chance
    double p_value = 1.0;  // of all tests together: the level at which this would just fail
    std::vector<Scale> scales;
    bool differs() const;
};

/// Pixels that are not finite in one of the pictures are left out. level: between 0 and 1. Asserts that the sizes are
/// the same.
Significance test_difference(const NoisyPicture& image, const NoisyPicture& reference, double level);

}  // namespace vkcppm
