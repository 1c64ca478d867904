#pragma once
// The straight line: scene -> BVH -> flatten -> upload -> iterate -> resolve -> readback.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/curve.h"
#include "core/error.h"
#include "core/image.h"
#include "core/metrics.h"
#include "render/checkpoint.h"
#include "render/error_estimate.h"
#include "render/report.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm {

class Device;

/// What a render is measured against while it runs.
struct Measuring {
    Image reference;                 // of the size of the picture
    const Metric* metric = nullptr;  // the one that progress tells
    std::optional<double> stop_at;   // the render ends with the first iteration after which it is at most this
};

/// The latest error of a render that is measured.
struct LatestError {
    const Metric* metric = nullptr;
    double value = 0.0;
    std::uint64_t iterations = 0;  // after which it was measured
};

struct Progress {
    std::uint64_t iterations_done = 0;
    std::uint64_t iterations_total = 0;  // the bound of the settings
    double wall_seconds = 0.0;           // since the first iteration began, without measuring
    std::optional<LatestError> error = {};
    std::optional<ErrorEstimate> estimate = {};  // the latest
};

/// Called between iterations; false ends the render after the iteration that is done.
using KeepGoing = std::function<bool(const Progress&)>;

/// The state after the iterations that are done. Throws std::bad_alloc where the host has no memory for it.
using TakeCheckpoint = std::function<Checkpoint()>;

/// Where a render goes on from, and what becomes of the states it passes.
struct Checkpointing {
    const Checkpoint* from = nullptr;  // null: it starts afresh
    double every = 60.0;               // s of rendering between two that are kept
    /// Called so often, and once the render has ended.
    std::function<void(std::uint64_t iterations, const TakeCheckpoint&)> keep = {};
};

/// Told the hash of what a pass of an iteration wrote; iterations count from 1.
using OnPassHash = std::function<void(std::uint32_t iteration, std::string_view pass, std::uint64_t hash)>;

struct Rendering {
    Image image;
    Settings settings;  // as given, with the light paths of an iteration
    Report report;
    Curve curve;  // at every is_snapshot() and after the last iteration, where measured
    /// [P] each, where the settings ask for them: ppm.radius (m), ppm.photons, ppm.batch, ppm.rejections,
    /// ppm.statistic (over its threshold), ppm.iterations, Z (m along the camera's axis), Albedo.R/G/B, N.X/Y/Z,
    /// A (share of eye paths that met a surface), direct, caustic and rest; those of error_channels().
    std::map<std::string, std::vector<float>> aovs;
    std::optional<ErrorEstimate> estimate;  // where asked for, of `least_estimated` iterations or more
    std::vector<std::string> warnings;      // what went wrong on the way, one line each
    /// Why it ended before its bounds: the picture is of the iterations done by then, aovs and counts of the one that
    /// was begun as well.
    std::optional<Error> failure;
};

/// What becomes of the picture on its way: the rendering so far, with image, report and channels, each time that so
/// much rendering time has passed.
struct Snapshots {
    double every = 0.0;  // s
    std::function<void(const Rendering&)> show = {};
};

/// What happens on the way of a render. None of it changes the picture.
struct RenderHooks {
    KeepGoing keep_going = [](const Progress&) { return true; };
    const Measuring* measuring = nullptr;
    Checkpointing checkpointing = {};
    OnPassHash on_hash = {};  // where there is one a submission is a pass (Integrator::run_hashed)
    Snapshots snapshots = {};
    const Target* target = nullptr;  // then the settings must ask for the error
};

/// Renders `scene` by the estimator of the settings, which must be resolved. Throws Error on a scene or image that does
/// not fit the device (out_of_device_memory), on a lost device (device_lost), on a reference of another size (usage).
/// Where it is measured, submissions end at snapshots, or with every iteration where it stops at an error; neither
/// Settings::seconds nor the report's seconds count the time that measuring, checkpoints and snapshots take. Where what
/// grows with the paths no longer fits the device, the picture is of the iterations before, that error is the failure,
/// and no checkpoint is kept at the end. From a checkpoint, of the same scene and settings but for their bounds
/// `iterations` and `seconds`, it goes on as if it had never ended: iterations, seconds, totals and curve count from
/// the first start.
Rendering render(const Scene& scene, const Settings& settings, Device& device, const RenderHooks& hooks = {});

}  // namespace vkcppm
