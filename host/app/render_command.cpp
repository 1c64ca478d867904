#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/load.h"
#include "app/progress.h"
#include "app/record.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/png.h"
#include "render/render.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// Refuses, before any time is spent, outputs that cannot be written or would overwrite an input or one another.
void check_outputs(const RenderOptions& options) {
    std::vector<fs::path> taken{fs::weakly_canonical(options.scene.file)};
    if (options.scene.environment) {
        taken.push_back(fs::weakly_canonical(*options.scene.environment));
    }
    const auto check = [&](const char* option, const fs::path& file) {
        const fs::path canonical = fs::weakly_canonical(file);
        for (const fs::path& other : taken) {
            if (canonical == other) {
                throw Error(ExitCode::usage,
                            fmt::format("{}: {} is an input or another output", option, file.string()));
            }
        }
        taken.push_back(canonical);
        check_writable(file);
    };
    check("-o", options.output);
    if (options.png) {
        check("--png", *options.png);
    }
    if (options.stats) {
        check("--stats", *options.stats);
    }
}

void print_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        print_message("warning: " + warning);
    }
}

Rendering render_with_progress(const Scene& scene, const RenderOptions& options, Device& device) {
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, options.settings.seconds);
    const Rendering rendering = render(scene, options.settings, device, [&](const Progress& progress) {
        if (!options.quiet) {
            line.update(progress);
        }
        return !interrupted();
    });
    if (!options.quiet) {
        const Report& report = rendering.report;
        line.finish({report.iterations, rendering.settings.iterations, report.wall_seconds});
    }
    return rendering;
}

void write_outputs(const RenderOptions& options, const Scene& scene, const Rendering& rendering) {
    const auto say_wrote = [&](const fs::path& file) {
        if (!options.quiet) {
            print_message("wrote " + file.string());
        }
    };
    ExrChannels channels = to_channels(rendering.image);
    channels.values.insert(rendering.aovs.begin(), rendering.aovs.end());
    write_exr(options.output, channels, exr_attributes(options.scene, scene, rendering));
    if (interrupted()) {
        print_message(fmt::format("interrupted after {} iterations: wrote {}", rendering.report.iterations,
                                  options.output.string()));
    } else {
        say_wrote(options.output);
    }
    if (options.png) {
        write_png(*options.png, rendering.image, options.exposure);
        say_wrote(*options.png);
    }
    if (options.stats) {
        write_file(*options.stats, stats_json(options.scene, scene, rendering));
        say_wrote(*options.stats);
    }
}

void print_table(const Report& report) {
    std::istringstream table(stats_table(report));
    for (std::string line; std::getline(table, line);) {
        print_message(line);
    }
}

void check_validation(const Device& device) {
    const std::vector<std::string> messages = device.validation_messages();
    for (const std::string& message : messages) {
        print_message("validation: " + message);
    }
    if (!messages.empty()) {
        throw Error(ExitCode::internal, fmt::format("{} messages of the validation layer", messages.size()));
    }
}

}  // namespace

void execute(const RenderOptions& options) {
    catch_interrupts();
    check_outputs(options);
    const Scene scene = load_scene(options.scene);
    print_warnings(scene.warnings);
    resolve_settings(options.settings, scene);  // a bad value is told before the device is asked for
    Device device(options.device);
    if (options.device.validate && !device.validating()) {
        throw Error(ExitCode::no_device, "--validate: the Vulkan validation layer is not installed");
    }
    const Rendering rendering = render_with_progress(scene, options, device);
    print_warnings(rendering.warnings);
    write_outputs(options, scene, rendering);
    if (options.verbose) {
        print_table(rendering.report);
    }
    check_validation(device);
}

}  // namespace vkcppm
