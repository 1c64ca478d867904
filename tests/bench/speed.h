#pragma once
// What the subjects of bench_speed share: on what they run, how they time, what they tell.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/process.h"
#include "flat/flatten.h"
#include "render/integrator.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "support/pass_report.h"
#include "vk/device.h"

namespace vkcppm::bench {

/// The device with a number of threads of its own. A graphics card is there once, with as many as there are cores.
struct Worker {
    unsigned threads = 1;
    std::unique_ptr<Device> device;
};

struct Bench {
    std::vector<Worker> workers;
    int runs = 3;                               // of each, of which the least counts; all that is compared takes turns
    std::vector<std::filesystem::path> scenes;  // for whole iterations, beside those of the project
};

/// Seconds of one thing; the least so far, each by itself.
struct Seconds {
    double device = std::numeric_limits<double>::infinity();  // by the device's timestamps; of the host, by the clock
    double cpu = std::numeric_limits<double>::infinity();     // user and system, all threads of the process

    void keep(const Seconds& other) {
        device = std::min(device, other.device);
        cpu = std::min(cpu, other.cpu);
    }
};

/// Wall and CPU seconds of work on the host.
template <typename Work> Seconds time_of(const Work& work) {
    const double wall = wall_now(), cpu = cpu_now();
    work();
    return {wall_now() - wall, cpu_now() - cpu};
}

/// One subject's figures. rows: arrays of strings and numbers, a column each.
struct Table {
    std::string name;     // one word
    std::string caption;  // what holds for all rows
    std::vector<std::string> columns;
    std::vector<nlohmann::ordered_json> rows;
};

// The subjects, a file each.
Table bench_rays(const Bench& bench);
Table bench_bvh(const Bench& bench);
Table bench_gather(const Bench& bench);
Table bench_iterations(const Bench& bench);
Table bench_growth(const Bench& bench);
Table bench_instances(const Bench& bench);

/// A closed room of 2 m with a lamp, a camera and eight bumpy spheres of about so many triangles in all.
Scene bumpy_room(std::uint32_t triangles);

/// Triangles at random places of a cube, of a size that keeps their area.
Scene soup(std::uint32_t triangles);

/// Corners of the scene's triangles in its frame, in leaf order.
std::vector<std::array<glm::vec3, 3>> corners_of(const FlatScene& flat);

/// A render that can be timed an iteration at a time.
class Render {
public:
    Render(Device& device, Scene scene, const Settings& wanted);

    /// Runs `count` iterations and keeps the least of their times, an iteration.
    void run(std::uint32_t count);

    /// Runs `count` iterations that are not timed.
    void warm_up(std::uint32_t count) { integrator_.run(count); }

    const Seconds& least() const { return least_; }
    /// Device seconds an iteration of that pass.
    double pass(Pass of) const { return test::report_of(passes_, of).device_seconds; }
    const Report& report() const { return report_; }  // of all iterations so far
    const FlatScene& flat() const { return flat_; }
    Integrator& integrator() { return integrator_; }

private:
    Scene scene_;
    Settings settings_;
    FlatScene flat_;
    SceneOnDevice on_device_;
    Integrator integrator_;
    Report report_;
    Seconds least_;
    std::vector<PassReport> passes_;  // a call: an iteration
};

}  // namespace vkcppm::bench
