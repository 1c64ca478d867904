#include <algorithm>
#include <cstdio>
#include <new>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "app/checkpoint_file.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/display.h"
#include "app/frames.h"
#include "app/interrupt.h"
#include "app/live.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/pipeline_cache.h"
#include "app/progress.h"
#include "app/provenance.h"
#include "app/reference.h"
#include "app/validation.h"
#include "core/ending.h"
#include "core/error.h"
#include "core/fnv1a.h"
#include "core/metrics.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/png.h"
#include "render/render.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr double live_every = 1.0;  // s of rendering between two pictures that a viewer is sent

/// What the render is measured against; absent without a reference. The picture will have that size.
std::optional<Measuring> read_measuring(const RenderOptions& options, const Extent& size) {
    if (!options.reference) return std::nullopt;
    Measuring measuring{read_reference(*options.reference, size), &find_metric("--reference", "relmse"), std::nullopt};
    if (options.stop_at) {
        measuring.metric = options.stop_at->metric;
        measuring.stop_at = options.stop_at->value;
    }
    return measuring;
}

/// Says whether an error that a render was to end at was reached: `found` is what it has, `wanted` the option.
void print_end(bool reached, const std::string& found, const std::string& wanted, bool quiet) {
    if (!reached) {
        print_message(fmt::format("warning: {}: {} was not reached", found, wanted));
    } else if (!quiet) {
        print_message(fmt::format("{}: {} was reached", found, wanted));
    }
}

void print_stop(const StopAt& stop_at, const Rendering& rendering, bool quiet) {
    const CurvePoint& last = rendering.curve.back();
    print_end(reached(stop_at, rendering.curve),
              fmt::format("{} {:.6g} after {} iterations", stop_at.metric->name, stop_at.metric->of(last.error),
                          last.iterations),
              fmt::format("--stop-at {:.6g}", stop_at.value), quiet);
}

/// Says what the render takes its error to be, and whether that to aim at was met.
void print_estimate(const std::optional<Target>& target, const Rendering& rendering, bool quiet) {
    const std::string wanted =
        target ? fmt::format("--target {}={:g}", target->measure->name, target->value) : "--error";
    const std::uint64_t done = rendering.report.iterations;
    if (!rendering.estimate) {
        print_message(
            fmt::format("warning: {}: {} iterations tell no error, {} or more do", wanted, done, least_estimated));
        return;
    }
    if (!quiet) print_message(estimate_line(*rendering.estimate));
    if (!target) return;
    print_end(is_met(*target, rendering.estimate),
              fmt::format("at most {:.3g} by {:g} % after {} iterations", upper_bound(*target, *rendering.estimate),
                          100.0 * target->confidence, done),
              wanted, quiet);
}

/// Where checkpoints go. A disk or a memory that is full for a while costs no more than the checkpoints of that while:
/// a failure is told, and the render goes on.
class Keeper {
public:
    Keeper(const fs::path& file, Identity identity) : file_(file), identity_(std::move(identity)) {}

    void keep(std::uint64_t iterations, const TakeCheckpoint& take) {
        failure_.reset();
        try {
            write_checkpoint(file_, identity_, take());
        } catch (const Error& error) {
            if (error.code() != ExitCode::cannot_write && error.code() != ExitCode::out_of_device_memory) throw;
            failure_ = error;
        } catch (const std::bad_alloc&) {
            failure_ = Error(ExitCode::cannot_write, fmt::format("cannot write {}: out of memory", file_.string()));
        }
        if (failure_) {
            print_message(fmt::format("warning: no checkpoint after {} iterations: {}", iterations, failure_->what()));
        }
    }

    /// Throws where the last checkpoint could not be written.
    void require_kept() const {
        if (failure_) throw *failure_;
    }

private:
    fs::path file_;
    Identity identity_;
    std::optional<Error> failure_;
};

/// Says what of the checkpoint will not be as the command line has it.
void print_start(const Checkpoint& from, const RenderOptions& options, const Settings& settings, const Device& device) {
    const Report& then = from.report;
    const DeviceInfo& now = device.info();
    if (!options.quiet) {
        print_message(fmt::format("goes on after {} iterations and {:.1f} s of {}", then.iterations, then.wall_seconds,
                                  options.resume->string()));
    }
    if (then.device != now.name || then.driver != now.driver) {
        print_message(
            fmt::format("warning: {} was written on {}, {}; here is {}, {}: the picture may have other bits than "
                        "without the change",
                        options.resume->string(), then.device, then.driver, now.name, now.driver));
    }
    if (then.iterations > settings.iterations) {
        print_message(fmt::format("warning: {} has {} iterations, more than --iterations {}: the picture has them all",
                                  options.resume->string(), then.iterations, settings.iterations));
    }
}

void print_hash(std::uint32_t iteration, std::string_view pass, std::uint64_t hash) {
    print_result(fmt::format("{} {} {}\n", iteration, pass, hash_text(hash)));
}

void write_picture(const RenderOptions& options, const Scene& scene, const Rendering& rendering) {
    ExrChannels channels = to_channels(rendering.image);
    channels.values.insert(rendering.aovs.begin(), rendering.aovs.end());
    write_exr(options.output, channels, exr_attributes(options.scene, scene, rendering));
}

/// Writes the picture on its way. A disk that is full for a while costs no more than the snapshots of that while.
void write_snapshot(const RenderOptions& options, const Scene& scene, const Rendering& rendering) {
    try {
        write_picture(options, scene, rendering);
        if (options.png) {
            const Display display = display_of(options.display, rendering.image, options.png->string(), true);
            write_png(*options.png, rendering.image, display, options.png_depth);
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::cannot_write) throw;
        print_message(
            fmt::format("warning: no snapshot after {} iterations: {}", rendering.report.iterations, error.what()));
    }
}

Rendering render_with_progress(const Scene& scene, const Settings& settings, const RenderOptions& options,
                               const Measuring* measuring, const Checkpointing& checkpointing, Device& device) {
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, settings.seconds);
    std::optional<LiveView> view;
    if (options.live) view.emplace(*options.live, options.output.string());
    RenderHooks hooks;
    hooks.keep_going = [&](const Progress& progress) {
        if (!options.quiet) line.update(progress);
        return !interrupted();
    };
    hooks.measuring = measuring;
    hooks.checkpointing = checkpointing;
    if (options.hash) hooks.on_hash = print_hash;
    if (options.target) hooks.target = &*options.target;
    double written_at = checkpointing.from ? checkpointing.from->report.wall_seconds : 0.0;
    if (options.snapshot || view) {
        hooks.snapshots.every = options.snapshot.value_or(live_every);
        if (view) hooks.snapshots.every = std::min(hooks.snapshots.every, live_every);
        hooks.snapshots.show = [&](const Rendering& so_far) {
            if (view) view->show(so_far.image);
            if (!options.snapshot || so_far.report.wall_seconds - written_at < *options.snapshot) return;
            written_at = so_far.report.wall_seconds;
            write_snapshot(options, scene, so_far);
        };
    }
    const Rendering rendering = render(scene, settings, device, hooks);
    if (view) view->show(rendering.image);
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

/// Writes all that can be written, then throws Error(cannot_write) of what cannot: a disk that is full under one file
/// costs no other.
void write_outputs(const RenderOptions& options, const Scene& scene, const Rendering& rendering) {
    std::vector<std::string> failures;
    const auto write = [&](const fs::path& file, const auto& to_file) {
        try {
            to_file();
            if (!options.quiet) print_message("wrote " + file.string());
        } catch (const Error& error) {
            if (error.code() != ExitCode::cannot_write) throw;
            failures.emplace_back(error.what());
        }
    };
    if (interrupted()) print_message(fmt::format("interrupted after {} iterations", rendering.report.iterations));
    write(options.output, [&] { write_picture(options, scene, rendering); });
    const Display display =
        options.png ? display_of(options.display, rendering.image, options.png->string(), options.quiet) : Display();
    if (options.png) {
        write(*options.png, [&] {
            write_png(*options.png, rendering.image, display, options.png_depth);
            warn_of_clipping(*options.png, rendering.image, display);
        });
    }
    if (options.stats) {
        write(*options.stats, [&] { write_file(*options.stats, stats_json(options, scene, rendering, display)); });
    }
    if (!failures.empty()) throw Error(ExitCode::cannot_write, fmt::format("{}", fmt::join(failures, "; ")));
}

void print_table(const Report& report) {
    std::istringstream table(stats_table(report));
    for (std::string line; std::getline(table, line);) print_message(line);
}

/// What is said and written of a picture that is done.
void tell_and_write(const RenderOptions& options, const Scene& scene, const Rendering& rendering) {
    print_warnings(rendering.warnings);
    if (options.hash) {
        print_result(fmt::format("picture {}\n", hash_text(hash_of(rendering.image))));
    }
    if (options.stop_at) print_stop(*options.stop_at, rendering, options.quiet);
    if (options.settings.error) print_estimate(options.target, rendering, options.quiet);
    write_outputs(options, scene, rendering);
    if (options.verbose) print_table(rendering.report);
    if (const auto& failure = rendering.failure) {
        throw Error(failure->code(), fmt::format("{}: {} is the picture after {} iterations", failure->what(),
                                                 options.output.string(), rendering.report.iterations));
    }
}

/// Says in one line which frames that follow one another were there.
class Skipped {
public:
    void add(std::uint32_t frame) {
        if (count_++ == 0) first_ = frame;
        last_ = frame;
    }
    void tell(bool quiet) {
        if (count_ > 0 && !quiet) {
            print_message(count_ == 1 ? fmt::format("frame {} is there, of this render: skipped", first_)
                                      : fmt::format("frames {}..{} are there, of this render: skipped", first_, last_));
        }
        count_ = 0;
    }

private:
    std::uint32_t first_ = 0, last_ = 0, count_ = 0;
};

std::vector<Output> outputs_of(const RenderOptions& options) {
    return {{"-o", options.output, ".exr"}, {"--png", options.png, ".png"}, {"--stats", options.stats, ".json"}};
}

/// Renders the frames one after the other on one device. One that is interrupted is not written: what is there is done.
void render_frames(const RenderOptions& options) {
    const auto [first, last] = *options.frames;
    for (std::uint32_t i = first; i <= last && !interrupted(); ++i) {
        check_outputs({options.scene.file, options.scene.environment}, outputs_of(frame_of(options, i)), options.hash);
    }
    std::optional<Device> device;
    std::optional<PipelineCache> cache;
    std::set<std::string> told;
    Skipped skipped;
    for (std::uint32_t i = first; i <= last && !interrupted(); ++i) {
        const RenderOptions frame = frame_of(options, i);
        const Scene scene = load_scene(frame.scene);
        check_outputs({scene.inputs.begin(), scene.inputs.end()}, outputs_of(frame), options.hash);
        tell_warnings(scene, frame.scene, told);
        const Settings settings = resolve_settings(frame.settings, scene);
        if (!device) cache.emplace(device.emplace(options.device), options.device.cache);
        if (is_rendered(frame, scene, settings, device->info())) {
            skipped.add(i);
            continue;
        }
        skipped.tell(options.quiet);
        if (!options.quiet)
            print_message(fmt::format("frame {} of {}..{}, at {:.6g} s", i, first, last, frame.scene.at));
        const Rendering rendering = render_with_progress(scene, settings, frame, nullptr, {}, *device);
        if (interrupted()) {
            print_message(fmt::format("interrupted in frame {}, which is not written", i));
            break;
        }
        tell_and_write(frame, scene, rendering);
    }
    skipped.tell(options.quiet);
    if (device) check_validation(*device);
}

/// A word that is neither a file nor looks like one may have been meant for a command.
void tell_of_commands(const fs::path& scene) {
    std::error_code ignored;
    if (scene.empty() || scene != scene.filename() || scene.has_extension() || fs::exists(scene, ignored)) return;
    throw Error(ExitCode::no_input, fmt::format("{}: no such file, nor a command (see vkcppm --help)", scene.string()));
}

}  // namespace

void execute(const RenderOptions& options) {
    tell_of_commands(options.scene.file);
    catch_interrupts();
    if (options.frames) return render_frames(options);
    const bool keeps_elsewhere = options.resume && !is_same_file(*options.resume, *options.checkpoint);
    // What is gone on from in its place is read first, which tells whether it is a checkpoint.
    const std::string ending = options.resume && !keeps_elsewhere ? ending_of(*options.checkpoint) : std::string();
    std::vector<Output> outputs = outputs_of(options);
    const char* keeps = options.resume && !keeps_elsewhere ? "--resume" : "--checkpoint";
    outputs.push_back({keeps, options.checkpoint, ending.c_str()});
    check_outputs({options.scene.file, options.scene.environment, options.reference,
                   keeps_elsewhere ? options.resume : std::nullopt},
                  outputs, options.hash);
    const Scene scene = load_scene(options.scene);
    check_outputs({scene.inputs.begin(), scene.inputs.end()}, outputs, options.hash);
    tell_warnings(scene, options.scene);
    // Bad values and references are told before the device is asked for.
    const Settings settings = resolve_settings(options.settings, scene);
    const std::optional<Measuring> measuring = read_measuring(options, *settings.size);
    const Image* reference = measuring ? &measuring->reference : nullptr;
    const Identity identity = identity_of(options.scene, scene, settings, reference);
    const std::optional<Checkpoint> from =
        options.resume ? std::optional(read_checkpoint(*options.resume, identity, settings.size->pixels()))
                       : std::nullopt;
    Device device(options.device);
    const PipelineCache cache(device, options.device.cache);
    Checkpointing checkpointing;
    std::optional<Keeper> keeper;
    if (from) {
        print_start(*from, options, settings, device);
        checkpointing.from = &*from;
    }
    if (options.checkpoint) {
        keeper.emplace(*options.checkpoint, identity);
        checkpointing.every = options.checkpoint_every;
        checkpointing.keep = [&](std::uint64_t iterations, const TakeCheckpoint& take) {
            keeper->keep(iterations, take);
        };
    }
    const Rendering rendering =
        render_with_progress(scene, settings, options, measuring ? &*measuring : nullptr, checkpointing, device);
    tell_and_write(options, scene, rendering);
    if (keeper) {
        keeper->require_kept();
        if (!options.quiet) print_message("wrote " + options.checkpoint->string());
    }
    check_validation(device);
}

}  // namespace vkcppm
