#include "render/render.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/process.h"
#include "render/flatten.h"
#include "render/integrator.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

constexpr double submission_seconds = 0.1;  // a submission aims at this: progress stays lively, a watchdog quiet
constexpr std::uint32_t max_batch = 32;     // iterations in one submission

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

/// Iterations of the next submission: never beyond the bounds or the next measurement, about submission_seconds long.
std::uint32_t batch_size(std::uint32_t done, const Settings& settings, double wall, const Measuring* measuring) {
    if (done == 0) return 1;
    const double each = std::max(wall / done, 1e-6);
    double batch = std::min<double>(max_batch, submission_seconds / each);
    if (settings.seconds) batch = std::min(batch, (*settings.seconds - wall) / each);
    const std::uint32_t most = std::min<std::uint32_t>(settings.iterations - done, std::max(1u, std::uint32_t(batch)));
    std::uint32_t size = 1;
    while (size < most && !is_measured(measuring, done + size)) ++size;
    return size;
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
        integrator.run(batch_size(integrator.completed(), settings, watch.wall(), measuring));
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
