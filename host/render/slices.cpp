#include "render/slices.h"

#include <cassert>

#include "core/process.h"
#include "render/light_paths.h"
#include "render/schedule.h"
#include "render/submission.h"

namespace vkcppm {

SliceRenderer::SliceRenderer(const Scene& scene, const Settings& settings, Device& device)
    : settings_(settings), on_device_(put_on_device(scene, settings, device)) {
    const Camera& camera = camera_of(settings_, scene);
    settings_.photons = light_paths(on_device_, camera, settings_);
    integrator_.emplace(on_device_, camera, settings_);
}

/// So many iterations from the one on that is due.
std::optional<Slice> SliceRenderer::run(std::uint32_t count, const KeepGoing& keep_going) {
    const double wall = wall_now(), cpu = cpu_now();
    const std::uint32_t first = integrator_->completed();
    Settings bound = settings_;
    bound.iterations = count;
    bound.seconds.reset();
    for (std::uint32_t done = 0; done < count; done = integrator_->completed() - first) {
        integrator_->run(submission_size(done, wall_now() - wall, bound, [](std::uint32_t) { return false; }));
        if (!keep_going({integrator_->completed() - first, count, wall_now() - wall})) return std::nullopt;
    }
    Slice slice;
    integrator_->fill(slice.report);
    slice.report.wall_seconds = wall_now() - wall;
    slice.report.cpu_seconds = cpu_now() - cpu;
    slice.sums = integrator_->sums();
    return slice;
}

std::optional<PilotOfSlices> SliceRenderer::render_pilot(std::uint32_t iterations, const KeepGoing& keep_going) {
    assert(integrator_->completed() == 0 && iterations >= least_pilot);
    std::optional<Slice> slice = run(iterations, keep_going);
    if (!slice) return std::nullopt;
    return PilotOfSlices{{iterations, integrator_->save()}, std::move(*slice)};
}

std::optional<Slice> SliceRenderer::render_slice(const Pilot& pilot, std::uint32_t first, std::uint32_t count,
                                                 const KeepGoing& keep_going) {
    assert(first >= pilot.iterations && count > 0);
    Report from;
    from.iterations = pilot.iterations;
    integrator_->restore(from, pilot.state);
    const double shrink = mean_shrink(shrink_exponent(settings_), pilot.iterations, first, count);
    std::vector<gpu::PixelState> states = integrator_->pixel_states();
    for (gpu::PixelState& state : states) {
        state.seen = state.photons = 0;
        if (state.seeded == 0) continue;
        state.radius2 = float(state.radius2 * shrink);
        state.radius2_low = 0.0f;
    }
    integrator_->begin_slice(first, states);
    return run(count, keep_going);
}

}  // namespace vkcppm
