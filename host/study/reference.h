#pragma once
// A reference picture and its standard error. The light is split in two, and each half made by what converges there:
//   caustics   what leaves its light by way of one or more delta lobes (mirrors, smooth glass) before it meets any
//              other lobe, and what is lit by a lamp close by, such as its fixture, and seen by way of another
//              surface: by photons, in discs of a few pixels, with a kernel that extrapolates their radius to 0
//   the rest   by unbiased path tracing, where every vertex can be connected to the light
// The two are independent and add up.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "render/report.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm {

class Device;

struct ReferenceSettings {
    /// size, camera, lens, seed, max_depth; photons: light paths an iteration of caustics; iterations: of caustics, at
    /// most, 32..max_iterations, in fours; seconds: wall time after which neither half goes on once it knows its error,
    /// without it both run to their bounds. The other fields are not looked at.
    Settings render;
    std::uint32_t samples = 1024;  // paths a pixel, at most; 128..2^24, in sixteens
    double trust = 0.05;           // largest relative standard error of a pixel that is trusted, > 0
};

/// Standard errors of means over blocks (core/blocks.h), from the same batches as those of pixels: neighbouring pixels
/// share photons, so that theirs do not tell it.
struct BlockErrors {
    std::uint32_t side = 0;                 // pixels
    std::vector<glm::vec3> standard_error;  // [blocks]
};

struct Reference {
    Image mean;
    Image standard_error;  // of the mean, a pixel and channel: from independent batches
    std::vector<BlockErrors> block_errors;
    std::uint32_t batches = 0;   // of the half that has fewer
    std::vector<float> trusted;  // [P] 1 or 0: the root mean square of the relative standard error, over the pixel and
                                 // its eight neighbours, is at most ReferenceSettings::trust. Relative: se^2 over
                                 // r^2 + 0.01, as relMSE weighs it, the mean over channels.
    ReferenceSettings settings;  // as resolved
    std::uint32_t samples = 0;   // paths a pixel, done
    std::uint32_t iterations = 0;  // of caustics, done
    /// What the errors of the mean itself are expected to add to a measure of core/metrics.h against it.
    double mse = 0.0;
    double srgb_mse = 0.0;
    double relmse = 0.0;
    double relmse_paths = 0.0;  // what each half adds to it
    double relmse_caustics = 0.0;
    double caustic_share = 0.0;  // of the picture's light, sum over channels
    double median_error = 0.0;   // relative standard error of pixels
    double error_99 = 0.0;       // its 99th percentile
    std::size_t untrusted = 0;   // pixels
    Report report;
    std::vector<std::string> warnings;  // what went wrong on the way, one line each
};

struct ReferenceProgress {
    std::uint32_t samples = 0;
    std::uint32_t iterations = 0;
    double relmse = 0.0;  // expected, so far; 0 while there are too few batches to tell
    double wall_seconds = 0.0;
};

/// Called between batches; false ends it with what there is, once there are enough batches to tell an error.
using KeepRefining = std::function<bool(const ReferenceProgress&)>;

/// `settings` with defaults resolved. Throws Error(usage) with option, value and range where one is out of it.
ReferenceSettings resolve_reference(const ReferenceSettings& settings, const Scene& scene);

/// `settings` must be resolved. Throws Error as render() does. Without `seconds` the same settings on the same device
/// give the same bits; with them the numbers of samples and iterations that were done do, given as bounds.
Reference make_reference(const Scene& scene, const ReferenceSettings& settings, Device& device,
                         const KeepRefining& keep_refining);

}  // namespace vkcppm
