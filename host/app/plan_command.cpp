#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/job.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/pipeline_cache.h"
#include "app/progress.h"
#include "app/validation.h"
#include "core/error.h"
#include "core/fnv1a.h"
#include "render/estimators.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t pilot_one_in = 32;   // of all iterations, where nobody says
constexpr std::uint32_t usual_slices = 64;   // likewise
constexpr std::uint32_t slices_a_shard = 4;  // at least, so that none waits long for the others
constexpr std::uint32_t least_slice = 4;     // iterations: a slice costs about as much as one besides

std::uint32_t pilot_of(const PlanOptions& options) {
    return options.pilot.value_or(std::max(usual_pilot, options.settings.iterations / pilot_one_in));
}

std::uint32_t slice_of(const PlanOptions& options) {
    const std::uint32_t slices = std::max(usual_slices, slices_a_shard * options.shards.value_or(1));
    return options.slice.value_or(std::max(least_slice, (options.settings.iterations - pilot_of(options)) / slices));
}

/// How the job is cut. Throws Error(usage) where it cannot be cut so.
void cut(Job& job, const PlanOptions& options) {
    const std::uint32_t pilot = pilot_of(options);
    if (pilot < least_pilot) throw Error(ExitCode::usage, fmt::format("--pilot {} is below {}", pilot, least_pilot));
    if (options.settings.iterations <= pilot) {
        throw Error(ExitCode::usage, fmt::format("--iterations {}: the pilot has as many, {}: nothing is left to share",
                                                 options.settings.iterations, pilot));
    }
    if (options.slice == 0u) throw Error(ExitCode::usage, "--slice 0 is below 1");
    job.pilot = pilot;
    job.slice = slice_of(options);
    job.ends = {options.settings.iterations};
    check_cuts(job);
}

/// Iterations to their end, for people.
std::string told(const Job& job) {
    return fmt::format("{} iterations: {} of the pilot, then {} slices of {}", job.iterations(), job.pilot,
                       cuts_of(job).size() - 1, job.slice);
}

/// Throws Error(usage) where the job that is there is not the one that is asked for.
void require_planned(const Job& there, const PlanOptions& options, const Scene& scene, Settings settings) {
    if (!settings.photons) settings.photons = there.plan.settings.photons;
    Identity asked = identity_of(options.scene, scene, settings, nullptr);
    Identity found = there.identity;
    std::erase_if(found, [](const auto& entry) { return entry.first == "pilot_hash"; });
    asked.emplace_back("pilot", std::to_string(pilot_of(options)));
    asked.emplace_back("slice", std::to_string(slice_of(options)));
    found.emplace_back("slice", std::to_string(there.slice));
    asked.emplace_back("iterations", std::to_string(settings.iterations));
    found.emplace_back("iterations", std::to_string(there.ends.front()));
    require_same(found, asked, there.folder, "the job");
}

void extend(const PlanOptions& options) {
    Job job = read_job(options.job);
    if (*options.extend == 0 || *options.extend > max_iterations - job.iterations()) {
        throw Error(ExitCode::usage,
                    fmt::format("--extend {} is outside 1..{}", *options.extend, max_iterations - job.iterations()));
    }
    job.ends.push_back(job.iterations() + *options.extend);
    check_cuts(job);
    write_job(job);
    if (!options.quiet) print_message(fmt::format("{}: {}", options.job.string(), told(job)));
}

}  // namespace

void execute(const PlanOptions& options) {
    catch_interrupts();
    if (options.extend) return extend(options);
    Job job;
    cut(job, options);
    make_folder(options.job);
    const std::vector<Output> outputs = {{"-o", options.job / "job.json", ".json"}};
    check_outputs({options.scene.file, options.scene.environment}, outputs, false);
    const Scene scene = load_scene(options.scene);
    check_outputs({scene.inputs.begin(), scene.inputs.end()}, outputs, false);
    tell_warnings(scene, options.scene);
    const Settings settings = resolve_settings(options.settings, scene);
    const std::optional<Job> there = is_job(options.job) ? std::optional(read_job(options.job)) : std::nullopt;
    if (there) {
        require_planned(*there, options, scene, settings);
        if (has_pilot(*there)) {
            if (!options.quiet) print_message(fmt::format("{} is planned already", options.job.string()));
            return;
        }
        print_message(
            fmt::format("warning: the pilot of {} is missing or broken: it is rendered again", options.job.string()));
        job.ends = there->ends;
    }
    Device device(options.device);
    const PipelineCache cache(device, options.device.cache);
    SliceRenderer renderer(scene, settings, device);
    job.folder = options.job;
    job.plan = options;
    job.plan.settings = renderer.settings();
    job.plan.folder = fs::relative(fs::current_path(), options.job).string();
    job.scale = renderer.scale();
    job.scene_hash = scene.hash;

    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, std::nullopt);
    const auto rendered = renderer.render_pilot(job.pilot, [&](const Progress& progress) {
        if (!options.quiet) line.update(progress);
        return !interrupted();
    });
    if (!rendered) throw Error(ExitCode::interrupted, "interrupted in the pilot: nothing is planned");
    job.identity = identity_of(options.scene, scene, renderer.settings(), nullptr);
    job.identity.emplace_back("pilot", std::to_string(job.pilot));
    job.identity.emplace_back("pilot_hash", hash_text(fnv1a_of(std::span<const std::byte>(rendered->pilot.state))));
    write_pilot(job, rendered->pilot, rendered->slice.report);
    write_slice(job, {0, 0, job.pilot}, rendered->slice);
    write_job(job);
    if (!options.quiet) {
        line.finish({job.pilot, job.pilot, rendered->slice.report.wall_seconds});
        print_message(fmt::format("{}: {}", options.job.string(), told(job)));
    }
    check_validation(device);
}

}  // namespace vkcppm
