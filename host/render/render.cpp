#include "render/render.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/process.h"
#include "render/flatten.h"
#include "render/integrator.h"
#include "render/submission.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

/// Wall and CPU seconds since it was made, without those that were spent in off_the_clock().
class Stopwatch {
public:
    double wall() const { return wall_now() - wall_start_; }
    double cpu() const { return cpu_now() - cpu_start_; }

    template <typename Work> void off_the_clock(Work&& work) {
        const double wall_before = wall(), cpu_before = cpu();
        work();
        wall_start_ += wall() - wall_before;
        cpu_start_ += cpu() - cpu_before;
    }

private:
    double wall_start_ = wall_now();
    double cpu_start_ = cpu_now();
};

/// True where the error after `done` iterations is wanted.
bool is_measured(const Measuring* measuring, std::uint32_t done) {
    return measuring && (measuring->stop_at || is_snapshot(done));
}

CurvePoint measure(Integrator& integrator, const Image& reference) {
    return {integrator.completed(), integrator.seconds(), compare(integrator.resolve(), reference)};
}

}  // namespace

Rendering render(const Scene& scene, const Settings& wanted, Device& device, const KeepGoing& keep_going,
                 const Measuring* measuring) {
    Rendering result;
    const double setup = wall_now();
    result.settings = resolve_settings(wanted, scene);
    const Settings& settings = result.settings;
    const FlatScene flat = flatten(scene);
    Integrator integrator(device, flat, camera_of(settings, scene), settings);
    result.report.setup_seconds = wall_now() - setup;

    Stopwatch watch;
    CurvePoint latest;
    std::optional<LatestError> error;
    const auto take_measure = [&] {
        latest = measure(integrator, measuring->reference);
        error = {measuring->metric, measuring->metric->of(latest.error), latest.iterations};
    };
    bool going = true;
    while (going && integrator.completed() < settings.iterations) {
        integrator.run(submission_size(integrator.completed(), watch.wall(), settings,
                                       [&](std::uint32_t done) { return is_measured(measuring, done); }));
        const std::uint32_t done = integrator.completed();
        if (is_measured(measuring, done)) {
            watch.off_the_clock(take_measure);
            if (is_snapshot(done)) result.curve.push_back(latest);
        }
        const double wall = watch.wall();
        const bool late = settings.seconds && wall >= *settings.seconds;
        const bool near = measuring && measuring->stop_at && error->value <= *measuring->stop_at;
        going = keep_going({done, settings.iterations, wall, error}) && !late && !near;
    }
    result.report.wall_seconds = watch.wall();
    result.report.cpu_seconds = watch.cpu();
    if (measuring && result.curve.back().iterations < integrator.completed()) {
        if (latest.iterations < integrator.completed()) take_measure();
        result.curve.push_back(latest);
    }
    result.image = integrator.resolve();
    if (settings.aovs) result.aovs = integrator.aovs();
    integrator.fill(result.report);
    result.report.peak_memory_bytes = peak_memory();
    if (integrator.invalid() > 0) {
        result.warnings.push_back(
            fmt::format("{} contributions were not finite and were dropped", integrator.invalid()));
    }
    return result;
}

}  // namespace vkcppm
