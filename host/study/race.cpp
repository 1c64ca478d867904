#include "study/race.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/process.h"
#include "render/integrator.h"
#include "render/light_paths.h"
#include "render/render.h"
#include "render/scene_on_device.h"
#include "render/submission.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

/// sums [pixels], empty at first.
void add_squared_error(std::vector<double>& sums, const Image& image, const Image& reference) {
    sums.resize(image.rgb.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const glm::dvec3 difference = glm::dvec3(image.rgb[i]) - glm::dvec3(reference.rgb[i]);
        sums[i] += dot(difference, difference) / 3.0;
    }
}

/// An entrant in the seed that runs.
class EntrantRun {
public:
    /// Starts a curve in `run`, or goes on with one. Throws Error(out_of_device_memory) with the entrant.
    EntrantRun(const SceneOnDevice& on_device, const Scene& scene, RaceRun& run, const std::optional<StopAt>& stop_at,
               std::uint32_t seed, const RaceStates& states)
        : run_(run), settings_(run.entrant.settings), stop_at_(stop_at), states_(states) {
        settings_.seed = seed;
        std::optional<Checkpoint> from;
        if (states_.find) from = states_.find({run.entrant.name, settings_});
        try {
            integrator_ = std::make_unique<Integrator>(on_device, camera_of(settings_, scene), settings_);
        } catch (const Error& error) {
            if (error.code() != ExitCode::out_of_device_memory) throw;
            const Device& device = on_device.device();
            throw Error(
                error.code(),
                fmt::format("entrant '{}': {}; the scene and the entrants before it hold {} of the device's {} "
                            "bytes",
                            run.entrant.name, error.what(), device.allocated_bytes(), device.info().memory_bytes));
        }
        if (from) integrator_->restore(from->report, from->state);
        run_.curves.push_back(from ? std::move(from->curve) : Curve());
    }

    bool finished() const {
        return integrator_->completed() >= settings_.iterations ||
               (settings_.seconds && integrator_->seconds() >= *settings_.seconds) || is_near_enough();
    }

    /// Of its iterations or its time, 0..1.
    double done() const {
        if (is_near_enough()) return 1.0;
        const double of_iterations = double(integrator_->completed()) / settings_.iterations;
        const double of_time = settings_.seconds ? integrator_->seconds() / *settings_.seconds : 0.0;
        return std::min(1.0, std::max(of_iterations, of_time));
    }

    /// What the entrants alternate by: the one with the least is behind.
    double at() const { return settings_.seconds ? integrator_->seconds() : integrator_->completed(); }

    /// True once it has a picture.
    bool began() const { return integrator_->completed() > 0; }

    void take_turn(const Image& reference) {
        integrator_->run(submission_size(integrator_->completed(), integrator_->seconds(), settings_, is_snapshot));
        if (is_snapshot(integrator_->completed()) || finished()) take_snapshot(reference);
    }

    /// Adds its end to the run.
    void end(const Image& reference) {
        take_snapshot(reference);
        keep();
        integrator_->fill(run_.reports.emplace_back());
        Image image = integrator_->resolve();
        add_squared_error(run_.squared_error, image, reference);
        if (run_.curves.size() > 1) return;
        run_.image = std::move(image);
        run_.radius = integrator_->radii();
        if (settings_.aovs) run_.aovs = integrator_->aovs();
    }

    void keep() const {
        if (!states_.keep || !began()) return;
        Checkpoint state{{}, run_.curves.back(), integrator_->save()};
        integrator_->fill(state.report);
        states_.keep({run_.entrant.name, settings_}, state);
    }

    std::uint64_t invalid() const { return integrator_->invalid(); }

private:
    bool is_near_enough() const { return stop_at_ && reached(*stop_at_, run_.curves.back()); }

    void take_snapshot(const Image& reference) {
        Curve& curve = run_.curves.back();
        if (!curve.empty() && curve.back().iterations == integrator_->completed()) return;
        curve.push_back({integrator_->completed(), integrator_->seconds(), compare(integrator_->resolve(), reference)});
    }

    RaceRun& run_;
    Settings settings_;
    const std::optional<StopAt>& stop_at_;
    const RaceStates& states_;
    std::unique_ptr<Integrator> integrator_;
};

/// The run whose turn it is: the one that is behind. None where all are finished.
EntrantRun* next_run(std::vector<EntrantRun>& runs) {
    EntrantRun* next = nullptr;
    for (EntrantRun& run : runs) {
        if (!run.finished() && (!next || run.at() < next->at())) next = &run;
    }
    return next;
}

}  // namespace

RaceSettings resolve_race(const RaceSettings& race, const Scene& scene) {
    RaceSettings resolved = race;
    for (std::size_t e = 0; e < race.entrants.size(); ++e) {
        Entrant& entrant = resolved.entrants[e];
        const auto same = [&](const Entrant& other) { return other.name == entrant.name; };
        if (std::any_of(race.entrants.begin(), race.entrants.begin() + std::ptrdiff_t(e), same)) {
            throw Error(ExitCode::usage, fmt::format("--estimators: '{}' stands there twice", entrant.name));
        }
        try {
            entrant.settings = resolve_settings(entrant.settings, scene);
        } catch (const Error& error) {
            throw Error(error.code(), fmt::format("{} (entrant '{}')", error.what(), entrant.name));
        }
    }
    return resolved;
}

RaceResult run_race(const Scene& scene, const RaceSettings& race, const Image& reference, Device& device,
                    const KeepRacing& keep_racing, const RaceStates& states) {
    assert(!race.entrants.empty() && race.seeds > 0);
    RaceResult result;
    for (const Entrant& entrant : race.entrants) result.runs.emplace_back().entrant = entrant;
    const auto is_sppm = [](const Entrant& entrant) { return entrant.settings.estimator == "sppm"; };
    const auto sppm = std::ranges::find_if(race.entrants, is_sppm);
    if (sppm != race.entrants.end()) result.baseline = std::size_t(sppm - race.entrants.begin());

    // Entrants differ by their estimators alone, which take about as much.
    const SceneOnDevice on_device = put_on_device(scene, race.entrants.front().settings, device);
    // One number for all who have none of their own, counted for the first of them.
    std::optional<std::uint32_t> photons;
    for (RaceRun& run : result.runs) {
        Settings& settings = run.entrant.settings;
        if (settings.photons) continue;
        if (!photons) photons = light_paths(on_device, camera_of(settings, scene), settings);
        settings.photons = photons;
    }
    const double begin = wall_now();
    for (std::uint32_t s = 0; s < race.seeds && !result.interrupted; ++s) {
        const std::uint32_t seed = race.entrants.front().settings.seed + s;
        std::vector<EntrantRun> running;
        for (RaceRun& run : result.runs) running.emplace_back(on_device, scene, run, race.stop_at, seed, states);
        const auto progress = [&] {
            double done = s;
            for (const EntrantRun& run : running) done += run.done() / double(running.size());
            return RaceProgress{s, race.seeds, done / race.seeds, wall_now() - begin, result.runs};
        };
        while (EntrantRun* next = next_run(running)) {
            next->take_turn(reference);
            result.interrupted = !keep_racing(progress()) || result.interrupted;
            // The first seed goes on until all have a picture.
            if (result.interrupted && (s > 0 || std::ranges::all_of(running, &EntrantRun::began))) break;
        }
        if (next_run(running) && s > 0) {
            for (const EntrantRun& run : running) run.keep();
            for (RaceRun& run : result.runs) run.curves.pop_back();
            break;
        }
        result.seeds.push_back(seed);
        for (std::size_t e = 0; e < running.size(); ++e) {
            running[e].end(reference);
            if (running[e].invalid() == 0) continue;
            result.warnings.push_back(fmt::format("{}, seed {}: {} contributions were not finite and were dropped",
                                                  result.runs[e].entrant.name, seed, running[e].invalid()));
        }
    }
    for (RaceRun& run : result.runs) {
        for (double& error : run.squared_error) error /= double(result.seeds.size());
    }
    return result;
}

}  // namespace vkcppm
