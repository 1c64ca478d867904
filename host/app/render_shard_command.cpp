#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/job.h"
#include "app/load.h"
#include "app/pipeline_cache.h"
#include "app/progress.h"
#include "app/validation.h"
#include "core/error.h"

namespace vkcppm {
namespace {

std::string text_of(const Shard& shard) { return fmt::format("shard {}/{}", shard.number, shard.of); }

/// The slices of the shard that are not there, or are damaged.
std::vector<Cut> left_of(const Job& job, const Shard& shard) {
    std::vector<Cut> left;
    for (const Cut& cut : cuts_of(job)) {
        if (shard_number(cut, shard.of) != shard.number) continue;
        const std::optional<Error> fault = fault_of(job, cut);
        if (!fault) continue;
        if (fault->code() != ExitCode::no_input)
            print_message(fmt::format("warning: {}: it is rendered again", fault->what()));
        left.push_back(cut);
    }
    return left;
}

/// Throws Error(usage) with what differs where the scene here is not that of the plan, or the kernels are others.
void require_of_job(const Job& job, const Scene& scene) {
    Identity here = identity_of(job.plan.scene, scene, job.plan.settings, nullptr);
    for (const auto& entry : job.identity) {
        if (entry.first == "pilot" || entry.first == "pilot_hash") here.push_back(entry);
    }
    require_same(job.identity, here, job.folder, "the job");
}

}  // namespace

void execute(const ShardOptions& options) {
    catch_interrupts();
    const Job job = read_job(options.job);
    const std::vector<Cut> left = left_of(job, options.shard);
    if (left.empty()) {
        if (!options.quiet) print_message(fmt::format("{} is there already", text_of(options.shard)));
        return;
    }
    const Scene scene = load_scene(job.plan.scene);
    require_of_job(job, scene);
    const PilotOnDisk on_disk = read_pilot(job);
    Device device(options.device);
    const PipelineCache cache(device, options.device.cache);
    const DeviceInfo& info = device.info();
    if (info.name != on_disk.report.device || info.driver != on_disk.report.driver) {
        print_message(
            fmt::format("warning: the job was planned on {}, {}; here is {}, {}: the picture may have other "
                        "bits than of one device",
                        on_disk.report.device, on_disk.report.driver, info.name, info.driver));
    }
    SliceRenderer renderer(scene, job.plan.settings, device);
    std::uint32_t all = 0, done = 0;  // iterations
    for (const Cut& cut : left) all += cut.count;
    double seconds = 0.0;
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, std::nullopt);
    for (std::size_t i = 0; i < left.size(); ++i) {
        const Cut& cut = left[i];
        if (i > 0 && !fault_of(job, cut)) {  // another worker has been quicker
            all -= cut.count;
            continue;
        }
        const std::optional<Slice> slice =
            renderer.render_slice(on_disk.pilot, cut.first, cut.count, [&](const Progress& progress) {
                if (!options.quiet)
                    line.update({done + progress.iterations_done, all, seconds + progress.wall_seconds});
                return !interrupted();
            });
        if (!slice) {
            throw Error(ExitCode::interrupted,
                        fmt::format("interrupted in {}; {} of {} slices of {} were rendered: the same command goes on",
                                    name_of(cut), i, left.size(), text_of(options.shard)));
        }
        write_slice(job, cut, *slice);
        done += cut.count;
        seconds += slice->report.wall_seconds;
    }
    if (!options.quiet) line.finish({done, all, seconds});
    check_validation(device);
}

}  // namespace vkcppm
