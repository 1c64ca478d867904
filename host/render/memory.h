#pragma once
// What a render takes on the device, told from counts alone: before anything of it is there.

#include <cstdint>
#include <vector>

#include "flat/flat_scene.h"
#include "render/buffers.h"
#include "render/report.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "shared/types.h"
#include "vk/device.h"

namespace vkcppm {

/// Sets how light paths are shared out among lanes, and the sizes of the grid. lit: something emits; group: invocations
/// of a work group.
void set_photons(gpu::Params& params, const Settings& settings, const Device& device, bool lit, std::uint32_t group);

/// Bits of a digit by which photons are sorted, and how many digits there are.
struct Digits {
    std::uint32_t bits;
    std::uint32_t count;
};
Digits digits_of(const gpu::Params& params);

/// What the sizes of a render's buffers follow from at its start. params: as set_photons() leaves them; features:
/// FEATURE_*, of the scene and of the settings, which must be resolved; most_band_pixels: as of the Integrator.
Counts counts_of(const gpu::Params& params, const Settings& settings, const Device& device, std::uint32_t features,
                 std::uint64_t most_band_pixels = 0);

/// By what they have entries for, all that a render of the scene has on the device at its start. Settings must be
/// resolved. Photons take more once their paths turn out longer than is usual.
std::vector<MemoryReport> memory_needed(const FlatScene& scene, const Settings& settings, const Device& device);

/// Throws Error(out_of_device_memory) where a render with these settings, which must be resolved, cannot fit what the
/// device's memory has left, or on software Vulkan the host's, with bytes needed and there and what would make it fit.
/// of_scene: bytes that the scene takes, where it is not on the device yet.
void check_memory(const Counts& counts, const Settings& settings, const Device& device, std::uint64_t of_scene = 0);

/// The same of a scene of which nothing is made yet.
void check_memory(const Scene& scene, const Settings& settings, const Device& device);

}  // namespace vkcppm
