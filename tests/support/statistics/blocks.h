#pragma once
// Two ways to the same picture, compared block by block.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/image.h"
#include "oracle/path_tracer.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm::test {

/// Several pictures of one kind, uncorrelated: their spread is the error of their mean.
using Pictures = std::vector<Image>;

/// What the oracle's path tracer is asked for: size, depth and lens of the settings.
oracle::PathTracerSettings oracle_settings(const Settings& settings, std::uint32_t samples);

/// One render's iterations in `parts` of equal length, the mean over each. Photons of a part are its own, and whatever
/// radius earlier ones have left, its estimate is as good as theirs: parts are uncorrelated. The device is the one
/// without the validation layer.
Pictures render_photons(const Scene& scene, const Settings& settings, std::uint32_t parts);

/// The scene by the renderer and by the oracle's path tracer, of the seed, the size, the depth and the lens of the
/// settings.
struct TwoWays {
    Pictures photons;  // parts of one render: its iterations, cut in as many equal parts
    oracle::PathTracing paths;
};
TwoWays render_two_ways(const Scene& scene, const Settings& settings, std::uint32_t parts, std::uint32_t samples);

/// The same, the photons' pictures extrapolated to a radius of 0: twice a picture with four times the photons, and so
/// half the radii, less one with those of the settings. The bias at edges is linear in the radius, most of it cancels.
TwoWays render_two_ways_extrapolated(const Scene& scene, Settings settings, std::uint32_t parts, std::uint32_t samples);

/// The photons of two scenes that should look the same, by the same random numbers.
struct TwoScenes {
    Pictures one;
    Pictures other;
};
TwoScenes render_two_scenes(const Scene& one, const Scene& other, const Settings& settings, std::uint32_t parts);

struct BlockSettings {
    std::uint32_t side = 8;  // pixels of a block either way
    double level = 0.001;    // of the whole picture, Sidak-corrected over blocks and channels
    double bias = 0.01;      // relative, of a block: what the photon estimate may be off at edges and corners
    double noise = 1e9;      // relative, of a block's mean by paths: where their standard error is above, they have
                             // not converged and the block does not count
};

struct BlockComparison {
    std::size_t counted = 0;    // blocks and channels
    std::size_t differing = 0;  // those that differ by Welch's test
    std::string table;          // photons over paths (standard error); !: differs, ?: does not count
};

BlockComparison compare_blocks(const TwoWays& pictures, const BlockSettings& settings);

/// Expects that no block differs, or shows the table and leaves the pictures (the means of both ways).
BlockComparison expect_blocks_agree(const TwoWays& pictures, const BlockSettings& settings);

/// The same of two scenes, part by part (paired t-test): what both parts of a pair have of noise does not count.
/// `ways`: what stands over what.
BlockComparison expect_blocks_agree(const TwoScenes& pictures, const BlockSettings& settings, const std::string& ways);

/// The same of two pictures that know their standard errors, from many samples: by the normal distribution.
BlockComparison compare_blocks(const oracle::PathTracing& picture, const oracle::PathTracing& paths,
                               const BlockSettings& settings);

/// `ways`: what stands over what, such as "device over double".
BlockComparison expect_blocks_agree(const oracle::PathTracing& picture, const oracle::PathTracing& paths,
                                    const BlockSettings& settings, const std::string& ways);

}  // namespace vkcppm::test
