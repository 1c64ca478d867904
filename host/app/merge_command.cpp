#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/display.h"
#include "app/job.h"
#include "app/outputs.h"
#include "app/provenance.h"
#include "core/error.h"
#include "io/exr.h"
#include "io/png.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// The render that a job's sums are of.
Rendering rendering_of(const Job& job, IterationSums sums, Report report) {
    Rendering rendering;
    rendering.settings = job.plan.settings;
    rendering.report = std::move(report);
    rendering.image = picture_of(sums);
    if (job.plan.settings.aovs) rendering.aovs = surface_channels(sums, job.scale);
    sums.film = {};
    sums.surfaces = {};
    if (job.plan.settings.error && can_estimate(sums.errors)) {
        rendering.estimate = estimate_error(sums.errors);
        rendering.aovs.merge(error_channels(sums.errors));
    }
    return rendering;
}

/// Of the scene, what pictures and statistics tell of it.
Scene scene_of(const Job& job) {
    Scene scene;
    scene.file = job.plan.scene.file;
    scene.hash = job.scene_hash;
    return scene;
}

}  // namespace

void execute(const MergeOptions& options) {
    const Job job = read_job(options.job);
    const std::vector<Cut> cuts = cuts_of(job);
    std::vector<std::optional<fs::path>> inputs{job.folder / "job.json", job.folder / "pilot.ckpt"};
    for (const Cut& cut : cuts) inputs.push_back(slice_file(job, cut));
    check_outputs(inputs, {{"-o", options.output, ".exr"}, {"--png", options.png, ".png"}}, false);

    IterationSums sums;
    Report all;
    std::vector<std::string> devices;
    std::size_t missing = 0;
    for (const Cut& cut : cuts) {
        const auto added = add_slice(job, cut, sums);
        if (const Error* fault = std::get_if<Error>(&added)) {
            const std::string shard = shard_of(job, cut);
            const std::string what =
                fmt::format("{}{} {}: {}", name_of(cut), shard.empty() ? "" : " of " + shard,
                            fault->code() == ExitCode::no_input ? "is missing" : "is broken", fault->what());
            if (cut.number == 0) throw Error(fault->code(), what + ": the command that planned the job mends it");
            if (options.complete) throw Error(fault->code(), what);
            print_message("warning: " + what);
            ++missing;
            continue;
        }
        const Report& report = std::get<Report>(added);
        if (all.device.empty()) {
            all.device = report.device;
            all.driver = report.driver;
        } else if (report.device != all.device || report.driver != all.driver) {
            print_message(fmt::format("warning: {} was rendered on {}, {}, the pilot on {}, {}", name_of(cut),
                                      report.device, report.driver, all.device, all.driver));
        }
        all.iterations += report.iterations;
        all.emitted_paths += report.emitted_paths;
        all.invalid += report.invalid;
    }
    if (missing > 0) {
        print_message(fmt::format("warning: {} of {} slices are missing: the picture is that of {} of {} iterations",
                                  missing, cuts.size() - 1, sums.iterations, job.iterations()));
    }
    if (all.invalid > 0)
        print_message(fmt::format("warning: {} contributions were not finite and were dropped", all.invalid));
    const Rendering rendering = rendering_of(job, std::move(sums), std::move(all));
    if (rendering.estimate) {
        if (const auto warning = warning_of(*rendering.estimate)) print_message("warning: " + *warning);
    }
    ExrAttributes attributes = exr_attributes(job.plan.scene, scene_of(job), rendering);
    attributes.emplace_back("vkcppm.pilot", std::to_string(job.pilot));
    attributes.emplace_back("vkcppm.slice", std::to_string(job.slice));
    ExrChannels channels = to_channels(rendering.image);
    channels.values.insert(rendering.aovs.begin(), rendering.aovs.end());
    write_exr(options.output, channels, attributes);
    if (!options.quiet) {
        if (rendering.estimate) print_message(estimate_line(*rendering.estimate));
        print_message("wrote " + options.output.string());
    }
    if (options.png) {
        const Display display = display_of(options.display, rendering.image, options.png->string(), options.quiet);
        write_png(*options.png, rendering.image, display, options.png_depth);
        if (!options.quiet) print_message("wrote " + options.png->string());
        warn_of_clipping(*options.png, rendering.image, display);
    }
}

}  // namespace vkcppm
