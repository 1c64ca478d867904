#include "app/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/error.h"
#include "render/estimators.h"

namespace vkcppm {
namespace {

using Words = std::vector<std::string>;

constexpr const char* footer = R"(Exit codes:
  0 done   2 usage   65 bad scene   66 no such file   69 no usable Vulkan device   70 internal
  71 out of device memory   73 cannot write   75 device lost)";

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& wanted) {
    throw Error(ExitCode::usage, fmt::format("{}: '{}' is not {}", option, text, wanted));
}

/// Reads the number at the start of `text` and removes it; false where there is none or it does not fit.
template <typename Number> bool take_number(std::string_view& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) {
        return false;
    }
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
    if (!take_number(rest, number) || !rest.empty() || !std::isfinite(number)) {
        refuse(option, text, "a finite number");
    }
    return number;
}

Extent parse_size(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    Extent size;
    const bool width = take_number(rest, size.width) && rest.starts_with('x');
    if (width) {
        rest.remove_prefix(1);
    }
    if (!width || !take_number(rest, size.height) || !rest.empty()) {
        refuse(option, text, "WIDTHxHEIGHT in pixels, such as 512x384");
    }
    return size;
}

ThinGlass parse_thin_glass(const std::string& option, const std::string& text) {
    if (text != "thin" && text != "solid") {
        refuse(option, text, "thin or solid");
    }
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
        if (std::isfinite(seconds) && seconds > 0.0) {
            return seconds;
        }
    }
    refuse(option, text, "a time greater than 0, such as 90, 90s, 2m, 1.5h or 500ms");
}

StopAt parse_stop_at(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        refuse(option, text, "METRIC=VALUE, such as relmse_trimmed=0.0035");
    }
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
    return app.add_option_function<std::string>(
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

Options parse_render(const Words& words) {
    const Settings standard;
    RenderOptions options;
    std::optional<std::filesystem::path> output;
    std::optional<std::uint32_t> iterations;
    std::string text;

    CLI::App app("Renders a glTF scene by progressive photon mapping on a Vulkan device.\n"
                 "Other commands: vkcppm compare, vkcppm info, vkcppm devices; each has its own --help.\n"
                 "A scene of such a name is given as ./compare.",
                 "vkcppm");
    app.footer(footer);
    app.set_version_flag("--version", "vkcppm " VKCPPM_VERSION);
    add_scene(app, options.scene);
    app.add_option("-o", output, "The picture, linear float EXR (default: the scene's name with .exr, here)")
        ->type_name("OUT.exr");
    app.add_option("--png", options.png, "The picture for the eye, 8-bit sRGB as well")->type_name("FILE.png");
    add(app, "--exposure", "EV", options.exposure, parse_real, "Stops by which the PNG is brightened (default: 0)")
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
        "one of " + metric_names())
        ->needs("--reference");
    add(app, "--photons", "N", options.settings.photons, parse_whole,
        fmt::format("Light paths emitted an iteration (default: {})", standard.photons));
    add(app, "--size", "WxH", options.settings.size, parse_size,
        "Pixels (default: 512 on the longer side, in the camera's aspect)");
    app.add_option("--camera", options.settings.camera, "Camera by name or index (default: the first)")
        ->type_name("NAME|INDEX");
    add(app, "--aperture", "METRES", options.settings.aperture, parse_real,
        "Diameter of the lens; what is not at --focus-distance is blurred (default: 0, all is sharp)");
    add(app, "--focus-distance", "METRES", options.settings.focus_distance, parse_real,
        "From the camera along its axis to what is sharp; goes with --aperture");
    add(app, "--seed", "N", options.settings.seed, parse_whole,
        fmt::format("Same seed, same picture (default: {})", standard.seed));
    add(app, "--max-depth", "N", options.settings.max_depth, parse_whole,
        fmt::format("Bounces of a path (default: {})", standard.max_depth));
    add(app, "--knn", "N", options.settings.knn, parse_whole,
        fmt::format("The starting radius reaches this many photons (default: {})", standard.knn));
    add(app, "--alpha", "X", options.settings.alpha, parse_real,
        fmt::format("sppm, sppm-kz: how slowly the radius shrinks (default: {:.3g})", standard.alpha));
    add(app, "--k", "X", options.settings.k, parse_real,
        fmt::format("cppm, ftest: factor of the area after a rejection (default: {})", standard.k));
    add(app, "--beta", "X", options.settings.beta, parse_real,
        fmt::format("cppm, ftest: growth of the batch after a rejection (default: {})", standard.beta));
    add(app, "--significance", "X", options.settings.significance, parse_real,
        fmt::format("cppm, ftest: level of each test (default: {})", standard.significance));
    add(app, "--rings", "N", options.settings.rings, parse_whole,
        fmt::format("cppm, ftest: rings of the disc (default: {})", standard.rings));
    add(app, "--sectors", "N", options.settings.sectors, parse_whole,
        fmt::format("cppm, ftest: sectors of the disc: 4, 6, 8 or 12 (default: {})", standard.sectors));
    app.add_flag("--aovs", options.settings.aovs,
                 "Add channels to the EXR: ppm.radius, ppm.photons, ppm.batch, ppm.rejections, ppm.statistic,\n"
                 "ppm.iterations, and Z, Albedo, N of the first surfaces");
    app.add_option("--device", options.device.select, "Vulkan device; vkcppm devices lists them (default: the fastest)")
        ->type_name("NAME|INDEX|uuid:...");
    app.add_flag("--validate", options.device.validate,
                 "Load the validation layer; its messages make the exit code 70");
    app.add_option("--stats", options.stats, "Times and counts of the render")->type_name("FILE.json");
    app.add_flag("--quiet", options.quiet, "No progress, only warnings and errors");
    app.add_flag("--verbose", options.verbose, "Times of the passes at the end");

    if (!parse(app, words, text)) {
        return TextOptions{text};
    }
    options.output = output ? *output : std::filesystem::path(options.scene.file.stem().string() + ".exr");
    if (iterations) {
        options.settings.iterations = *iterations;
    } else if (options.settings.seconds) {
        options.settings.iterations = unbounded_iterations;
    }
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
    if (command == "compare") {
        return parse_compare(arguments());
    }
    if (command == "info") {
        return parse_info(arguments());
    }
    if (command == "devices") {
        return parse_devices(arguments());
    }
    return parse_render(words);
}

}  // namespace vkcppm
