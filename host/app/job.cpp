#include "app/job.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "app/provenance.h"
#include "app/version.h"
#include "core/fnv1a.h"
#include "core/input_file.h"
#include "io/atomic_file.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t most_slices = 1u << 20;

fs::path job_file(const fs::path& folder) { return folder / "job.json"; }
fs::path pilot_file(const Job& job) { return job.folder / "pilot.ckpt"; }

/// Of a slice: that of the job, and which iterations it has.
Identity identity_of(const Job& job, const Cut& cut) {
    Identity identity = job.identity;
    identity.emplace_back("iterations", fmt::format("{}..{}", cut.first, cut.first + cut.count - 1));
    return identity;
}

// ---- sums as bytes: little-endian floats, colours of all pixels, then their surfaces, then groups of errors ----

/// Calls `use` with each number of the surfaces, 17 sums first, then 4 that are none.
template <typename Surface, typename Sum, typename Last> void each_of(Surface& s, const Sum& sum, const Last& last) {
    for (int c = 0; c < 3; ++c) sum(s.albedo[c]);
    for (int c = 0; c < 3; ++c) sum(s.normal[c]);
    sum(s.depth);
    sum(s.hits);
    for (auto& layer : s.layer) {
        for (int c = 0; c < 3; ++c) sum(layer[c]);
    }
    sum(s.seen);
    sum(s.photons);
    last(s.radius2);
    last(s.batch);
    last(s.rejections);
    last(s.statistic);
}
constexpr std::size_t surface_floats = 8 + 3 * LAYERS + 2 + 4;

std::array<std::uint32_t, ERROR_GROUPS> sizes_of(const Cut& cut) {
    auto sizes = group_sizes(cut.first + cut.count);
    const auto before = group_sizes(cut.first);
    for (std::uint32_t group = 0; group < ERROR_GROUPS; ++group) sizes[group] -= before[group];
    return sizes;
}

std::vector<std::byte> bytes_of(const IterationSums& sums) {
    std::vector<float> floats;
    const auto put = [&](double value) { floats.push_back(float(value)); };
    for (const glm::dvec3& sum : sums.film) {
        for (int c = 0; c < 3; ++c) put(sum[c]);
    }
    for (const SurfaceSums& surface : sums.surfaces) each_of(surface, put, put);
    for (const auto& group : sums.errors.of_group) {
        for (const glm::vec4& sum : group) {
            for (int c = 0; c < 4; ++c) put(sum[c]);
        }
    }
    const auto bytes = std::as_bytes(std::span(floats));
    return {bytes.begin(), bytes.end()};
}

/// Floats of such bytes, one after the other.
class Floats {
public:
    explicit Floats(std::span<const std::byte> bytes) : next_(bytes.data()) {}
    float take() {
        float value = 0.0f;
        std::memcpy(&value, next_, sizeof(value));
        next_ += sizeof(value);
        return value;
    }

private:
    const std::byte* next_;
};

std::size_t floats_of(const Job& job, const Cut& cut) {
    std::size_t each = 3;
    if (job.plan.settings.aovs) each += surface_floats;
    if (job.plan.settings.error) {
        const auto sizes = sizes_of(cut);
        each += 4 * std::size_t(std::ranges::count_if(sizes, [](std::uint32_t size) { return size > 0; }));
    }
    return each * job.plan.settings.size->pixels();
}

/// Sums of no iterations.
IterationSums no_sums(const Job& job) {
    const Settings& settings = job.plan.settings;
    const std::size_t pixels = settings.size->pixels();
    IterationSums sums{*settings.size, 0, std::vector<glm::dvec3>(pixels, glm::dvec3(0.0)), {}, {}};
    if (settings.aovs) sums.surfaces.resize(pixels);
    if (settings.error) {
        sums.errors.extent = *settings.size;
        for (auto& group : sums.errors.of_group) group.assign(pixels, glm::vec4(0.0f));
    }
    return sums;
}

/// As add_slice(), but throws what that returns.
Report add_whole(const Job& job, const Cut& cut, IterationSums& sums) {
    const fs::path file = slice_file(job, cut);
    const Checkpoint checkpoint = read_checkpoint(file, identity_of(job, cut), job.plan.settings.size->pixels());
    const std::size_t bytes = floats_of(job, cut) * sizeof(float);
    if (checkpoint.state.size() != bytes || checkpoint.report.iterations != cut.count) {
        throw Error(ExitCode::bad_input,
                    fmt::format("{} has {} bytes of sums over {} iterations, {} over {} are wanted", file.string(),
                                checkpoint.state.size(), checkpoint.report.iterations, bytes, cut.count));
    }
    if (sums.iterations == 0) sums = no_sums(job);
    Floats floats(checkpoint.state);
    const auto add = [&](auto& sum) { sum += floats.take(); };
    const auto take = [&](auto& value) { value = floats.take(); };
    for (glm::dvec3& sum : sums.film) {
        for (int c = 0; c < 3; ++c) add(sum[c]);
    }
    for (SurfaceSums& surface : sums.surfaces) each_of(surface, add, take);
    if (job.plan.settings.error) {
        const auto sizes = sizes_of(cut);
        for (std::uint32_t group = 0; group < ERROR_GROUPS; ++group) {
            sums.errors.sizes[group] += sizes[group];
            if (sizes[group] == 0) continue;
            for (glm::vec4& sum : sums.errors.of_group[group]) {
                for (int c = 0; c < 4; ++c) add(sum[c]);
            }
        }
    }
    sums.iterations += cut.count;
    return checkpoint.report;
}

/// What `read` returns, or throws where a slice is not there or is damaged.
template <typename Read> std::variant<Report, Error> unless_absent(const Read& read) {
    try {
        return read();
    } catch (const Error& error) {
        if (error.code() == ExitCode::usage) throw;
        return error;
    }
}

// ---- job.json ----

Json json_of(const Job& job) {
    Json json;
    json["format"] = "vkcppm job";
    json["version"] = version();
    json["command"] = job.plan.words;
    json["folder"] = job.plan.folder;
    const Settings& settings = job.plan.settings;
    json["size"] = {settings.size->width, settings.size->height};
    json["camera"] = settings.camera;
    json["photons"] = *settings.photons;
    json["scale"] = job.scale;
    json["scene_hash"] = job.scene_hash;
    json["pilot"] = job.pilot;
    json["slice"] = job.slice;
    json["ends"] = job.ends;
    for (const auto& [name, value] : job.identity) json["identity"][name] = value;
    return json;
}

/// A path of the plan's command line as seen from here.
fs::path seen(const fs::path& folder, const std::string& from, const fs::path& file) {
    return file.is_absolute() ? file : (folder / from / file).lexically_normal();
}

Job job_of(const Json& json, const fs::path& folder) {
    Job job;
    job.folder = folder;
    job.plan = parse_plan(json.at("command").get<std::vector<std::string>>());
    job.plan.folder = json.at("folder").get<std::string>();
    const auto look = [&](fs::path& file) { file = seen(folder, job.plan.folder, file); };
    look(job.plan.scene.file);
    if (job.plan.scene.root) look(*job.plan.scene.root);
    if (job.plan.scene.environment) look(*job.plan.scene.environment);
    job.plan.job = folder;
    Settings& settings = job.plan.settings;
    settings.size = Extent{json.at("size").at(0).get<std::uint32_t>(), json.at("size").at(1).get<std::uint32_t>()};
    settings.camera = json.at("camera").get<std::string>();
    settings.photons = json.at("photons").get<std::uint32_t>();
    job.scale = json.at("scale").get<double>();
    job.scene_hash = json.at("scene_hash").get<std::uint64_t>();
    job.pilot = json.at("pilot").get<std::uint32_t>();
    job.slice = json.at("slice").get<std::uint32_t>();
    job.ends = json.at("ends").get<std::vector<std::uint32_t>>();
    for (const auto& [name, value] : json.at("identity").items()) {
        job.identity.emplace_back(name, value.get<std::string>());
    }
    settings.iterations = job.ends.empty() ? 0 : job.iterations();
    const bool in_order = std::ranges::is_sorted(job.ends) && !job.ends.empty() && job.ends.front() > job.pilot;
    if (!in_order || job.pilot < least_pilot || job.slice == 0 || !(job.scale > 0.0))
        throw Error(ExitCode::bad_input, "its numbers are out of range");
    try {
        check_settings(settings);
        check_cuts(job);
    } catch (const Error& error) {
        throw Error(ExitCode::bad_input, error.what());
    }
    return job;
}

}  // namespace

std::vector<Cut> cuts_of(const Job& job) {
    std::vector<Cut> cuts{{0, 0, job.pilot}};
    std::uint32_t first = job.pilot;
    for (const std::uint32_t end : job.ends) {
        while (first < end) {
            const std::uint32_t count = std::min(job.slice, end - first);
            cuts.push_back({std::uint32_t(cuts.size()), first, count});
            first += count;
        }
    }
    return cuts;
}

void check_cuts(const Job& job) {
    std::uint64_t slices = 0;
    std::uint32_t first = job.pilot;
    for (const std::uint32_t end : job.ends) {
        slices += (std::uint64_t(end - first) + job.slice - 1) / job.slice;
        first = end;
    }
    if (slices <= most_slices) return;
    throw Error(ExitCode::usage, fmt::format("--slice {}: {} iterations are {} slices; the limit is {}", job.slice,
                                             job.iterations(), slices, most_slices));
}

std::optional<std::uint32_t> shard_number(const Cut& cut, std::uint32_t shards) {
    if (cut.number == 0) return std::nullopt;
    return (cut.number - 1) % shards + 1;
}

std::string name_of(const Cut& cut) {
    const std::string name = cut.number == 0 ? "the pilot" : fmt::format("slice {}", cut.number);
    return fmt::format("{} (iterations {}..{})", name, cut.first, cut.first + cut.count - 1);
}

std::string shard_of(const Job& job, const Cut& cut) {
    const std::optional<std::uint32_t> shards = job.plan.shards;
    const auto number = shards ? shard_number(cut, *shards) : std::nullopt;
    return number ? fmt::format("shard {}/{}", *number, *shards) : "";
}

bool is_job(const fs::path& folder) { return fs::exists(job_file(folder)); }

void write_job(const Job& job) { write_file(job_file(job.folder), json_text(json_of(job), 2) + "\n"); }

Job read_job(const fs::path& folder) {
    const fs::path file = job_file(folder);
    if (const auto why = why_unreadable(file))
        throw Error(ExitCode::no_input, fmt::format("{}: {}: vkcppm plan makes it", file.string(), *why));
    std::ifstream stream(file, std::ios::binary);
    constexpr std::uint64_t most_bytes = 1u << 20;
    std::error_code error;
    if (const std::uint64_t bytes = fs::file_size(file, error); error || bytes > most_bytes)
        throw Error(ExitCode::bad_input, fmt::format("{} is no job of vkcppm", file.string()));
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    try {
        const Json json = Json::parse(text);
        const auto of = json.at("version").get<std::string>();
        if (of != version()) {
            throw Error(ExitCode::usage, fmt::format("{} is of version {}, this is {}", file.string(), of, version()));
        }
        return job_of(json, folder);
    } catch (const Json::exception&) {
        throw Error(ExitCode::bad_input, fmt::format("{} is no job of vkcppm", file.string()));
    } catch (const Error& bad) {
        if (bad.code() == ExitCode::usage) throw;
        throw Error(bad.code(), fmt::format("{} is no job of vkcppm: {}", file.string(), bad.what()));
    }
}

void write_pilot(const Job& job, const Pilot& pilot, const Report& report) {
    write_checkpoint(pilot_file(job), job.identity, {report, {}, pilot.state});
}

PilotOnDisk read_pilot(const Job& job) {
    Checkpoint checkpoint = read_checkpoint(pilot_file(job), job.identity, job.plan.settings.size->pixels());
    if (checkpoint.report.iterations != job.pilot) {
        throw Error(ExitCode::bad_input,
                    fmt::format("{} has {} iterations, the job tells of {}", pilot_file(job).string(),
                                checkpoint.report.iterations, job.pilot));
    }
    return {{job.pilot, std::move(checkpoint.state)}, std::move(checkpoint.report)};
}

bool has_pilot(const Job& job) {
    const auto read = unless_absent([&] { return read_pilot(job).report; });
    return std::holds_alternative<Report>(read) && !fault_of(job, cuts_of(job).front());
}

fs::path slice_file(const Job& job, const Cut& cut) { return job.folder / fmt::format("slice_{:04}.sums", cut.number); }

void write_slice(const Job& job, const Cut& cut, const Slice& slice) {
    write_checkpoint(slice_file(job, cut), identity_of(job, cut), {slice.report, {}, bytes_of(slice.sums)});
}

std::variant<Report, Error> add_slice(const Job& job, const Cut& cut, IterationSums& sums) {
    return unless_absent([&] { return add_whole(job, cut, sums); });
}

std::optional<Error> fault_of(const Job& job, const Cut& cut) {
    const auto read = unless_absent([&] {
        return read_checkpoint(slice_file(job, cut), identity_of(job, cut), job.plan.settings.size->pixels()).report;
    });
    const Error* fault = std::get_if<Error>(&read);
    return fault ? std::optional(*fault) : std::nullopt;
}

}  // namespace vkcppm
