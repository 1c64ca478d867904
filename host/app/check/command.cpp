#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "app/check/page.h"
#include "app/check/verdict.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/display.h"
#include "app/outputs.h"
#include "app/provenance.h"
#include "core/blocks.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "study/check.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// The number of batches that the errors of a picture come from: what its file says, else the least.
std::uint32_t batches_of(const fs::path& file) {
    std::uint32_t batches = least_error_batches;
    for (const auto& [name, value] : read_exr_attributes(file)) {
        if (name == "vkcppm.batches") std::from_chars(value.data(), value.data() + value.size(), batches);
    }
    return std::max(batches, 2u);
}

NoisyPicture read_picture(const fs::path& file) {
    NoisyPicture picture;
    picture.mean = read_exr(file);
    const ExrChannels errors = read_exr_channels(file, "StdErr");
    const auto pixels = errors.values.find("StdErr");
    if (pixels == errors.values.end()) return picture;
    picture.standard_error = pixels->second;
    picture.batches = batches_of(file);
    for (const std::uint32_t side : block_sides(picture.mean.extent)) {
        const auto channel = errors.values.find(fmt::format("StdErr.{}", side));
        if (channel == errors.values.end()) continue;
        std::vector<float>& blocks = picture.block_error[side];
        blocks.resize(blocks_of(picture.mean.extent, side).pixels());
        for (std::size_t i = 0; i < channel->second.size(); ++i) {
            blocks[block_at(picture.mean.extent, side, i)] = channel->second[i];
        }
    }
    return picture;
}

/// Throws Error(bad_input) where a pixel whose colour is a number has a standard error that is none of 0 or more.
void require_errors(const fs::path& file, const NoisyPicture& picture) {
    for (std::size_t i = 0; i < picture.standard_error.size(); ++i) {
        const float error = picture.standard_error[i];
        if ((std::isfinite(error) && error >= 0.0f) || !is_finite(picture.mean.rgb[i])) continue;
        const std::uint32_t width = picture.mean.extent.width;
        throw Error(ExitCode::bad_input,
                    fmt::format("{}: StdErr is {} in column {}, row {}; it is a number of 0 or more", file.string(),
                                error, i % width, i / width));
    }
}

/// The settings, with the usual level where there are no bounds. Throws Error where noise is to explain the difference
/// and a picture does not know its own: usage without errors, bad_input where they are none.
CheckSettings resolve(const CheckOptions& options, const NoisyPicture& image, const NoisyPicture& reference) {
    CheckSettings settings = options.settings;
    if (!settings.level && settings.bounds.empty() && !settings.max_pixels) settings.level = usual_level;
    for (const auto& [file, picture] : {std::pair(&options.image, &image), std::pair(&options.reference, &reference)}) {
        if (!settings.level) continue;
        if (picture->standard_error.empty()) {
            throw Error(ExitCode::usage,
                        fmt::format("{} has no channel StdErr, which vkcppm reference and --error write, so nothing "
                                    "tells noise from a difference: give bounds, such as --max relmse=0.001, --max "
                                    "flip=0.02 or --max-pixels 0.1%",
                                    file->string()));
        }
        require_errors(*file, *picture);
    }
    return settings;
}

/// The bytes of a file. Throws Error(no_input).
std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream) throw Error(ExitCode::no_input, fmt::format("cannot read {}", file.string()));
    return bytes;
}

/// Puts the image, if it is one, in the place of the reference.
void update(const CheckOptions& options) {
    check_outputs({options.image}, {{"REFERENCE", options.reference, ".exr"}}, false);
    const Image image = read_exr(options.image);
    const std::string bytes = bytes_of(options.image);
    std::string change;
    std::error_code ignored;
    if (fs::exists(options.reference, ignored)) {
        try {
            const PictureMeasures measures = measure(image, read_exr(options.reference));
            change = fmt::format(": relmse {:.4g}, flip {:.4g} from what it was", measures.comparison.relmse.all,
                                 measures.flip.mean);
        } catch (const Error& error) {  // no picture, or of another size: all the more reason to replace it
            change = fmt::format(", which it could not be compared with: {}", error.what());
        }
    }
    write_file(options.reference, bytes);
    print_result(fmt::format("{} is now {}{}\n", options.reference.string(), options.image.string(), change));
}

}  // namespace

ExitCode execute(const CheckOptions& options) {
    if (options.update) {
        update(options);
        return ExitCode::ok;
    }
    if (options.report) make_folder(*options.report);
    const auto within = [&](const char* name) {
        return options.report ? std::optional(*options.report / name) : std::nullopt;
    };
    const std::optional<fs::path> page = within("index.html"), verdict = within("check.json");
    // Its line goes to standard output.
    check_outputs({options.image, options.reference},
                  {{"--junit", options.junit, ".xml"}, {"--report", page, ".html"}, {"--report", verdict, ".json"}},
                  true);
    const NoisyPicture image = read_picture(options.image), reference = read_picture(options.reference);
    const Extent extent = image.mean.extent;
    const Check result = check(image, reference, resolve(options, image, reference));
    if (result.masked > 0) {
        print_message(fmt::format("warning: {} of {} pixels are NaN or infinite in both pictures; they are left out",
                                  result.masked, extent.pixels()));
    }
    const nlohmann::ordered_json json = check_json(options, result, extent);
    if (options.junit) write_file(*options.junit, junit_xml(options, result));
    if (options.report) {
        const Display display = display_of(options.display, reference.mean, options.reference.string(), false);
        write_file(*verdict, json_text(json, 2) + "\n");
        write_file(*page, check_page(json, result, image.mean, reference.mean, display));
    }
    print_result((options.json ? json_text(json, 2) : verdict_line(result)) + "\n");
    return result.passes() ? ExitCode::ok : ExitCode::differs;
}

}  // namespace vkcppm
