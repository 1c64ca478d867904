#include "render/render.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "core/process.h"
#include "render/integrator.h"
#include "render/light_paths.h"
#include "render/submission.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

/// Wall and CPU seconds since it was made, without those that were spent in off_the_clock(), after those of earlier
/// runs.
class Stopwatch {
public:
    Stopwatch(double wall_before, double cpu_before)
        : wall_start_(wall_now() - wall_before), cpu_start_(cpu_now() - cpu_before) {}

    double wall() const { return wall_now() - wall_start_; }
    double cpu() const { return cpu_now() - cpu_start_; }

    template <typename Work> void off_the_clock(Work&& work) {
        const double wall_before = wall(), cpu_before = cpu();
        work();
        wall_start_ += wall() - wall_before;
        cpu_start_ += cpu() - cpu_before;
    }

private:
    double wall_start_;
    double cpu_start_;
};

/// True where the error after `done` iterations is wanted.
bool is_measured(const Measuring* measuring, std::uint32_t done) {
    return measuring && (measuring->stop_at || is_snapshot(done));
}

CurvePoint measure(Integrator& integrator, const Image& reference) {
    return {integrator.completed(), integrator.seconds(), compare(integrator.resolve(), reference)};
}

}  // namespace

Rendering render(const Scene& scene, const Settings& resolved, Device& device, const KeepGoing& keep_going,
                 const Measuring* measuring, const Checkpointing& checkpointing, const OnPassHash& on_hash,
                 const Snapshots& snapshots, const Target* target) {
    assert(!target || resolved.error);
    Rendering result;
    const double setup = wall_now();
    result.settings = resolved;
    const Settings& settings = result.settings;
    const SceneOnDevice on_device = put_on_device(scene, settings, device);
    result.settings.photons = light_paths(on_device, camera_of(settings, scene), settings);
    Integrator integrator(on_device, camera_of(settings, scene), settings);
    if (checkpointing.from) {
        result.report = checkpointing.from->report;
        result.curve = checkpointing.from->curve;
        integrator.restore(result.report, checkpointing.from->state);
    }
    result.report.setup_seconds = wall_now() - setup;

    Stopwatch watch(result.report.wall_seconds, result.report.cpu_seconds);
    const auto book = [&] {
        result.report.wall_seconds = watch.wall();
        result.report.cpu_seconds = watch.cpu();
        integrator.fill(result.report);
    };
    double kept_at = watch.wall();
    std::uint32_t kept = 0;  // iterations
    const auto keep = [&] {
        kept_at = watch.wall();
        kept = integrator.completed();
        book();
        checkpointing.keep(kept, [&] { return Checkpoint{result.report, result.curve, integrator.save()}; });
    };
    const auto take_picture = [&] {
        result.image = integrator.resolve();
        result.aovs = settings.aovs ? integrator.aovs() : decltype(result.aovs)();
        if (settings.error && integrator.completed() >= least_estimated) {
            const ErrorSums sums = integrator.error_sums();
            result.estimate = estimate_error(sums);
            result.aovs.merge(error_channels(sums));
        }
    };
    double shown_at = watch.wall();
    const auto show = [&] {
        shown_at = watch.wall();
        book();
        take_picture();
        snapshots.show(result);
    };
    CurvePoint latest;
    std::optional<LatestError> error;
    const auto take_measure = [&] {
        latest = measure(integrator, measuring->reference);
        error = {measuring->metric, measuring->metric->of(latest.error), latest.iterations};
    };
    if (checkpointing.from && measuring) watch.off_the_clock(take_measure);
    std::optional<ErrorEstimate> estimate;
    const auto look = [&] {
        if (settings.error && is_look(integrator.completed())) estimate = estimate_error(integrator.error_sums());
    };
    look();  // the checkpoint may be of a render that ended so
    const auto ended = [&] {
        if (integrator.completed() == 0) return false;
        const bool late = settings.seconds && watch.wall() >= *settings.seconds;
        const bool near = measuring && measuring->stop_at && error && error->value <= *measuring->stop_at;
        const bool sure = target && is_met(*target, estimate);
        return integrator.completed() >= settings.iterations || late || near || sure;
    };
    const auto submit = [&] {
        if (on_hash) {
            for (const auto& [pass, hash] : integrator.run_hashed()) on_hash(integrator.completed(), pass, hash);
        } else {
            integrator.run(submission_size(integrator.completed(), watch.wall(), settings, [&](std::uint32_t done) {
                return is_measured(measuring, done) || (settings.error && is_look(done));
            }));
        }
    };
    bool going = true;
    while (going && !ended()) {
        try {
            submit();
        } catch (const Error& full) {
            if (full.code() != ExitCode::out_of_device_memory || integrator.completed() == 0) throw;
            result.failure = full;
            break;
        }
        const std::uint32_t done = integrator.completed();
        if (is_measured(measuring, done)) {
            watch.off_the_clock(take_measure);
            if (is_snapshot(done)) result.curve.push_back(latest);
        }
        look();
        going = keep_going({done, settings.iterations, watch.wall(), error, estimate});
        if (checkpointing.keep && watch.wall() - kept_at >= checkpointing.every) watch.off_the_clock(keep);
        if (snapshots.show && watch.wall() - shown_at >= snapshots.every) watch.off_the_clock(show);
    }
    book();
    if (checkpointing.keep && kept < integrator.completed() && !result.failure) keep();
    if (measuring && (result.curve.empty() || result.curve.back().iterations < integrator.completed())) {
        if (latest.iterations < integrator.completed()) take_measure();
        result.curve.push_back(latest);
    }
    take_picture();
    if (result.estimate) {
        if (const auto warning = warning_of(*result.estimate)) result.warnings.push_back(*warning);
    }
    integrator.fill(result.report);
    result.report.peak_memory_bytes = peak_memory();
    // Discs as wide as that hold no shadow of what the picture shows.
    constexpr double most_of_picture = 0.5;
    if (const double width = integrator.disc_width(); width > most_of_picture) {
        result.warnings.push_back(fmt::format(
            "{} photons an iteration do not suffice: half of their discs are wider than {:.2g} times the "
            "height of the picture, and light that they bring is blurred as much: more --photons, {}or a "
            "scene that ends nearer to what is seen",
            *result.settings.photons, width, settings.direct == direct_gathered ? "--direct sampled, " : ""));
    }
    if (integrator.invalid() > 0) {
        result.warnings.push_back(
            fmt::format("{} contributions were not finite and were dropped", integrator.invalid()));
    }
    return result;
}

}  // namespace vkcppm
