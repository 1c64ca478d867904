#pragma once
// The frames of an animation: a render each, of which those that are there already are told by their files.

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/options.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "vk/device.h"

namespace vkcppm {

/// `pattern` with the number of a frame in the place of its %d or %04d. Throws Error(usage), naming `option`, where it
/// does not have one such place.
std::filesystem::path frame_file(const char* option, const std::filesystem::path& pattern, std::uint32_t frame);

/// The render of one of the frames: at its time, into its files. Throws like frame_file().
RenderOptions frame_of(const RenderOptions& options, std::uint32_t frame);

/// Whether all files of a frame are there and its EXR is whole, done, and of this scene, settings, device and version:
/// what its attributes say.
bool is_rendered(const RenderOptions& frame, const Scene& scene, const Settings& settings, const DeviceInfo& device);

}  // namespace vkcppm
