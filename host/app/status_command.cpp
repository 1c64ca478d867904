#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/job.h"
#include "app/progress.h"
#include "app/provenance.h"
#include "core/error.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// How far a job is.
struct JobStatus {
    std::uint64_t iterations = 0;
    std::uint32_t slices = 0;  // that are there and whole
    std::vector<Cut> missing, broken;
    double cpu_seconds = 0.0;    // of the iterations that are there
    std::optional<double> rate;  // iterations a second of all machines, since the first slice was there
    std::optional<ErrorEstimate> estimate;
};

JobStatus status_of(const Job& job) {
    JobStatus status;
    IterationSums sums;
    std::optional<fs::file_time_type> first, last;
    std::uint64_t since_first = 0;  // iterations
    double slowest = 0.0;           // seconds an iteration of one machine
    for (const Cut& cut : cuts_of(job)) {
        const auto added = add_slice(job, cut, sums);
        if (const Error* fault = std::get_if<Error>(&added)) {
            (fault->code() == ExitCode::no_input ? status.missing : status.broken).push_back(cut);
            continue;
        }
        const Report& report = std::get<Report>(added);
        status.iterations += cut.count;
        status.cpu_seconds += report.cpu_seconds;
        slowest = std::max(slowest, report.wall_seconds / cut.count);
        if (cut.number == 0) continue;
        ++status.slices;
        const fs::file_time_type time = fs::last_write_time(slice_file(job, cut));
        first = first ? std::min(*first, time) : time;
        last = last ? std::max(*last, time) : time;
        since_first += cut.count;
    }
    // The first slice began before it was there: its own iterations do not count.
    const double seconds = first ? std::chrono::duration<double>(*last - *first).count() : 0.0;
    if (status.slices > 1 && seconds > 0.0) {
        status.rate = double(since_first) * (status.slices - 1) / status.slices / seconds;
    } else if (slowest > 0.0) {
        status.rate = 1.0 / slowest;  // as if of one machine
    }
    if (job.plan.settings.error && can_estimate(sums.errors)) status.estimate = estimate_error(sums.errors);
    return status;
}

std::optional<double> seconds_left(const Job& job, const JobStatus& status) {
    if (!status.rate) return std::nullopt;
    return double(job.iterations() - status.iterations) / *status.rate;
}

/// Slices of each shard of the plan that are there, and in all.
std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> shards_of(const Job& job, const JobStatus& status) {
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> shards;
    if (!job.plan.shards) return shards;
    const auto is_in = [](const std::vector<Cut>& cuts, const Cut& cut) {
        return std::ranges::find(cuts, cut.number, &Cut::number) != cuts.end();
    };
    for (const Cut& cut : cuts_of(job)) {
        const auto number = shard_number(cut, *job.plan.shards);
        if (!number) continue;
        auto& [there, all] = shards[*number];
        ++all;
        there += is_in(status.missing, cut) || is_in(status.broken, cut) ? 0 : 1;
    }
    return shards;
}

Json json_of(const Job& job, const JobStatus& status) {
    const auto numbers = [](const std::vector<Cut>& cuts) {
        Json json = Json::array();
        for (const Cut& cut : cuts) json.push_back(cut.number);
        return json;
    };
    Json json{{"job", job.folder.string()},
              {"scene", job.plan.scene.file.string()},
              {"iterations_done", status.iterations},
              {"iterations", job.iterations()},
              {"slices_done", status.slices},
              {"slices", cuts_of(job).size() - 1},
              {"missing", numbers(status.missing)},
              {"broken", numbers(status.broken)},
              {"complete", status.missing.empty() && status.broken.empty()},
              {"cpu_seconds", status.cpu_seconds}};
    if (status.rate) json["iterations_a_second"] = *status.rate;
    if (const auto left = seconds_left(job, status)) json["seconds_left"] = *left;
    for (const auto& [number, slices] : shards_of(job, status)) {
        json["shards"].push_back({{"number", number}, {"slices_done", slices.first}, {"slices", slices.second}});
    }
    if (status.estimate) json["estimate"] = estimate_json(*status.estimate);
    return json;
}

std::string plain_text(const Job& job, const JobStatus& status) {
    std::string text = fmt::format("{}: {} of {} slices, {} of {} iterations", job.folder.string(), status.slices,
                                   cuts_of(job).size() - 1, status.iterations, job.iterations());
    if (const auto left = seconds_left(job, status); left && status.iterations < job.iterations())
        text += fmt::format(", {:.3g} iterations a second, {} left", *status.rate, duration_text(*left));
    text += "\n";
    for (const auto& [number, slices] : shards_of(job, status)) {
        text += fmt::format("  shard {}/{}: {} of {} slices\n", number, *job.plan.shards, slices.first, slices.second);
    }
    for (const Cut& cut : status.broken) text += fmt::format("  {} is broken\n", name_of(cut));
    if (status.estimate) text += estimate_line(*status.estimate) + "\n";
    return text;
}

}  // namespace

void execute(const StatusOptions& options) {
    const Job job = read_job(options.job);
    const JobStatus status = status_of(job);
    print_result(options.json ? json_text(json_of(job, status), 2) + "\n" : plain_text(job, status));
}

}  // namespace vkcppm
