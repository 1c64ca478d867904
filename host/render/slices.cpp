#include "render/slices.h"

#include <algorithm>
#include <cassert>
#include <span>

#include "core/process.h"
#include "flat/flatten.h"
#include "render/light_paths.h"
#include "render/memory.h"
#include "render/schedule.h"
#include "render/submission.h"

namespace vkcppm {

SliceRenderer::SliceRenderer(const Scene& scene, const Settings& settings, Device& device)
    : settings_(settings), device_(device) {
    check_memory(scene, settings_, device);
    on_device_.emplace(device, flatten(scene));
    const Camera& camera = camera_of(settings_, scene);
    settings_.photons = light_paths(*on_device_, camera, settings_);
    integrator_.emplace(*on_device_, camera, settings_);
}

/// Runs so many iterations, and tells what they took. False where keep_going ended it.
bool SliceRenderer::run(std::uint32_t count, Report& report, const KeepGoing& keep_going) {
    const std::uint32_t first = integrator_->completed();
    const double wall = wall_now(), cpu = cpu_now();
    Settings bound = settings_;
    bound.iterations = count;
    bound.seconds.reset();
    for (std::uint32_t done = 0; done < count; done = integrator_->completed() - first) {
        integrator_->run(submission_size(done, wall_now() - wall, bound, [](std::uint32_t) { return false; }));
        if (!keep_going({integrator_->completed() - first, count, wall_now() - wall})) return false;
    }
    integrator_->fill(report);
    report.wall_seconds = wall_now() - wall;
    report.cpu_seconds = cpu_now() - cpu;
    report.peak_memory_bytes = peak_memory();
    return true;
}

std::optional<SliceRenderer::PilotSlice> SliceRenderer::render_pilot(std::uint32_t iterations,
                                                                     const KeepGoing& keep_going) {
    assert(integrator_->completed() == 0 && iterations >= least_pilot);
    Report first_half;
    if (!run(iterations / 2, first_half, keep_going)) return std::nullopt;
    const std::vector<gpu::PixelState> before = integrator_->pixel_states();
    PilotSlice result;
    if (!run(iterations - iterations / 2, result.slice.report, keep_going)) return std::nullopt;
    result.slice.report.wall_seconds += first_half.wall_seconds;
    result.slice.report.cpu_seconds += first_half.cpu_seconds;
    result.slice.sums = integrator_->sums();
    result.pilot = {iterations, integrator_->save(),
                    exponents_of(settings_, *settings_.size, before, integrator_->pixel_states())};
    return result;
}

std::optional<Slice> SliceRenderer::render_slice(const Pilot& pilot, std::uint32_t first, std::uint32_t count,
                                                 const KeepGoing& keep_going) {
    assert(first >= pilot.iterations && count > 0);
    Report from;
    from.iterations = pilot.iterations;
    integrator_->restore(from, pilot.state);
    std::vector<gpu::PixelState> states = integrator_->pixel_states();
    for (std::size_t i = 0; i < states.size(); ++i) {
        gpu::PixelState& state = states[i];
        state.seen = state.photons = 0;
        if (state.seeded == 0) continue;  // it goes on looking for its first radius
        state.radius2 *= float(mean_shrink(pilot.exponents[i], pilot.iterations, first, count));
        state.radius2_low = 0.0f;
    }
    integrator_->begin_slice(first, states);
    Slice slice;
    if (!run(count, slice.report, keep_going)) return std::nullopt;
    slice.sums = integrator_->sums();
    return slice;
}

}  // namespace vkcppm
