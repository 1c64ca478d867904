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

/// A render on its way.
class Run {
public:
    Run(const Scene& scene, const Settings& settings, Device& device, const RenderHooks& hooks)
        : hooks_(hooks),
          set_up_from_(wall_now()),
          settings_(settings),
          on_device_(put_on_device(scene, settings, device)),
          integrator_(on_device_, camera_of(settings, scene), with_light_paths(scene)) {
        if (const Checkpoint* from = hooks_.checkpointing.from) {
            result_.report = from->report;
            result_.curve = from->curve;
            integrator_.restore(result_.report, from->state);
        }
        result_.settings = settings_;
        result_.report.setup_seconds = wall_now() - set_up_from_;
        watch_ = Stopwatch(result_.report.wall_seconds, result_.report.cpu_seconds);
        kept_at_ = shown_at_ = watch_.wall();
        // The checkpoint may be of a render that ended so.
        if (hooks_.checkpointing.from && hooks_.measuring) watch_.off_the_clock([&] { measure(); });
        look();
    }

    Rendering finish() && {
        bool going = true;
        while (going && !ended() && submit()) going = after_submission();
        book();
        if (hooks_.checkpointing.keep && kept_ < integrator_.completed() && !result_.failure) keep();
        if (hooks_.measuring && (result_.curve.empty() || result_.curve.back().iterations < integrator_.completed())) {
            if (latest_.iterations < integrator_.completed()) measure();
            result_.curve.push_back(latest_);
        }
        take_picture();
        integrator_.fill(result_.report);
        result_.report.peak_memory_bytes = peak_memory();
        warn();
        return std::move(result_);
    }

private:
    const Settings& with_light_paths(const Scene& scene) {
        settings_.photons = light_paths(on_device_, camera_of(settings_, scene), settings_);
        return settings_;
    }

    /// False where the device has no more memory for it.
    bool submit() {
        try {
            if (hooks_.on_hash) {
                for (const auto& [pass, hash] : integrator_.run_hashed())
                    hooks_.on_hash(integrator_.completed(), pass, hash);
            } else {
                const auto ends = [&](std::uint32_t done) {
                    return is_measured(hooks_.measuring, done) || (settings_.error && is_look(done));
                };
                integrator_.run(submission_size(integrator_.completed(), watch_.wall(), settings_, ends));
            }
        } catch (const Error& full) {
            if (full.code() != ExitCode::out_of_device_memory || integrator_.completed() == 0) throw;
            result_.failure = full;
        }
        return !result_.failure;
    }

    /// False where the caller wants it to end.
    bool after_submission() {
        const std::uint32_t done = integrator_.completed();
        if (is_measured(hooks_.measuring, done)) {
            watch_.off_the_clock([&] { measure(); });
            if (is_snapshot(done)) result_.curve.push_back(latest_);
        }
        look();
        const bool going = hooks_.keep_going({done, settings_.iterations, watch_.wall(), error_, estimate_});
        const Checkpointing& checkpointing = hooks_.checkpointing;
        if (checkpointing.keep && watch_.wall() - kept_at_ >= checkpointing.every)
            watch_.off_the_clock([&] { keep(); });
        if (hooks_.snapshots.show && watch_.wall() - shown_at_ >= hooks_.snapshots.every)
            watch_.off_the_clock([&] { show(); });
        return going;
    }

    bool ended() const {
        if (integrator_.completed() == 0) return false;
        const Measuring* measuring = hooks_.measuring;
        const bool late = settings_.seconds && watch_.wall() >= *settings_.seconds;
        const bool near = measuring && measuring->stop_at && error_ && error_->value <= *measuring->stop_at;
        const bool sure = hooks_.target && is_met(*hooks_.target, estimate_);
        return integrator_.completed() >= settings_.iterations || late || near || sure;
    }

    void measure() {
        const Measuring& measuring = *hooks_.measuring;
        latest_ = {integrator_.completed(), integrator_.seconds(), compare(integrator_.resolve(), measuring.reference)};
        error_ = {measuring.metric, measuring.metric->of(latest_.error), latest_.iterations};
    }

    void look() {
        if (settings_.error && is_look(integrator_.completed())) estimate_ = estimate_error(integrator_.error_sums());
    }

    void book() {
        result_.report.wall_seconds = watch_.wall();
        result_.report.cpu_seconds = watch_.cpu();
        integrator_.fill(result_.report);
    }

    void keep() {
        kept_at_ = watch_.wall();
        kept_ = integrator_.completed();
        book();
        hooks_.checkpointing.keep(kept_, [&] { return Checkpoint{result_.report, result_.curve, integrator_.save()}; });
    }

    void show() {
        shown_at_ = watch_.wall();
        book();
        take_picture();
        hooks_.snapshots.show(result_);
    }

    void take_picture() {
        result_.image = integrator_.resolve();
        result_.aovs = settings_.aovs ? integrator_.aovs() : decltype(result_.aovs)();
        if (settings_.error && integrator_.completed() >= least_estimated) {
            const ErrorSums sums = integrator_.error_sums();
            result_.estimate = estimate_error(sums);
            result_.aovs.merge(error_channels(sums));
        }
    }

    void warn() {
        const auto warn_of = [&](std::string line) { result_.warnings.push_back(std::move(line)); };
        if (result_.estimate) {
            if (const auto warning = warning_of(*result_.estimate)) warn_of(*warning);
        }
        // Discs as wide as that hold no shadow of what the picture shows.
        constexpr double most_of_picture = 0.5;
        if (const double width = integrator_.disc_width(); width > most_of_picture) {
            warn_of(fmt::format(
                "{} photons an iteration do not suffice: half of their discs are wider than {:.2g} times the height "
                "of the picture, and light that they bring is blurred as much: more --photons, {}or a scene that "
                "ends nearer to what is seen",
                *settings_.photons, width, settings_.direct == direct_gathered ? "--direct sampled, " : ""));
        }
        if (integrator_.invalid() > 0)
            warn_of(fmt::format("{} contributions were not finite and were dropped", integrator_.invalid()));
    }

    const RenderHooks& hooks_;
    double set_up_from_;  // wall_now()
    Settings settings_;
    SceneOnDevice on_device_;
    Integrator integrator_;
    Rendering result_;
    Stopwatch watch_{0.0, 0.0};
    double kept_at_ = 0.0, shown_at_ = 0.0;  // s of the watch
    std::uint32_t kept_ = 0;                 // iterations
    CurvePoint latest_;
    std::optional<LatestError> error_;
    std::optional<ErrorEstimate> estimate_;
};

}  // namespace

Rendering render(const Scene& scene, const Settings& settings, Device& device, const RenderHooks& hooks) {
    assert(!hooks.target || settings.error);
    return Run(scene, settings, device, hooks).finish();
}

}  // namespace vkcppm
