#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/progress.h"
#include "app/record.h"
#include "app/reference.h"
#include "app/validation.h"
#include "core/error.h"
#include "core/metrics.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/png.h"
#include "render/render.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// What the render is measured against; absent without a reference. The picture will have that size.
std::optional<Measuring> read_measuring(const RenderOptions& options, const Extent& size) {
    if (!options.reference) {
        return std::nullopt;
    }
    Measuring measuring{read_reference(*options.reference, size), &find_metric("--reference", "relmse"), std::nullopt};
    if (options.stop_at) {
        measuring.metric = options.stop_at->metric;
        measuring.stop_at = options.stop_at->value;
    }
    return measuring;
}

/// Says whether the error to stop at was reached.
void print_stop(const StopAt& stop_at, const Rendering& rendering, bool quiet) {
    const CurvePoint& last = rendering.curve.back();
    const std::string error = fmt::format("{} {:.6g} after {} iterations", stop_at.metric->name,
                                          stop_at.metric->of(last.error), last.iterations);
    if (!reached(stop_at, rendering)) {
        print_message(fmt::format("warning: {}: --stop-at {:.6g} was not reached", error, stop_at.value));
    } else if (!quiet) {
        print_message(fmt::format("{}: --stop-at {:.6g} was reached", error, stop_at.value));
    }
}

Rendering render_with_progress(const Scene& scene, const RenderOptions& options, const Measuring* measuring,
                               Device& device) {
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, options.settings.seconds);
    const Rendering rendering = render(scene, options.settings, device, [&](const Progress& progress) {
        if (!options.quiet) {
            line.update(progress);
        }
        return !interrupted();
    }, measuring);
    if (!options.quiet) {
        const Report& report = rendering.report;
        Progress progress{report.iterations, rendering.settings.iterations, report.wall_seconds};
        if (measuring) {
            const CurvePoint& last = rendering.curve.back();
            progress.error = {measuring->metric, measuring->metric->of(last.error), last.iterations};
        }
        line.finish(progress);
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
        write_file(*options.stats, stats_json(options, scene, rendering));
        say_wrote(*options.stats);
    }
}

void print_table(const Report& report) {
    std::istringstream table(stats_table(report));
    for (std::string line; std::getline(table, line);) {
        print_message(line);
    }
}

}  // namespace

void execute(const RenderOptions& options) {
    catch_interrupts();
    check_outputs({options.scene.file, options.scene.environment, options.reference},
                  {{"-o", options.output}, {"--png", options.png}, {"--stats", options.stats}});
    const Scene scene = load_scene(options.scene);
    print_warnings(scene.warnings);
    // Bad values and references are told before the device is asked for.
    const Settings settings = resolve_settings(options.settings, scene);
    const std::optional<Measuring> measuring = read_measuring(options, *settings.size);
    Device device(options.device);
    require_validation(options.device, device);
    const Rendering rendering = render_with_progress(scene, options, measuring ? &*measuring : nullptr, device);
    print_warnings(rendering.warnings);
    if (options.stop_at) {
        print_stop(*options.stop_at, rendering, options.quiet);
    }
    write_outputs(options, scene, rendering);
    if (options.verbose) {
        print_table(rendering.report);
    }
    check_validation(device);
}

}  // namespace vkcppm
