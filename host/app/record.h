#pragma once
// What a render was, as text: enough to make its picture again, and what it took.

#include <string>

#include "app/options.h"
#include "io/exr.h"
#include "render/render.h"
#include "scene/scene.h"

namespace vkcppm {

/// The EXR's attributes, named "vkcppm.*": all settings as resolved, the scene's name and hash and what was done to
/// it, what was rendered, device, driver and version. Nothing that differs between two runs of one seed on one device.
ExrAttributes exr_attributes(const SceneOptions& options, const Scene& scene, const Rendering& rendering);

/// The text of --stats: a JSON object with passes [{name, calls, device_seconds}], totals, settings, scene, device,
/// driver and version.
std::string stats_json(const SceneOptions& options, const Scene& scene, const Rendering& rendering);

/// The passes and totals as a table to read.
std::string stats_table(const Report& report);

}  // namespace vkcppm
