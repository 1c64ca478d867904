#pragma once
// Is a picture still what its reference is? By bounds on measures, or by what noise explains.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/measures.h"
#include "study/significance.h"

namespace vkcppm {

/// A measure of named() and the most that it may be.
struct Bound {
    std::string name;
    double most = 0.0;
};

struct CheckSettings {
    std::vector<Bound> bounds;
    std::optional<double> max_pixels;  // share of the pixels that may differ, 0..1; a pixel does by more than ...
    double pixel_bound = 0.05;         // ... this, relative as relMSE weighs it: Check::difference
    std::optional<double> level;       // of the test of test_difference, between 0 and 1; absent: it is not made
};

/// One of the things that are asked of the picture.
struct Condition {
    std::string name;  // such as "relmse", "max-pixels", "pixels", "blocks of 8x8", "whole picture"
    bool holds = false;
    std::string told;  // with value and limit
};

struct Check {
    PictureMeasures measures;
    std::vector<float> difference;  // [pixels] sqrt of the mean over channels of (x - r)^2 / (r^2 + 0.01); infinite
                                    // where one picture alone is finite, 0 where neither is
    std::size_t unlike = 0;         // pixels that are finite in one picture alone
    std::size_t masked = 0;         // pixels that are finite in neither
    std::optional<Significance> significance;
    std::vector<Condition> conditions;  // in the order of the settings

    bool passes() const;  // all hold
    /// What fails or, where nothing does, what holds; in one line.
    std::string why() const;
};

/// Pixels that are finite in neither picture are left out; one that is in one alone differs: it counts among max_pixels
/// or, without them, is a failure of its own. Asserts that a level comes with standard errors of both pictures. Throws
/// Error(usage) where the sizes differ.
Check check(const NoisyPicture& image, const NoisyPicture& reference, const CheckSettings& settings);

}  // namespace vkcppm
