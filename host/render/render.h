#pragma once
// The straight line: scene -> BVH -> flatten -> upload -> iterate -> resolve -> readback.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/image.h"
#include "render/report.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm {

class Device;

struct Progress {
    std::uint64_t iterations_done = 0;
    std::uint64_t iterations_total = 0;     // the bound of the settings
    double wall_seconds = 0.0;              // since the first iteration began
};

/// Called between iterations; false ends the render after the iteration that is done.
using KeepGoing = std::function<bool(const Progress&)>;

struct Rendering {
    Image image;
    Settings settings;                      // as resolved: size and camera filled in
    Report report;
    /// [P] each, where the settings ask for them: ppm.radius (m), ppm.photons, ppm.batch, ppm.rejections,
    /// ppm.statistic (over its threshold), ppm.iterations, Z (m along the camera's axis), Albedo.R/G/B, N.X/Y/Z.
    std::map<std::string, std::vector<float>> aovs;
    std::vector<std::string> warnings;      // what went wrong on the way, one line each
};

/// Throws Error(usage) where a setting is out of range, with its name, value and limit.
/// `scene` resolves what depends on it: the size of the picture and the camera.
Settings resolve_settings(const Settings& settings, const Scene& scene);

/// Renders `scene` by the estimator of the settings. Throws Error on a setting out of range (usage), on a scene or
/// image that does not fit the device (out_of_device_memory), on a lost device (device_lost).
Rendering render(const Scene& scene, const Settings& settings, Device& device, const KeepGoing& keep_going);

}  // namespace vkcppm
