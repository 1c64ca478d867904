#pragma once
// All measures of one picture against another: those of core/metrics.h, and FLIP, which takes longer.

#include <string>
#include <string_view>
#include <vector>

#include "core/flip.h"
#include "core/image.h"
#include "core/metrics.h"

namespace vkcppm {

struct PictureMeasures {
    Comparison comparison;
    Flip flip;      // HDR-FLIP
    Flip ldr_flip;  // LDR-FLIP of the 8-bit sRGB encodings
};

/// Throws Error(usage) where the sizes differ.
PictureMeasures measure(const Image& image, const Image& reference);

/// One of them, as it is told; smaller is nearer.
struct NamedMeasure {
    std::string_view name;   // on the command line and in files
    std::string_view title;  // for people
    double value = 0.0;
};

/// Those of metrics(), then flip and ldr_flip.
std::vector<NamedMeasure> named(const PictureMeasures& measures);

/// Their names, separated by commas.
std::string measure_names();

/// Whether there is one of that name.
bool is_measure(std::string_view name);

}  // namespace vkcppm
