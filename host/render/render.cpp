#include "render/render.h"

#include <algorithm>
#include <charconv>
#include <chrono>

#include <fmt/format.h>
#include <sys/resource.h>

#include "render/flatten.h"
#include "render/integrator.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

constexpr double submission_seconds = 0.1;  // a submission aims at this: progress stays lively, a watchdog quiet
constexpr std::uint32_t max_batch = 32;     // iterations in one submission

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_now() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

/// Iterations of the next submission: never beyond the bounds, about submission_seconds long.
std::uint32_t batch_size(std::uint32_t done, const Settings& settings, double wall) {
    if (done == 0) return 1;
    const double each = std::max(wall / done, 1e-6);
    double batch = std::min<double>(max_batch, submission_seconds / each);
    if (settings.seconds) batch = std::min(batch, (*settings.seconds - wall) / each);
    return std::min<std::uint32_t>(settings.iterations - done, std::max(1u, std::uint32_t(batch)));
}

}  // namespace

Rendering render(const Scene& scene, const Settings& wanted, Device& device, const KeepGoing& keep_going) {
    Rendering result;
    const double setup = now();
    result.settings = resolve_settings(wanted, scene);
    const Settings& settings = result.settings;
    const FlatScene flat = flatten(scene);
    std::size_t camera = 0;
    std::from_chars(settings.camera.data(), settings.camera.data() + settings.camera.size(), camera);
    Integrator integrator(device, flat, scene.cameras.at(camera), settings);
    result.report.setup_seconds = now() - setup;

    const double start = now(), cpu_start = cpu_now();
    bool going = true;
    while (going && integrator.completed() < settings.iterations) {
        integrator.run(batch_size(integrator.completed(), settings, now() - start));
        const double wall = now() - start;
        going = keep_going({integrator.completed(), settings.iterations, wall}) &&
                !(settings.seconds && wall >= *settings.seconds);
    }
    result.report.wall_seconds = now() - start;
    result.report.cpu_seconds = cpu_now() - cpu_start;
    result.image = integrator.resolve();
    if (settings.aovs) result.aovs = integrator.aovs();
    integrator.fill(result.report);
    result.report.peak_memory_bytes = peak_memory();
    if (integrator.invalid() > 0) {
        result.warnings.push_back(fmt::format("{} contributions were not finite and were dropped", integrator.invalid()));
    }
    return result;
}

}  // namespace vkcppm
