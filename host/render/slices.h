#pragma once
// A render cut into a pilot, its first iterations, and slices of those that follow, each of which hangs on the pilot
// alone: whoever renders a slice, and when, its sums have the same bits on the same device. Its iterations have the
// random numbers that they have in a render, and radii by render/schedule.h. A pixel that has no radius after the pilot
// looks for one in every slice.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "render/integrator.h"
#include "render/render.h"
#include "render/report.h"
#include "render/scene_on_device.h"
#include "render/settings.h"
#include "render/sums.h"
#include "scene/scene.h"
#include "vk/device.h"

namespace vkcppm {

/// Iterations of a pilot, at least.
inline constexpr std::uint32_t least_pilot = 8;

/// What slices hang on.
struct Pilot {
    std::uint32_t iterations = 0;
    std::vector<std::byte> state;  // Integrator::save()
};

/// What iterations have added up to, and what they took: of the pilot, or of a slice.
struct Slice {
    Report report;
    IterationSums sums;
};

/// A pilot, and what its own iterations have added up to.
struct PilotOfSlices {
    Pilot pilot;
    Slice slice;
};

class SliceRenderer {
public:
    /// Throws like render(). `scene` must outlive this, `settings` be resolved.
    SliceRenderer(const Scene& scene, const Settings& settings, Device& device);

    /// As given, with the light paths of an iteration.
    const Settings& settings() const { return settings_; }
    /// Frame units a metre.
    double scale() const { return integrator_->scale(); }

    /// The first iterations, `least_pilot` or more, by the estimator's own rule. None where keep_going ended it. Before
    /// any slice.
    std::optional<PilotOfSlices> render_pilot(std::uint32_t iterations, const KeepGoing& keep_going);

    /// Iterations from `first` on, `count` of them. None where keep_going ended it. Throws Error(bad_input) where the
    /// pilot cannot be of this scene and these settings.
    std::optional<Slice> render_slice(const Pilot& pilot, std::uint32_t first, std::uint32_t count,
                                      const KeepGoing& keep_going);

private:
    std::optional<Slice> run(std::uint32_t count, const KeepGoing& keep_going);

    Settings settings_;
    SceneOnDevice on_device_;
    std::optional<Integrator> integrator_;
};

}  // namespace vkcppm
