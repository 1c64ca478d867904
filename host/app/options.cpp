#include "app/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "render/estimators.h"

namespace vkcppm {
namespace {

using Words = std::vector<std::string>;

constexpr double race_seconds = 60.0;        // of each entrant with each seed, where nothing else bounds them
constexpr std::uint32_t most_seeds = 10000;  // of a race: more is taken for a slip

constexpr const char* footer = R"(Exit codes:
  0 done   2 usage   65 bad scene   66 no such file   69 no usable Vulkan device   70 internal
  71 out of device memory   73 cannot write   75 device lost)";

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& wanted) {
    throw Error(ExitCode::usage, fmt::format("{}: '{}' is not {}", option, text, wanted));
}

/// Reads the number at the start of `text` and removes it; false where there is none or it does not fit.
template <typename Number> bool take_number(std::string_view& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(std::size_t(end - text.data()));
    return true;
}

std::uint32_t parse_whole(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    std::uint32_t number = 0;
    if (!take_number(rest, number) || !rest.empty()) {
        refuse(option, text, fmt::format("a whole number from 0 to {}", std::numeric_limits<std::uint32_t>::max()));
    }
    return number;
}

double parse_real(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    double number = 0.0;
    if (!take_number(rest, number) || !rest.empty() || !std::isfinite(number)) refuse(option, text, "a finite number");
    return number;
}

std::string parse_name(const std::string& option, const std::string& text) {
    if (text.empty()) {
        refuse(option, text, "a name");  // an unset variable of a shell must not mean the default
    }
    return text;
}

double parse_exposure(const std::string& option, const std::string& text) {
    constexpr double most = 128.0;  // stops: any float becomes white or black
    const double stops = parse_real(option, text);
    if (std::abs(stops) > most) {
        refuse(option, text, fmt::format("a number from {} to {}", -most, most));
    }
    return stops;
}

Extent parse_size(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    Extent size;
    const bool width = take_number(rest, size.width) && rest.starts_with('x');
    if (width) rest.remove_prefix(1);
    if (!width || !take_number(rest, size.height) || !rest.empty()) {
        refuse(option, text, "WIDTHxHEIGHT in pixels, such as 512x384");
    }
    return size;
}

ThinGlass parse_thin_glass(const std::string& option, const std::string& text) {
    if (text != "thin" && text != "solid") refuse(option, text, "thin or solid");
    return text == "solid" ? ThinGlass::solid : ThinGlass::thin;
}

/// Seconds of a duration such as 90, 90s, 2m, 1.5h or 500ms.
double parse_seconds(const std::string& option, const std::string& text) {
    std::string_view unit = text;
    double number = 0.0;
    if (take_number(unit, number)) {
        const double scale = unit.empty() || unit == "s" ? 1.0
                             : unit == "ms"              ? 1e-3
                             : unit == "m"               ? 60.0
                             : unit == "h"               ? 3600.0
                                                         : 0.0;
        const double seconds = number * scale;
        if (std::isfinite(seconds) && seconds > 0.0) return seconds;
    }
    refuse(option, text, "a time greater than 0, such as 90, 90s, 2m, 1.5h or 500ms");
}

StopAt parse_stop_at(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) refuse(option, text, "METRIC=VALUE, such as relmse_trimmed=0.0035");
    StopAt result{&find_metric(option, text.substr(0, equals))};
    std::string_view rest = std::string_view(text).substr(equals + 1);
    if (!take_number(rest, result.value) || !rest.empty() || !std::isfinite(result.value) || !(result.value > 0.0)) {
        refuse(option, text, "a metric and a finite number greater than 0");
    }
    return result;
}

/// Adds an option whose value `parse` turns into `target`.
template <typename Target, typename Value>
CLI::Option* add(CLI::App& app, const std::string& name, const char* type, Target& target,
                 Value (*parse)(const std::string& option, const std::string& text), const std::string& help) {
    return app
        .add_option_function<std::string>(
            name, [&target, name, parse](const std::string& text) { target = parse(name, text); }, help)
        ->type_name(type);
}

/// Runs `app` over the words; false where they asked for help or the version, which `text` then holds.
bool parse(CLI::App& app, const Words& words, std::string& text) {
    try {
        app.parse(Words(words.rbegin(), words.rend()));  // CLI11 takes them last word first
        return true;
    } catch (const CLI::CallForHelp&) {
        text = app.help();
    } catch (const CLI::CallForVersion& version) {
        text = std::string(version.what()) + "\n";
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, fmt::format("{} (see {} --help)", error.what(), app.get_name()));
    }
    return false;
}

void add_scene(CLI::App& app, SceneOptions& scene) {
    app.add_option("SCENE", scene.file, "glTF 2.0 file, .gltf or .glb")->required()->type_name("");
    app.add_option("--environment", scene.environment,
                   "Light from outside: a picture of all directions, EXR or Radiance")
        ->type_name("FILE.exr|.hdr");
    add(app, "--thin-glass", "thin|solid", scene.thin_glass, parse_thin_glass,
        "Glass without a volume thickness: thin-walled, or solid where its mesh is closed (default: thin)");
}

std::string estimator_help() {
    std::string help = "How photons become radiance:";
    for (const EstimatorRow& row : estimators()) {
        help += fmt::format("\n{}: {}", row.name, row.summary);
    }
    return help;
}

/// What every way of making a picture takes, whatever the estimator: photons, film, camera, seed, depth.
void add_common(CLI::App& app, Settings& settings) {
    const Settings standard;
    add(app, "--photons", "N", settings.photons, parse_whole,
        fmt::format("Light paths emitted an iteration (default: {})", standard.photons));
    add(app, "--size", "WxH", settings.size, parse_size,
        "Pixels (default: 512 on the longer side, in the camera's aspect)");
    add(app, "--camera", "NAME|INDEX", settings.camera, parse_name, "Camera by name or index (default: the first)");
    add(app, "--aperture", "METRES", settings.aperture, parse_real,
        "Diameter of the lens; what is not at --focus-distance is blurred (default: 0, all is sharp)");
    add(app, "--focus-distance", "METRES", settings.focus_distance, parse_real,
        "From the camera along its axis to what is sharp; goes with --aperture");
    add(app, "--seed", "N", settings.seed, parse_whole,
        fmt::format("Same seed, same picture (default: {})", standard.seed));
    add(app, "--max-depth", "N", settings.max_depth, parse_whole,
        fmt::format("Bounces of a path (default: {})", standard.max_depth));
}

/// The parameters of the estimators.
void add_parameters(CLI::App& app, Settings& settings) {
    const Settings standard;
    add(app, "--knn", "N", settings.knn, parse_whole,
        fmt::format("The starting radius reaches this many photons (default: {})", standard.knn));
    add(app, "--alpha", "X", settings.alpha, parse_real,
        fmt::format("sppm, sppm-kz: how slowly the radius shrinks (default: {:.3g})", standard.alpha));
    add(app, "--k", "X", settings.k, parse_real,
        fmt::format("cppm, ftest: factor of the area after a rejection (default: {})", standard.k));
    add(app, "--beta", "X", settings.beta, parse_real,
        fmt::format("cppm, ftest: growth of the batch after a rejection (default: {})", standard.beta));
    add(app, "--significance", "X", settings.significance, parse_real,
        fmt::format("cppm, ftest: level of each test (default: {})", standard.significance));
    add(app, "--rings", "N", settings.rings, parse_whole,
        fmt::format("cppm, ftest: rings of the disc (default: {})", standard.rings));
    add(app, "--sectors", "N", settings.sectors, parse_whole,
        fmt::format("cppm, ftest: sectors of the disc: 4, 6, 8 or 12 (default: {})", standard.sectors));
}

void add_device(CLI::App& app, Device::Options& device) {
    add(app, "--device", "NAME|INDEX|uuid:...", device.select, parse_name,
        "Vulkan device; vkcppm devices lists them (default: the fastest)");
    app.add_flag("--validate", device.validate, "Load the validation layer; its messages make the exit code 70");
    app.add_flag_callback(
        "--no-cache", [&device] { device.cache = false; },
        "Neither read nor write compiled kernels in $XDG_CACHE_HOME/vkcppm");
}

Options parse_render(const Words& words) {
    const Settings standard;
    RenderOptions options;
    std::optional<std::filesystem::path> output;
    std::optional<std::uint32_t> iterations;
    std::string text;

    CLI::App app(
        "Renders a glTF scene by progressive photon mapping on a Vulkan device.\n"
        "Other commands: vkcppm race, vkcppm reference, vkcppm compare, vkcppm info, vkcppm devices; each has its\n"
        "own --help.\n"
        "A scene of such a name is given as ./compare.",
        "vkcppm");
    app.footer(footer);
    app.set_version_flag("--version", "vkcppm " VKCPPM_VERSION);
    add_scene(app, options.scene);
    app.add_option("-o", output, "The picture, linear float EXR (default: the scene's name with .exr, here)")
        ->type_name("OUT.exr");
    app.add_option("--png", options.png, "The picture for the eye, 8-bit sRGB as well")->type_name("FILE.png");
    add(app, "--exposure", "EV", options.exposure, parse_exposure, "Stops by which the PNG is brightened (default: 0)")
        ->needs("--png");
    app.add_option("--estimator", options.settings.estimator,
                   estimator_help() + fmt::format("\n(default: {})", standard.estimator))
        ->type_name("NAME");
    add(app, "--iterations", "N", iterations, parse_whole,
        fmt::format("Iterations (default: {}; unbounded with --time)", standard.iterations));
    add(app, "--time", "TIME", options.settings.seconds, parse_seconds,
        "Stop after the iteration in which this time has passed: 90, 90s, 2m, 1.5h, 500ms");
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
    add_common(app, options.settings);
    add_parameters(app, options.settings);
    app.add_flag("--aovs", options.settings.aovs,
                 "Add channels to the EXR: ppm.radius, ppm.photons, ppm.batch, ppm.rejections, ppm.statistic,\n"
                 "ppm.iterations, and Z, Albedo, N of the first surfaces");
    add_device(app, options.device);
    app.add_option("--stats", options.stats, "Times and counts of the render")->type_name("FILE.json");
    app.add_flag(
        "--hash", options.hash,
        "Print a hash of what each pass of each iteration wrote, and of the picture, to find where two renders\n"
        "part; slower");
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
    app.add_flag("--verbose", options.verbose, "Times of the passes at the end");

    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    options.output = output ? *output : std::filesystem::path(options.scene.file.stem().string() + ".exr");
    if (!options.checkpoint) options.checkpoint = options.resume;
    if (!options.checkpoint && app.count("--checkpoint-every") > 0) {
        throw Error(ExitCode::usage, "--checkpoint-every needs --checkpoint or --resume");
    }
    if (iterations) {
        options.settings.iterations = *iterations;
    } else if (options.settings.seconds) {
        options.settings.iterations = unbounded_iterations;
    }
    return options;
}

/// NAME or NAME:PARAMETER=VALUE:..., the parameters of add_parameters; the rest as in `common`.
Entrant parse_entrant(const std::string& text, const Settings& common) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
    Entrant entrant{text, common};
    entrant.settings.estimator = find_estimator(parts.empty() ? "" : parts.front()).name;
    CLI::App app("", "--estimators");
    add_parameters(app, entrant.settings);
    app.set_help_flag();
    Words names, words;
    for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name().substr(2));
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        const std::string name = parts[i].substr(0, equals);
        if (equals == std::string::npos || std::ranges::find(names, name) == names.end()) {
            refuse(
                "--estimators", text,
                fmt::format("NAME:PARAMETER=VALUE:... with parameters of {}: '{}'", fmt::join(names, ", "), parts[i]));
        }
        words.insert(words.end(), {"--" + name, parts[i].substr(equals + 1)});
    }
    try {
        app.parse(Words(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, fmt::format("--estimators: '{}': {}", text, error.what()));
    }
    return entrant;
}

/// A word as a shell takes it.
std::string quoted(const std::string& word) {
    const char* plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

Options parse_race(const Words& words) {
    RaceOptions options;
    Settings settings;
    std::string estimators = "cppm,sppm,appm";
    std::optional<std::uint32_t> iterations;
    std::string text;

    CLI::App app(
        "Renders a scene by several estimators side by side and compares their errors: against iterations,\n"
        "against time, at every pixel. Open DIR/index.html in a browser.",
        "vkcppm race");
    app.footer(footer);
    add_scene(app, options.scene);
    app.add_option("-o", options.folder, "Folder for the page, curves and pictures; made where there is none")
        ->required()
        ->type_name("DIR");
    app.add_option("--estimators", estimators,
                   fmt::format("Who takes part, parameters behind a colon: cppm,cppm:beta=1.5:k=0.7,sppm\n"
                               "(default: {}). The same seed means the same photon paths for all, and the same\n"
                               "starting radii unless they differ in knn",
                               estimators))
        ->type_name("NAME[:PARAMETER=VALUE]...,...");
    add(app, "--time", "TIME", settings.seconds, parse_seconds,
        fmt::format("What each gets for each seed, on a clock that runs during its passes alone (default: {:g}s)",
                    race_seconds));
    add(app, "--iterations", "N", iterations, parse_whole,
        "What each gets for each seed; with --time, what comes first");
    add(app, "--seeds", "N", options.race.seeds, parse_whole,
        "Repeat with so many seeds, from --seed on: two or more give confidence intervals (default: 1)");
    app.add_option("--reference", options.reference,
                   "What errors are measured against; without --size it tells the size\n"
                   "(default: references/NAME.exr beside the scene)")
        ->type_name("REF.exr");
    add(app, "--make-reference", "TIME", options.make_reference, parse_seconds,
        "Make it first, in this time, as vkcppm reference does, with a seed that does not race: DIR/reference.exr")
        ->excludes("--reference");
    add(app, "--exposure", "EV", options.exposure, parse_exposure,
        "Stops by which pictures are brightened (default: 0)");
    add_common(app, settings);
    add_parameters(app, settings);
    add_device(app, options.device);
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    if (options.race.seeds == 0 || options.race.seeds > most_seeds) {
        refuse("--seeds", std::to_string(options.race.seeds), fmt::format("a number from 1 to {}", most_seeds));
    }
    if (!iterations && !settings.seconds) settings.seconds = race_seconds;
    settings.iterations = iterations.value_or(unbounded_iterations);
    std::istringstream stream(estimators + ",");
    for (std::string entrant; std::getline(stream, entrant, ',');) {
        options.race.entrants.push_back(parse_entrant(entrant, settings));
    }
    options.command = "vkcppm race";
    for (const std::string& word : words) options.command += " " + quoted(word);
    return options;
}

Options parse_reference(const Words& words) {
    ReferenceOptions options;
    ReferenceSettings& settings = options.settings;
    std::optional<std::uint32_t> samples, iterations;
    std::string text;
    CLI::App app(
        "Makes a picture to measure others against, with its standard error a pixel: paths where they converge,\n"
        "photons for caustics. A scene of the name of a command is given as ./compare.",
        "vkcppm reference");
    add_scene(app, options.scene);
    app.add_option("-o", options.output, "The picture: linear EXR of R G B, StdErr and Trust")
        ->type_name("REF.exr")
        ->required();
    app.add_flag("--half", options.half, "16-bit floats: a small file");
    add(app, "--time", "TIME", settings.render.seconds, parse_seconds,
        "Stop when this time has passed: 90, 90s, 2m, 1.5h, 500ms");
    add(app, "--samples", "N", samples, parse_whole,
        fmt::format("Paths a pixel, at most (default: {}; unbounded with --time)", settings.samples));
    add(app, "--iterations", "N", iterations, parse_whole,
        fmt::format("Iterations of caustics, at most (default: {}; unbounded with --time)",
                    settings.render.iterations));
    add(app, "--trust", "X", settings.trust, parse_real,
        fmt::format("Largest relative standard error of a pixel that is trusted (default: {})", settings.trust));
    add_common(app, settings.render);
    add_device(app, options.device);
    app.add_option("--stats", options.stats, "Times and counts")->type_name("FILE.json");
    app.add_flag("--quiet", options.quiet, "No progress, only the summary");
    app.add_flag("--json", options.json, "Print the summary as JSON");
    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    const bool timed = settings.render.seconds.has_value();
    settings.samples = samples.value_or(timed ? unbounded_samples : settings.samples);
    settings.render.iterations = iterations.value_or(timed ? unbounded_iterations : settings.render.iterations);
    return options;
}

Options parse_compare(const Words& words) {
    CompareOptions options;
    std::string text;
    CLI::App app("Compares a picture with its reference.", "vkcppm compare");
    app.add_option("IMAGE", options.image, "EXR file")->required()->type_name("");
    app.add_option("REFERENCE", options.reference, "EXR file of the same size")->required()->type_name("");
    app.add_flag("--json", options.json, "Print JSON");
    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    return options;
}

Options parse_info(const Words& words) {
    InfoOptions options;
    std::string text;
    CLI::App app("Lists what is in a scene and how it will be treated.", "vkcppm info");
    add_scene(app, options.scene);
    app.add_flag("--json", options.json, "Print JSON");
    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    return options;
}

Options parse_devices(const Words& words) {
    DevicesOptions options;
    std::string text;
    CLI::App app("Lists the Vulkan devices.", "vkcppm devices");
    app.add_flag("--json", options.json, "Print JSON");
    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    return options;
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
    const Words words(argv + std::min(argc, 1), argv + argc);
    const std::string command = words.empty() ? "" : words.front();
    const auto arguments = [&] { return Words(words.begin() + 1, words.end()); };
    if (command == "race") return parse_race(arguments());
    if (command == "reference") return parse_reference(arguments());
    if (command == "compare") return parse_compare(arguments());
    if (command == "info") return parse_info(arguments());
    if (command == "devices") return parse_devices(arguments());
    return parse_render(words);
}

}  // namespace vkcppm
