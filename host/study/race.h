#pragma once
// Estimators side by side on one scene: the same photon paths, the same first radii, the same clock.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/curve.h"
#include "core/image.h"
#include "render/checkpoint.h"
#include "render/report.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm {

class Device;

/// An estimator with its parameters.
struct Entrant {
    std::string name;  // as the command line has it: "cppm:beta=1.5"
    Settings settings;
};

struct RaceSettings {
    /// One or more with different names. They differ in nothing but estimator, its parameters and the paths of an
    /// iteration; those whose number of light paths is not set have one in common. Each gets, for every
    /// seed, Settings::iterations iterations, or the one in which Settings::seconds have passed on the clock of
    /// core/curve.h, whichever comes first. Settings::seed is the first seed, the others follow it.
    std::vector<Entrant> entrants;
    std::uint32_t seeds = 1;
    /// Ends an entrant, in a seed, with the first snapshot that is at or below it.
    std::optional<StopAt> stop_at = {};
};

/// What an entrant did.
struct RaceRun {
    Entrant entrant;                                 // settings as resolved
    std::vector<Curve> curves;                       // [seeds] snapshots as is_snapshot says, and at the end
    std::vector<Report> reports;                     // [seeds]
    Image image;                                     // of the first seed, at its end
    std::vector<float> radius;                       // [P] m, the same
    std::map<std::string, std::vector<float>> aovs;  // the same: Rendering::aovs, where the settings ask for them
    std::vector<double> squared_error;  // [P] mean over channels and seeds, each at its end, (W m^-2 sr^-1)^2
};

struct RaceResult {
    std::vector<RaceRun> runs;         // [entrants]
    std::vector<std::uint32_t> seeds;  // that were run to their ends, or the first alone where it was cut short
    std::size_t baseline = 0;          // of runs: sppm, else the first
    bool interrupted = false;
    std::vector<std::string> warnings;
};

/// A race between two submissions.
struct RaceProgress {
    std::uint32_t seed = 0;  // index of the one that runs
    std::uint32_t seeds = 0;
    double done = 0.0;              // of all seeds and entrants, 0..1
    double wall_seconds = 0.0;      // since the race began
    std::span<const RaceRun> runs;  // the last curve of each is that of the running seed
};

/// False ends the race after the submission that is done.
using KeepRacing = std::function<bool(const RaceProgress&)>;

/// Where the states of entrants are kept between races, by the entrant, whose settings then have the seed and the
/// number of light paths. find: what was kept of it, from which it goes on; nothing begins. keep: at the end of a seed,
/// also of one that is cut short.
struct RaceStates {
    std::function<std::optional<Checkpoint>(const Entrant&)> find = {};
    std::function<void(const Entrant&, const Checkpoint&)> keep = {};
};

/// The settings of every entrant as resolve_settings has them. Throws Error(usage), with the entrant's name, where one
/// is out of range, and where two entrants have one name.
RaceSettings resolve_race(const RaceSettings& race, const Scene& scene);

/// Runs the race: seeds one after another, entrants in turn in submissions of a fraction of a second, the one whose
/// clock (without a time limit: whose iterations) is behind first, so that what disturbs the machine disturbs all
/// alike. A race that is cut short keeps the seeds that are complete, or what there is of the first.
/// With `states` it goes on from where others ended, seed by seed: iterations have the bits that they would have had.
/// `race` as resolve_race returns it; `reference` [size of the entrants]. Throws Error(usage) where the sizes differ,
/// Error(out_of_device_memory) with the entrant where not all fit the device together, and what Integrator throws.
RaceResult run_race(const Scene& scene, const RaceSettings& race, const Image& reference, Device& device,
                    const KeepRacing& keep_racing, const RaceStates& states = {});

}  // namespace vkcppm
