#include "app/options.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <initializer_list>
#include <numeric>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/option_values.h"
#include "app/version.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "render/estimators.h"
#include "render/settings_rows.h"
#include "render/slices.h"

namespace vkcppm {
namespace {

using setting::Kind;
using setting::Unit;
using Words = std::vector<std::string>;

constexpr double race_seconds = 60.0;        // of each entrant with each seed, where nothing else bounds them
constexpr std::uint32_t most_seeds = 10000;  // of a race: more is taken for a slip
constexpr std::uint32_t most_shards = 1u << 20;
constexpr const char* race_estimators = "cppm,sppm,appm";

constexpr const char* footer = R"(Exit codes:
  0 done   2 usage   65 bad input   66 no such file   69 no usable Vulkan device   70 internal
  71 out of device memory   73 cannot write   75 device lost)";

/// Adds an option whose value `parse` turns into `target`.
template <typename Target, typename Value>
CLI::Option* add(CLI::App& app, const std::string& name, const char* type, Target& target,
                 Value (*parse)(const std::string& option, const std::string& text), const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [&target, name, parse](const std::string& text) { target = parse(name, text); }, help)
        ->type_name(type);
}

// How a value of a setting is read, by its type; seconds are the one unit that is written with suffixes.
auto parser_of(std::uint32_t, Unit) { return parse_whole; }
auto parser_of(double, Unit unit) { return unit == Unit::seconds ? parse_seconds : parse_real; }
auto parser_of(const std::string&, Unit) { return parse_name; }
auto parser_of(const Extent&, Unit) { return parse_size; }
template <typename T> auto parser_of(const std::optional<T>&, Unit unit) { return parser_of(T(), unit); }

const char* type_name(Unit unit) {
    switch (unit) {
        case Unit::count: return "N";
        case Unit::number: return "X";
        case Unit::metres: return "METRES";
        case Unit::seconds: return "TIME";
        case Unit::pixels: return "WxH";
        case Unit::camera: return "NAME|INDEX";
        case Unit::name: return "NAME";
        case Unit::flag: break;
    }
    return "";
}

/// The values of a list and what they are; empty where there is no list of names.
std::vector<std::pair<std::string, std::string>> choices_of(const auto&) { return {}; }
std::vector<std::pair<std::string, std::string>> choices_of(setting::AnEstimator) {
    std::vector<std::pair<std::string, std::string>> choices;
    for (const EstimatorRow& row : estimators()) choices.emplace_back(row.name, row.summary);
    return choices;
}
template <std::size_t N> std::vector<std::pair<std::string, std::string>> choices_of(const setting::Words<N>& words) {
    std::vector<std::pair<std::string, std::string>> choices;
    for (const setting::Word& word : words.values) choices.emplace_back(word.name, word.summary);
    return choices;
}

/// The row's help with its default and choices.
std::string help_of(const auto& row) {
    std::string choices;
    for (const auto& [name, summary] : choices_of(row.values)) choices += fmt::format("\n{}: {}", name, summary);
    const Settings standard;
    const auto& value = standard.*row.member;
    if constexpr (fmt::is_formattable<std::remove_cvref_t<decltype(value)>>::value)
        return fmt::format(fmt::runtime(row.help), value, fmt::arg("choices", choices));
    return row.help;
}

void add_setting(CLI::App& app, const auto& row, Settings& settings, const std::string& help) {
    const std::string option = fmt::format("--{}", row.name);
    auto& target = settings.*row.member;
    if constexpr (std::is_same_v<decltype(target), bool&>) {
        app.add_flag(option, target, help);
    } else {
        add(app, option, type_name(row.unit), target, parser_of(target, row.unit), help);
    }
}

/// The settings of these kinds.
void add_settings(CLI::App& app, Settings& settings, std::initializer_list<Kind> kinds) {
    setting::for_each([&](const auto& row) {
        if (std::ranges::find(kinds, row.kind) != kinds.end()) add_setting(app, row, settings, help_of(row));
    });
}

/// How a picture is made and what it shows: for whatever makes one.
void add_picture(CLI::App& app, Settings& settings) {
    add_settings(app, settings, {Kind::picture, Kind::paths, Kind::view});
}

/// The setting of that name, with the command's own words.
void add_setting(CLI::App& app, Settings& settings, std::string_view name, const std::string& help) {
    [[maybe_unused]] bool found = false;
    setting::for_each([&](const auto& row) {
        if (row.name != name) return;
        add_setting(app, row, settings, help);
        found = true;
    });
    assert(found);
}

void add_scene(CLI::App& app, SceneOptions& scene) {
    app.add_option("SCENE", scene.file, "glTF 2.0 file, .gltf or .glb")->required()->type_name("");
    app.add_option("--root", scene.root,
                   "Folder that holds all files which the scene names, as by ../textures/x.png; what lies outside is\n"
                   "not read (default: the scene's own folder)")
        ->type_name("DIR");
    add(app, "--animation", "NAME|INDEX|all", scene.animation, parse_name,
        "Put nodes, joints and morph targets where this animation has them (default: at rest)");
    add(app, "--at", "SECONDS", scene.at, parse_moment, "At this time of the animation (default: 0)")
        ->needs("--animation");
    add(app, "--variant", "NAME|INDEX", scene.variant, parse_name,
        "Materials of this variant (KHR_materials_variants)");
    app.add_option_function<Words>(
           "--set",
           [&scene](const Words& words) {
               for (const std::string& word : words) scene.set.push_back(parse_material_change(word));
           },
           "Values of a material, named or by its index, such as glass:ior=1.33; may be given again. Members are\n" +
               material_members(90))
        ->type_name("MATERIAL:MEMBER=VALUE[:...]")
        ->allow_extra_args(false);
    add(app, "--punctual-units", "radiometric|photometric|auto", scene.punctual_units, parse_punctual_units,
        "Intensities of point, spot and directional lights: W/sr and W/m2, or candela and lux, 683 of which make\n"
        "one of those; auto: the latter where Blender's exporter wrote the file (default: auto)");
    app.add_option("--environment", scene.environment,
                   "Light from outside: a picture of all directions, EXR or Radiance")
        ->type_name("FILE.exr|.hdr");
    add(app, "--environment-rotation", "DEGREES", scene.environment_rotation, parse_real,
        "Turn it about the vertical, counter-clockwise seen from above (default: 0)")
        ->needs("--environment");
    add(app, "--environment-strength", "X", scene.environment_strength, parse_factor,
        "Multiply its radiance by this (default: 1)")
        ->needs("--environment");
    add(app, "--thin-glass", "thin|solid", scene.thin_glass, parse_thin_glass,
        "Glass without a volume thickness: thin-walled, or solid where its mesh is closed (default: thin)");
    app.add_flag("--strict", scene.strict, "Warnings about the scene end the program, with exit code 65");
}

/// How `what` is shown.
std::array<CLI::Option*, 2> add_display(CLI::App& app, DisplayOptions& display, const std::string& what) {
    CLI::Option* exposure =
        add(app, "--exposure", "EV|auto", display.exposure, parse_exposure,
            fmt::format("Stops by which {} {} brightened; auto: the median luminance becomes middle grey (default: 0)",
                        what, what.ends_with('s') ? "are" : "is"));
    CLI::Option* tone_map = add(app, "--tone-map", "none|reinhard|aces|agx", display.tone_map, parse_tone_map,
                                "The curve that brings what is brighter than white below it (default: none)");
    return {exposure, tone_map};
}

void add_device(CLI::App& app, Device::Options& device) {
    add(app, "--device", "NAME|INDEX|uuid:...", device.select, parse_name,
        "Vulkan device; vkcppm devices lists them (default: the fastest)");
    app.add_flag("--validate", device.validate, "Load the validation layer; its messages make the exit code 70");
    app.add_flag_callback(
        "--no-cache", [&device] { device.cache = false; },
        "Neither read nor write compiled kernels in $XDG_CACHE_HOME/vkcppm");
}

std::string what_is_wrong(const CLI::App& app, const std::string& found);

/// NAME or NAME:PARAMETER=VALUE:...; the rest as in `common`.
Entrant parse_entrant(const std::string& text, const Settings& common) try {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
    Entrant entrant{text, common};
    entrant.settings.estimator = find_estimator(parts.empty() ? "" : parts.front()).name;
    CLI::App app("", "--estimators");
    add_settings(app, entrant.settings, {Kind::parameter, Kind::paths});
    app.set_help_flag();
    Words names, words;
    for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name().substr(2));
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        const std::string name = parts[i].substr(0, equals);
        if (equals == std::string::npos || std::ranges::find(names, name) == names.end()) {
            throw Error(ExitCode::usage,
                        fmt::format("'{}' is not PARAMETER=VALUE, of {}", parts[i], fmt::join(names, ", ")));
        }
        words.insert(words.end(), {"--" + name, parts[i].substr(equals + 1)});
    }
    try {
        app.parse(Words(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, what_is_wrong(app, error.what()));
    }
    return entrant;
} catch (const Error& error) {
    throw Error(error.code(), fmt::format("--estimators: '{}': {}", text, error.what()));
}

/// Letters that are put in, left out or replaced between two words (Levenshtein 1966).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
    const char* plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

/// Throws Error(usage) where more is given beside an option than what goes with it.
void require_alone(const CLI::App& app, const char* name, const Words& with, const char* why) {
    if (app.count(name) == 0) return;
    for (const CLI::Option* option : app.get_options()) {
        const std::string other = option->get_name();
        if (option->count() > 0 && other != name && std::ranges::find(with, other) == with.end())
            throw Error(ExitCode::usage, fmt::format("{} excludes {}: {}", name, other, why));
    }
}

// A command is two functions of its options: declare() says what can be given and where it goes, finish() does, once
// the words are read, what several of them decide together.

void declare(CLI::App& app, RenderOptions& options) {
    app.footer(footer);
    app.set_version_flag("--version", commit().empty() ? fmt::format("vkcppm {}", version())
                                                       : fmt::format("vkcppm {} ({})", version(), commit()));
    add_scene(app, options.scene);
    app.add_option("-o", options.output, "The picture, linear float EXR (default: the scene's name with .exr, here)")
        ->type_name("OUT.exr");
    app.add_option("--png", options.png, "The picture for the eye, sRGB, as well")->type_name("FILE.png");
    for (CLI::Option* option : add_display(app, options.display, "the PNG")) option->needs("--png");
    add(app, "--png-depth", "8|16", options.png_depth, parse_png_depth, "Bits of a number of the PNG (default: 8)")
        ->needs("--png");
    add_settings(app, options.settings, {Kind::method, Kind::bound});
    app.add_option("--reference", options.reference,
                   "Measure the error against this picture after 1, 2, 4, ... 64, 128, 192, ... iterations, for\n"
                   "--stats. The clock stands still meanwhile: it runs in the passes of the iterations, not while\n"
                   "scene and kernels are loaded, errors measured or pictures written")
        ->type_name("REF.exr");
    add(app, "--stop-at", "METRIC=VALUE", options.stop_at, parse_stop_at,
        "Stop after the first iteration after which the error is at most this, such as relmse_trimmed=0.0035;\n"
        "one of " +
            metric_names())
        ->needs("--reference");
    add(app, "--target", "MEASURE=VALUE", options.target, parse_target,
        "Stop where the render's own estimate of its error, noise and bias, is surely at most this, such as\n"
        "relmse_trimmed=0.001; or its noise alone, the median relative standard error of pixels: noise=2%. As\n"
        "--error; --iterations and --time bound it (default then: no bound of iterations)");
    add(app, "--confidence", "PERCENT", options.confidence, parse_confidence,
        fmt::format("Of the estimate's upper bound, which --target looks at (default: {:g})",
                    100.0 * options.confidence))
        ->needs("--target");
    app.add_option(
           "--checkpoint", options.checkpoint,
           "Keep the state of the render in this file, which is replaced whole, and once more at the end; what\n"
           "was there is lost")
        ->type_name("FILE");
    app.add_option(
           "--resume", options.resume,
           "Go on from such a file, and keep the state there unless --checkpoint names another. Scene and settings\n"
           "must be the same, but --iterations and --time, which count from the first start, may be larger")
        ->type_name("FILE");
    add(app, "--checkpoint-every", "TIME", options.checkpoint_every, parse_seconds,
        fmt::format("Rendering time between two states that are kept (default: {:g}s)", options.checkpoint_every));
    CLI::Option* snapshot =
        add(app, "--snapshot", "TIME", options.snapshot, parse_seconds,
            "Write the picture, and the PNG, on the way as well: each time that so much rendering time has passed");
    CLI::Option* live =
        add(app, "--live", "HOST:PORT", options.live, parse_live,
            "Show the picture on its way in tev, which listens there (tev's own port: 14158): once a second of\n"
            "rendering. A viewer that is not there costs a warning");
    CLI::Option* frames =
        add(app, "--frames", "FIRST..LAST", options.frames, parse_frames,
            "Render these frames of the animation, frame i at i / fps seconds, each into files of its own: -o, --png\n"
            "and --stats have a place for its number, as out_%04d.exr (default: the scene's name with _%04d.exr).\n"
            "A frame whose files are there and are of this render is skipped");
    frames->needs("--animation")->excludes("--at")->excludes("--checkpoint")->excludes("--resume");
    frames->excludes("--reference")->excludes("--target")->excludes(snapshot)->excludes(live);
    add(app, "--fps", "X", options.fps, parse_rate, fmt::format("Frames of a second (default: {:g})", options.fps))
        ->needs(frames);
    add_picture(app, options.settings);
    add_settings(app, options.settings, {Kind::parameter});
    add_settings(app, options.settings, {Kind::layers, Kind::channels});
    add_device(app, options.device);
    app.add_option("--stats", options.stats, "Times and counts of the render")->type_name("FILE.json");
    app.add_flag(
        "--hash", options.hash,
        "Print a hash of what each pass of each iteration wrote, and of the picture, to find where two renders\n"
        "part; slower");
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
    app.add_flag("--verbose", options.verbose, "Times of the passes at the end");
}

void finish(const CLI::App& app, const Words&, RenderOptions& options) {
    if (app.count("-o") == 0) {
        options.output = options.scene.file.stem().string() + (options.frames ? "_%04d.exr" : ".exr");
    }
    if (!options.checkpoint) options.checkpoint = options.resume;
    if (!options.checkpoint && app.count("--checkpoint-every") > 0)
        throw Error(ExitCode::usage, "--checkpoint-every needs --checkpoint or --resume");
    if (app.count("--iterations") == 0 && (options.settings.seconds || options.target))
        options.settings.iterations = unbounded_iterations;
    if (options.target) {
        options.target->confidence = options.confidence;
        options.settings.error = true;
    }
    for (const auto& file : {std::optional(options.output), options.png}) {
        if (options.snapshot && file && is_standard_output(*file))
            throw Error(ExitCode::usage, "--snapshot: standard output is no place to write a picture to again");
    }
}

constexpr const char* job_footer = R"(Exit codes:
  0 done   2 usage   65 bad input   66 no such file   69 no usable Vulkan device   70 internal
  71 out of device memory   73 cannot write   75 device lost   130 interrupted)";

void add_job(CLI::App& app, std::filesystem::path& job) {
    app.add_option("JOB", job, "Folder that vkcppm plan has made")->required()->type_name("DIR");
}

void declare(CLI::App& app, PlanOptions& options) {
    app.footer(job_footer);
    add_scene(app, options.scene);
    app.get_option("SCENE")->required(false);
    app.add_option("-o", options.job, "Folder of the job; made where there is none")->required()->type_name("JOB");
    add_settings(app, options.settings, {Kind::method});
    add_setting(app, options.settings, "iterations",
                fmt::format("Iterations of all machines together (default: {})", options.settings.iterations));
    add(app, "--pilot", "N", options.pilot, parse_whole,
        fmt::format("Iterations that are rendered here and now, for all machines to go by; {} or more\n"
                    "(default: a 32nd of all, {} or more)",
                    least_pilot, usual_pilot));
    add(app, "--slice", "N", options.slice, parse_whole,
        "Iterations that are rendered and written as one (default: so that there are about 64 slices, or 4 for\n"
        "each of --shards, of 4 iterations or more)");
    add(app, "--shards", "N", options.shards, parse_whole,
        "Machines that it is meant for: what is missing is told by shard. Any other number may be taken");
    add(app, "--extend", "N", options.extend, parse_whole,
        "Iterations that the job in this folder is to have more; scene and settings are the job's");
    add_picture(app, options.settings);
    add_settings(app, options.settings, {Kind::parameter});
    add_settings(app, options.settings, {Kind::layers, Kind::channels});
    add_device(app, options.device);
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
}

void finish(const CLI::App& app, const Words& words, PlanOptions& options) {
    options.words = words;
    if (options.shards && (*options.shards < 1 || *options.shards > most_shards))
        refuse("--shards", std::to_string(*options.shards), fmt::format("a number from 1 to {}", most_shards));
    require_alone(app, "--extend", {"-o", "--quiet"}, "it is the job's");
    if (!options.extend && app.count("SCENE") == 0)
        throw Error(ExitCode::usage, "SCENE is required (see vkcppm plan --help)");
}

void declare(CLI::App& app, ShardOptions& options) {
    app.footer(job_footer);
    add_job(app, options.job);
    add(app, "--shard", "K/N", options.shard, parse_shard,
        "Slices K, K + N, K + 2 N, ...; those that are there are left as they are")
        ->required();
    add_device(app, options.device);
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
}

void declare(CLI::App& app, MergeOptions& options) {
    app.footer(job_footer);
    add_job(app, options.job);
    app.add_option("-o", options.output, "The picture, linear float EXR")->required()->type_name("OUT.exr");
    app.add_option("--png", options.png, "The picture for the eye, sRGB, as well")->type_name("FILE.png");
    for (CLI::Option* option : add_display(app, options.display, "the PNG")) option->needs("--png");
    add(app, "--png-depth", "8|16", options.png_depth, parse_png_depth, "Bits of a number of the PNG (default: 8)")
        ->needs("--png");
    app.add_flag("--complete", options.complete,
                 "Nothing is written unless every slice is there: else the picture is that of those that are");
    app.add_flag("--quiet", options.quiet, "Only warnings and errors");
}

void declare(CLI::App& app, StatusOptions& options) {
    add_job(app, options.job);
    app.add_flag("--json", options.json, "Print JSON");
}

void declare(CLI::App& app, RaceOptions& options) {
    app.footer(footer);
    add_scene(app, options.scene);
    app.add_option("-o", options.folder, "Folder for the page, curves and pictures; made where there is none")
        ->required()
        ->type_name("DIR");
    app.add_option("--estimators")
        ->description(fmt::format("Who takes part, parameters behind a colon: cppm,cppm:beta=1.5:k=0.7,sppm\n"
                                  "(default: {}). The same seed means the same photon paths for all, and the same\n"
                                  "starting radii, unless they differ in photons, max-depth or knn",
                                  race_estimators))
        ->type_name("NAME[:PARAMETER=VALUE]...,...");
    // What all entrants have in common; finish() makes them of it.
    Settings& settings = options.race.entrants.emplace_back().settings;
    add_setting(
        app, settings, "time",
        fmt::format("What each gets for each seed, on a clock that runs during its passes alone (default: {:g}s)",
                    race_seconds));
    add_setting(app, settings, "iterations", "What each gets for each seed; with --time, what comes first");
    add(app, "--seeds", "N", options.race.seeds, parse_whole,
        "Repeat with so many seeds, from --seed on: two or more give confidence intervals (default: 1)");
    app.add_option("--reference", options.reference,
                   "What errors are measured against; without --size it tells the size\n"
                   "(default: references/NAME.exr beside the scene)")
        ->type_name("REF.exr");
    add(app, "--stop-at", "METRIC=VALUE", options.race.stop_at, parse_stop_at,
        "End an entrant with the first point of its curve, after 1, 2, 4, ... 64, 128, 192, ... iterations, that\n"
        "is at most so far from the reference, such as relmse_trimmed=0.0035; one of\n" +
            metric_names());
    add(app, "--make-reference", "TIME", options.make_reference, parse_seconds,
        "Make it first, in this time, as vkcppm reference does, with a seed that does not race: DIR/reference.exr")
        ->excludes("--reference");
    app.add_flag("--checkpoint", options.checkpoint,
                 "Keep the state of every entrant and seed in DIR/states, from which --resume goes on");
    app.add_option("--resume", options.resume,
                   "Go on from the states of the race in this folder, with more time, iterations or seeds; what else\n"
                   "is set must be the same. New states are kept in DIR, which may be that folder")
        ->type_name("DIR")
        ->excludes("--make-reference");
    add_display(app, options.display, "pictures");
    add_picture(app, settings);
    add_settings(app, settings, {Kind::parameter});
    add_setting(app, settings, "aovs",
                "Show the layers of every entrant's picture, too: direct, caustic and rest; and add channels to its\n"
                "EXR, as vkcppm SCENE does");
    add_device(app, options.device);
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
}

void finish(const CLI::App& app, const Words& words, RaceOptions& options) {
    options.checkpoint = options.checkpoint || options.resume;
    if (options.race.seeds == 0 || options.race.seeds > most_seeds)
        refuse("--seeds", std::to_string(options.race.seeds), fmt::format("a number from 1 to {}", most_seeds));
    Settings settings = options.race.entrants.front().settings;
    if (app.count("--iterations") == 0) {
        settings.iterations = unbounded_iterations;
        if (!settings.seconds) settings.seconds = race_seconds;
    }
    options.race.entrants.clear();
    const CLI::Option* estimators = app.get_option("--estimators");
    std::istringstream stream((estimators->count() > 0 ? estimators->as<std::string>() : race_estimators) + ",");
    for (std::string entrant; std::getline(stream, entrant, ',');)
        options.race.entrants.push_back(parse_entrant(entrant, settings));
    options.command = "vkcppm race";
    for (const std::string& word : words) options.command += " " + quoted(word);
}

void declare(CLI::App& app, ReferenceOptions& options) {
    ReferenceSettings& settings = options.settings;
    add_scene(app, options.scene);
    app.add_option("-o", options.output, "The picture: linear EXR of R G B, StdErr, StdErr.8, ... and Trust")
        ->type_name("REF.exr")
        ->required();
    app.add_flag("--half", options.half, "16-bit floats: a small file");
    add_setting(app, settings.render, "time", "Stop when this time has passed: 90, 90s, 2m, 1.5h, 500ms");
    add(app, "--samples", "N", settings.samples, parse_whole,
        fmt::format("Paths a pixel, at most (default: {}; unbounded with --time)", settings.samples));
    add_setting(app, settings.render, "iterations",
                fmt::format("Iterations of caustics, at most (default: {}; unbounded with --time)",
                            settings.render.iterations));
    add(app, "--trust", "X", settings.trust, parse_real,
        fmt::format("Largest relative standard error of a pixel that is trusted (default: {})", settings.trust));
    add_picture(app, settings.render);
    add_device(app, options.device);
    app.add_option("--stats", options.stats, "Times and counts")->type_name("FILE.json");
    app.add_flag("--quiet", options.quiet, "No progress, only the summary");
    app.add_flag("--json", options.json, "Print the summary as JSON");
}

void finish(const CLI::App& app, const Words&, ReferenceOptions& options) {
    ReferenceSettings& settings = options.settings;
    if (!settings.render.seconds) return;
    if (app.count("--samples") == 0) settings.samples = unbounded_samples;
    if (app.count("--iterations") == 0) settings.render.iterations = unbounded_iterations;
}

void declare(CLI::App& app, CompareOptions& options) {
    app.add_option("IMAGE", options.image, "EXR file")->required()->type_name("");
    app.add_option("REFERENCE", options.reference, "EXR file of the same size")->required()->type_name("");
    app.add_flag("--json", options.json, "Print JSON");
}

void declare(CLI::App& app, CheckOptions& options) {
    app.footer(
        "Without --max and --max-pixels both pictures need a channel StdErr, as vkcppm reference writes it.\n"
        "Exit codes:\n"
        "  0 passes   1 differs   2 usage   65 bad picture   66 no such file   73 cannot write");
    CheckSettings& settings = options.settings;
    app.add_option("IMAGE", options.image, "EXR file")->required()->type_name("");
    app.add_option("REFERENCE", options.reference, "EXR file of the same size")->required()->type_name("");
    app.add_option_function<Words>(
           "--max",
           [&options](const Words& words) {
               for (const std::string& word : words) options.settings.bounds.push_back(parse_bound("--max", word));
           },
           "The most that a measure may be, such as flip=0.05; may be given again, all must hold. One of\n" +
               measure_names())
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    add(app, "--max-pixels", "SHARE", settings.max_pixels, parse_share,
        "The most pixels that may differ, such as 0.1%");
    add(app, "--pixel-bound", "SHARE", settings.pixel_bound, parse_share,
        fmt::format("By how much one differs: the square root of its relMSE is above this (default: {:g}%)",
                    100.0 * settings.pixel_bound))
        ->needs("--max-pixels");
    add(app, "--level", "SHARE", settings.level, parse_share,
        fmt::format("How often two right pictures fail by chance where noise is to explain their difference, all\n"
                    "pixels and blocks together (default: {:g}%)",
                    100.0 * usual_level));
    app.add_flag("--update", options.update, "Replace the reference by the image instead, whatever they are");
    app.add_option("--junit", options.junit, "The verdict for a CI server")->type_name("FILE.xml");
    app.add_option("--report", options.report,
                   "Folder for a page of both pictures and where they differ, index.html; made where there is none")
        ->type_name("DIR");
    for (CLI::Option* option : add_display(app, options.display, "pictures of the page")) option->needs("--report");
    app.add_flag("--json", options.json, "Print JSON");
}

void finish(const CLI::App& app, const Words&, CheckOptions& options) {
    require_alone(app, "--update", {"IMAGE", "REFERENCE"}, "the picture is not checked");
    const CheckSettings& settings = options.settings;
    if (settings.level && !(*settings.level > 0.0 && *settings.level < 1.0))
        throw Error(ExitCode::usage, fmt::format("--level {:g} is not between 0 and 1", *settings.level));
    if (settings.max_pixels && *settings.max_pixels > 1.0)
        throw Error(ExitCode::usage, fmt::format("--max-pixels {:g} is above 1, all pixels", *settings.max_pixels));
}

void declare(CLI::App& app, InfoOptions& options) {
    add_scene(app, options.scene);
    app.add_flag("--memory", options.memory, "And what a render takes on the device, bytes by kind");
    for (const char* name : {"estimator", "photons", "size", "knn", "rings", "sectors", "aovs"}) {
        add_setting(app, options.settings, name, "As of a render, for --memory");
    }
    app.add_option("--device", options.device.select, "As of a render, for --memory")->type_name("NAME|INDEX|uuid:...");
    app.add_flag("--json", options.json, "Print JSON");
}

void declare(CLI::App& app, DevicesOptions& options) { app.add_flag("--json", options.json, "Print JSON"); }

void declare(CLI::App& app, DoctorOptions& options) { app.add_flag("--json", options.json, "Print JSON"); }

template <typename T> void finish(const CLI::App&, const Words&, T&) {}

/// A row of the table of commands.
struct Command {
    std::string_view name;  // its word; empty: vkcppm SCENE
    const char* about;
    Options (*read)(const Command& command, const Words& words);  // those after its name
    CommandText (*describe)(const Command& command);

    std::string full_name() const { return name.empty() ? "vkcppm" : fmt::format("vkcppm {}", name); }
};

/// The option that was most likely meant by one that there is not: of which that is the beginning, or the other way
/// round, or from which slips part it; empty where there is none.
std::string likely_option(const CLI::App& app, const std::string& word) {
    const std::string asked = word.substr(0, word.find('='));
    std::string likely;
    if (!asked.starts_with("--") || asked.size() < 5) return likely;
    std::size_t least = 3;              // slips
    constexpr std::size_t letters = 3;  // of a name for each slip
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& long_name : option->get_lnames()) {
            const std::string name = "--" + long_name;
            const bool begins = name.starts_with(asked) || asked.starts_with(name);
            const std::size_t slips = begins ? 1 : edit_distance(asked, name);
            if (slips >= least || slips * letters > long_name.size()) continue;
            least = slips;
            likely = name;
        }
    }
    return likely;
}

/// The words that have no place; the one behind which all are no options is none of them.
Words extra_words(const CLI::App& app) {
    Words extra = app.remaining();
    std::erase(extra, "--");
    return extra;
}

/// What is wrong with the words: the first that has no place is more than what CLI11 finds missing for it.
std::string what_is_wrong(const CLI::App& app, const std::string& found) {
    const Words extra = extra_words(app);
    if (!extra.empty() && extra.front().starts_with('-')) {
        const std::string likely = likely_option(app, extra.front());
        return fmt::format("there is no option {}{}", extra.front(), likely.empty() ? "" : ": is it " + likely + "?");
    }
    for (const CLI::Option* option : app.get_options()) {
        const Words results = option->count() > 0 ? option->results() : Words();
        if (!extra.empty() && option->get_positional() && !results.empty()) {
            return fmt::format("'{}' has no place: {} is '{}'", extra.front(), option->get_name(), results.front());
        }
        if (extra.empty() && results.size() > 1 && option->get_items_expected_max() == 1) {
            return fmt::format("{} is given {} times: '{}', '{}'", option->get_name(), results.size(), results[0],
                               results[1]);
        }
    }
    if (!extra.empty()) return fmt::format("'{}' has no place", extra.front());
    // CLI11 says "--size: 1 required WxH missing".
    const std::string one = ": 1 required ", missing = " missing";
    const std::size_t at = found.find(one);
    if (at == std::string::npos || !found.ends_with(missing)) return found;
    const std::size_t value = at + one.size();
    return fmt::format("{} needs {}", found.substr(0, at), found.substr(value, found.size() - missing.size() - value));
}

template <typename T> Options read(const Command& command, const Words& words) {
    T options;
    CLI::App app(command.about, command.full_name());
    declare(app, options);
    app.allow_extras();
    std::string wrong;
    try {
        app.parse(Words(words.rbegin(), words.rend()));  // CLI11 takes them last word first
        if (!extra_words(app).empty()) wrong = what_is_wrong(app, "");
    } catch (const CLI::CallForHelp&) {
        return TextOptions{app.help()};
    } catch (const CLI::CallForVersion& version) {
        return TextOptions{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        wrong = what_is_wrong(app, error.what());
    }
    for (const CLI::Option* option : app.get_options()) {
        const Words results = option->count() > 0 && wrong.empty() ? option->results() : Words();
        if (std::ranges::find(results, "") != results.end()) wrong = option->get_name() + " is empty";
    }
    if (!wrong.empty()) throw Error(ExitCode::usage, fmt::format("{} (see {} --help)", wrong, app.get_name()));
    finish(app, words, options);
    return options;
}

template <typename T> CommandText describe(const Command& command) {
    T options;
    CLI::App app(command.about, command.full_name());
    declare(app, options);
    CommandText text{std::string(command.name), command.about, app.get_footer(), {}};
    for (const CLI::Option* option : app.get_options()) {
        OptionText& told = text.options.emplace_back();
        told.positional = option->get_positional();
        if (told.positional) told.names.push_back(option->get_name());
        for (const std::string& name : option->get_snames()) told.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) told.names.push_back("--" + name);
        told.value = option->get_items_expected_max() > 0 ? option->get_type_name() : "";
        told.help = option->get_description();
        setting::for_each([&](const auto& row) {
            if (told.names.front() != fmt::format("--{}", row.name)) return;
            for (const auto& [name, summary] : choices_of(row.values)) told.choices.push_back(name);
        });
    }
    return text;
}

template <typename T> constexpr Command command(std::string_view name, const char* about) {
    return {name, about, read<T>, describe<T>};
}

/// The first is that of all words which no other begins with.
constexpr std::array commands{
    command<RenderOptions>("",
                           "Renders a glTF scene by progressive photon mapping on a Vulkan device.\n"
                           "Other commands: vkcppm race, vkcppm reference, vkcppm compare, vkcppm check, vkcppm info,\n"
                           "vkcppm plan, vkcppm render-shard, vkcppm merge, vkcppm status, vkcppm devices,\n"
                           "vkcppm doctor; each has its own --help.\n"
                           "A scene of such a name is given as ./compare."),
    command<PlanOptions>(
        "plan",
        "Begins a render that many machines share: renders the first iterations, and writes a folder by which\n"
        "vkcppm render-shard renders the others, in any number of shards, and vkcppm merge adds them up."),
    command<ShardOptions>("render-shard", "Renders a machine's share of a job, and goes on where it was ended."),
    command<MergeOptions>("merge", "Adds up what the machines of a job have rendered to its picture."),
    command<StatusOptions>("status", "Tells how far a job is."),
    command<RaceOptions>(
        "race",
        "Renders a scene by several estimators side by side and compares their errors: against iterations,\n"
        "against time, at every pixel. Open DIR/index.html in a browser."),
    command<ReferenceOptions>(
        "reference",
        "Makes a picture to measure others against, with its standard error a pixel: paths where they converge,\n"
        "photons for caustics. A scene of the name of a command is given as ./compare."),
    command<CompareOptions>("compare", "Compares a picture with its reference."),
    command<CheckOptions>(
        "check",
        "Says whether a picture is still what its reference is, for CI: by bounds, or by what noise explains."),
    command<InfoOptions>("info", "Lists what is in a scene and how it will be treated."),
    command<DevicesOptions>("devices", "Lists the Vulkan devices."),
    command<DoctorOptions>("doctor", "Tells what a render hangs on and, where something is amiss, how to mend it."),
};

}  // namespace

Options parse_options(int argc, const char* const* argv) {
    Words words(argv + std::min(argc, 1), argv + argc);
    const auto first = commands.begin();
    const auto named = words.empty() ? commands.end()
                                     : std::find_if(first + 1, commands.end(),
                                                    [&](const Command& row) { return row.name == words.front(); });
    if (named == commands.end()) return first->read(*first, words);
    words.erase(words.begin());
    return named->read(*named, words);
}

PlanOptions parse_plan(const std::vector<std::string>& words) {
    std::vector<const char*> argv{"vkcppm", "plan"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    Options options = parse_options(int(argv.size()), argv.data());
    if (auto* plan = std::get_if<PlanOptions>(&options)) return *plan;
    throw Error(ExitCode::usage, "the words of the job are no plan");
}

std::vector<CommandText> command_texts() {
    std::vector<CommandText> texts;
    for (const Command& command : commands) texts.push_back(command.describe(command));
    return texts;
}

}  // namespace vkcppm
