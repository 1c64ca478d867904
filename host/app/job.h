#pragma once
// A job on disk: a render that many machines share. A folder with
//   job.json          the command line that planned it, what was made of that, and how it is cut; written last
//   pilot.ckpt        what slices hang on: a checkpoint after the pilot's iterations
//   slice_0000.sums   what the pilot's iterations have added up to
//   slice_0001.sums   what those of the first slice have, and so on
// Each is written whole or not at all, and none is written to again. Slices are checkpoints in form
// (app/checkpoint_file.h), whose state is sums.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "app/checkpoint_file.h"
#include "app/options.h"
#include "core/error.h"
#include "render/slices.h"

namespace vkcppm {

/// Iterations that are rendered as one. Number 0 is the pilot.
struct Cut {
    std::uint32_t number = 0;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct Job {
    std::filesystem::path folder;
    PlanOptions plan;                    // as it was given, files as seen from here, the settings resolved
    Identity identity;                   // of the render and of its pilot
    double scale = 1.0;                  // frame units a metre
    std::uint32_t pilot = 0, slice = 0;  // iterations of it, and of a slice
    std::vector<std::uint32_t> ends;     // iterations in all, as it was planned and after each extension; at least one
    std::uint64_t scene_hash = 0;

    std::uint32_t iterations() const { return ends.back(); }
};

/// All of them in order, the pilot first: slices of `slice` iterations, and shorter ones where it once ended.
std::vector<Cut> cuts_of(const Job& job);

/// Throws Error(usage) where the job is of more slices than a folder should hold.
void check_cuts(const Job& job);

/// The shard of so many, from 1 on, that a slice is of: they are dealt out in turn. None of the pilot.
std::optional<std::uint32_t> shard_number(const Cut& cut, std::uint32_t shards);

/// "slice 3 (iterations 48..63)".
std::string name_of(const Cut& cut);

/// The shard of the plan's that a slice is of, "shard 2/5"; empty where the plan tells of none, and of the pilot.
std::string shard_of(const Job& job, const Cut& cut);

/// Whether a job is there.
bool is_job(const std::filesystem::path& folder);

/// Replaces job.json. Throws Error(cannot_write).
void write_job(const Job& job);

/// Throws Error(no_input) where there is none, Error(bad_input) where it is not one, Error(usage) where it is of
/// another version.
Job read_job(const std::filesystem::path& folder);

/// As write_checkpoint() and read_checkpoint() do.
void write_pilot(const Job& job, const Pilot& pilot, const Report& report);
struct PilotOnDisk {
    Pilot pilot;
    Report report;
};
PilotOnDisk read_pilot(const Job& job);

/// Whether all that `vkcppm plan` renders is there and whole. Throws Error(usage) where it is of another job.
bool has_pilot(const Job& job);

std::filesystem::path slice_file(const Job& job, const Cut& cut);
void write_slice(const Job& job, const Cut& cut, const Slice& slice);

/// Adds what is on disk to the sums, empty at first: no memory is taken before a file is found whole. The slice's
/// report, or why there is none: Error(no_input) where the file is not there, Error(bad_input) where it is damaged.
/// Throws Error(usage) with what differs where it is of another job.
std::variant<Report, Error> add_slice(const Job& job, const Cut& cut, IterationSums& sums);

/// Why add_slice() would find none.
std::optional<Error> fault_of(const Job& job, const Cut& cut);

}  // namespace vkcppm
