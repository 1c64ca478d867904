#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "app/checkpoint_file.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/display.h"
#include "app/interrupt.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/pipeline_cache.h"
#include "app/progress.h"
#include "app/provenance.h"
#include "app/race/data.h"
#include "app/race/page.h"
#include "app/race/pictures.h"
#include "app/reference.h"
#include "app/reference_provenance.h"
#include "app/validation.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/png.h"
#include "study/race.h"
#include "study/reference.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// The reference that was asked for, else the one that lies with the scene.
fs::path find_reference(const RaceOptions& options) {
    if (options.reference) return *options.reference;
    const fs::path& scene = options.scene.file;
    const fs::path file = scene.parent_path() / "references" / (scene.stem().string() + ".exr");
    if (!fs::exists(file)) {
        throw Error(ExitCode::usage,
                    fmt::format("nothing to measure against: there is no {}; name a picture of {} by --reference, or "
                                "let --make-reference make one",
                                file.string(), scene.string()));
    }
    return file;
}

/// A line for every attribute of a reference of this program that says that it shows something else than the race.
std::vector<std::string> mismatches(const RaceInput& input, const ExrAttributes& wanted) {
    std::vector<std::string> seen{"scene_hash", "thin_glass"};
    setting::for_each([&](const auto& row) {
        if (row.kind == setting::Kind::view) seen.push_back(json_name(row.name));
    });
    std::vector<std::string> lines;
    for (const auto& [name, value] : input.reference_attributes) {
        for (const std::string& what : seen) {
            if (name != "vkcppm." + what) continue;
            for (const auto& [same, other] : wanted) {
                if (same == name && other != value) {
                    lines.push_back(
                        fmt::format("{} has {} {}, the race {}", input.reference.string(), what, value, other));
                }
            }
        }
    }
    return lines;
}

/// A race must not write over the scene, its files or the reference.
void check_race_outputs(const RaceOptions& options, const RaceInput& input, const RaceSettings& race) {
    std::vector<std::optional<fs::path>> inputs(input.scene.inputs.begin(), input.scene.inputs.end());
    std::vector<std::string> names = {"index.html",    "race.json",  "curves.csv",
                                      "reference.png", "winner.png", "winner-around.png"};
    const fs::path copy = options.folder / "reference.exr";
    if (options.make_reference || !is_same_file(copy, input.reference)) names.push_back("reference.exr");
    if (!options.make_reference) inputs.push_back(input.reference);
    for (const Entrant& entrant : race.entrants) {
        names.push_back(file_stem(entrant) + ".exr");
        for (const std::string& view : entrant_views(entrant.settings)) names.push_back(view_file(entrant, view));
    }
    std::vector<std::string> endings;
    for (const std::string& name : names) endings.push_back(fs::path(name).extension().string());
    std::vector<Output> outputs;
    for (std::size_t i = 0; i < names.size(); ++i) {
        outputs.push_back({"-o", options.folder / names[i], endings[i].c_str()});
    }
    check_outputs(inputs, outputs, false);
}

/// "37 %, seed 1 of 3, 2 min 5 s left; relMSE without the worst 0.1 % cppm 0.00123, sppm 0.00234"
std::string race_text(const RaceProgress& progress) {
    std::string text = fmt::format("{:.0f} %", 100.0 * progress.done);
    const auto out = std::back_inserter(text);
    if (progress.seeds > 1) fmt::format_to(out, ", seed {} of {}", progress.seed + 1, progress.seeds);
    if (progress.done > 0.0) {
        const double left = progress.wall_seconds * (1.0 - progress.done) / progress.done;
        fmt::format_to(out, ", {} left", duration_text(left));
    }
    const Metric& metric = default_metric();
    std::vector<std::string> errors;
    for (const RaceRun& run : progress.runs) {
        if (run.curves.empty() || run.curves.back().empty()) continue;
        errors.push_back(fmt::format("{} {:.3g}", run.entrant.name, metric.of(run.curves.back().back().error)));
    }
    fmt::format_to(out, "; {} {}", metric.title, fmt::join(errors, ", "));
    return text;
}

/// Makes the reference of the race and writes it to DIR/reference.exr, with its attributes into `input`. Its seed is
/// the one after those of the race: photons that both saw would tie their errors.
Image make_race_reference(const RaceOptions& options, RaceInput& input, const RaceSettings& race, Device& device) {
    ReferenceOptions wanted;
    wanted.scene = options.scene;
    wanted.settings.render = race.entrants.front().settings;
    wanted.settings.render.seed += race.seeds;
    wanted.settings.render.iterations = unbounded_iterations;
    wanted.settings.render.seconds = options.make_reference;
    wanted.settings.samples = unbounded_samples;
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, std::nullopt);
    const auto refine = [&](const ReferenceProgress& progress) {
        if (!options.quiet) {
            line.update(progress.wall_seconds,
                        fmt::format("reference: {} of {}{}", duration_text(progress.wall_seconds),
                                    duration_text(*options.make_reference), relmse_text(progress)));
        }
        return !interrupted();
    };
    const Reference reference = make_reference(input.scene, wanted.settings, device, refine);
    if (!options.quiet) line.finish_with(fmt::format("reference: relMSE about {:.2g}", reference.relmse));
    print_warnings(reference.warnings);
    input.reference_attributes = reference_attributes(wanted, input.scene, reference);
    write_exr(input.reference, reference_channels(reference), input.reference_attributes);
    return reference.mean;
}

/// Where an entrant's state lies in the folder of a race.
fs::path state_file(const fs::path& folder, const Entrant& entrant) {
    return folder / "states" / fmt::format("{}-{}.ckpt", file_stem(entrant), entrant.settings.seed);
}

/// A state that cannot be written is told, and the race goes on.
RaceStates states_of(const Scene& scene, const RaceOptions& options, const Image& reference) {
    RaceStates states;
    const auto identity = [&](const Entrant& entrant) {
        return identity_of(options.scene, scene, entrant.settings, &reference);
    };
    if (options.resume) {
        states.find = [=, &options](const Entrant& entrant) -> std::optional<Checkpoint> {
            const fs::path file = state_file(*options.resume, entrant);
            if (!fs::exists(file)) return std::nullopt;  // another seed, or another entrant
            return read_checkpoint(file, identity(entrant), entrant.settings.size->pixels());
        };
    }
    if (options.checkpoint) {
        states.keep = [=, &options](const Entrant& entrant, const Checkpoint& state) {
            try {
                write_checkpoint(state_file(options.folder, entrant), identity(entrant), state);
            } catch (const Error& error) {
                if (error.code() != ExitCode::cannot_write) throw;
                print_message(fmt::format("warning: no state of {}: {}", entrant.name, error.what()));
            }
        };
    }
    return states;
}

RaceResult race_with_progress(const Scene& scene, const RaceOptions& options, const RaceSettings& race,
                              const Image& reference, Device& device) {
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, std::nullopt);
    double wall = 0.0;
    const RaceStates states = states_of(scene, options, reference);
    const auto keep_racing = [&](const RaceProgress& progress) {
        wall = progress.wall_seconds;
        if (!options.quiet) line.update(wall, race_text(progress));
        return !interrupted();
    };
    RaceResult result = run_race(scene, race, reference, device, keep_racing, states);
    if (!options.quiet) {
        line.finish_with(
            fmt::format("{} entrants, {} seeds in {:.1f} s", result.runs.size(), result.seeds.size(), wall));
    }
    return result;
}

void write_pictures(const RaceOptions& options, const RaceInput& input, const RaceResult& result,
                    const Image& reference, const RacePictures& pictures) {
    const auto write_bitmap = [&](const std::string& name, const Bitmap& bitmap) {
        write_file(options.folder / name, encode_png(bitmap));
    };
    const fs::path copy = options.folder / "reference.exr";
    if (!is_same_file(copy, input.reference)) {
        write_exr(copy, reference, input.reference_attributes);
    }
    write_bitmap("reference.png", pictures.reference);
    write_bitmap("winner.png", pictures.winner.map);
    write_bitmap("winner-around.png", pictures.winner_around.map);
    for (std::size_t e = 0; e < result.runs.size(); ++e) {
        const RaceRun& run = result.runs[e];
        Rendering rendering;
        rendering.settings = run.entrant.settings;
        rendering.report = run.reports.front();
        ExrChannels channels = to_channels(run.image);
        channels.values["ppm.radius"] = run.radius;
        channels.values.insert(run.aovs.begin(), run.aovs.end());
        write_exr(options.folder / (file_stem(run.entrant) + ".exr"), channels,
                  exr_attributes(options.scene, input.scene, rendering));
        for (const auto& [view, bitmap] : pictures.entrants[e]) write_bitmap(view_file(run.entrant, view), bitmap);
    }
}

}  // namespace

void execute(const RaceOptions& options) {
    catch_interrupts();
    const Scene scene = load_scene(options.scene);
    tell_warnings(scene, options.scene);
    RaceInput input{scene, options.make_reference ? options.folder / "reference.exr" : find_reference(options), {}};
    RaceSettings wanted = options.race;
    Image reference;
    if (!options.make_reference) {
        input.reference_attributes = read_exr_attributes(input.reference);
        if (!wanted.entrants.front().settings.size) {  // the same for all
            const Extent size = read_exr(input.reference).extent;
            for (Entrant& entrant : wanted.entrants) entrant.settings.size = size;
        }
    }
    const RaceSettings race = resolve_race(wanted, scene);
    if (!options.make_reference) {
        Rendering sample;
        sample.settings = race.entrants.front().settings;
        reference = read_reference(input.reference, *sample.settings.size);
        print_warnings(mismatches(input, exr_attributes(options.scene, scene, sample)));
    }
    if (options.resume && !fs::is_directory(*options.resume / "states")) {
        throw Error(ExitCode::no_input, fmt::format("--resume: there are no states in {}: a race keeps them with "
                                                    "--checkpoint",
                                                    options.resume->string()));
    }
    make_folder(options.folder);
    if (options.checkpoint) {
        make_folder(options.folder / "states");
        check_writable(options.folder / "states" / "a.ckpt");
    }
    check_race_outputs(options, input, race);
    Device device(options.device);
    const PipelineCache cache(device, options.device.cache);
    if (options.make_reference) reference = make_race_reference(options, input, race, device);

    const RaceResult result = race_with_progress(scene, options, race, reference, device);
    print_warnings(result.warnings);
    const Display display = display_of(options.display, reference, input.reference.string(), options.quiet);
    const RacePictures pictures = race_pictures(result, reference, display);
    const nlohmann::ordered_json json = race_json(options, input, result, pictures);
    // What took the time comes first: a disk that fills up costs the pictures, which the page has, too.
    write_file(options.folder / "curves.csv", curves_csv(result));
    write_file(options.folder / "race.json", json_text(json, 2) + "\n");
    const fs::path page = options.folder / "index.html";
    write_file(page, race_page(json, pictures));
    write_pictures(options, input, result, reference, pictures);
    if (result.interrupted) {
        print_message("interrupted: wrote what there is to " + page.string());
    } else if (!options.quiet) {
        print_message("wrote " + page.string());
    }
    check_validation(device);
}

}  // namespace vkcppm
