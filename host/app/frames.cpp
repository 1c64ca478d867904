#include "app/frames.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "app/provenance.h"
#include "core/error.h"
#include "io/exr.h"

namespace vkcppm {

namespace fs = std::filesystem;

fs::path frame_file(const char* option, const fs::path& pattern, std::uint32_t frame) {
    static const std::regex place("%(0[1-9])?d");
    const std::string name = pattern.filename().string();
    std::smatch found;
    if (!std::regex_search(name, found, place) || std::ranges::count(name, '%') != 1) {
        throw Error(ExitCode::usage, fmt::format("{}: {} has no place for the number of a frame, such as out_%04d.exr",
                                                 option, pattern.string()));
    }
    const std::size_t width = found[1].matched ? std::size_t(found[1].str()[1] - '0') : 0;
    return pattern.parent_path() / (found.prefix().str() + fmt::format("{:0{}}", frame, width) + found.suffix().str());
}

RenderOptions frame_of(const RenderOptions& options, std::uint32_t frame) {
    RenderOptions one = options;
    one.scene.at = double(frame) / options.fps;
    one.output = frame_file("-o", options.output, frame);
    if (options.png) one.png = frame_file("--png", *options.png, frame);
    if (options.stats) one.stats = frame_file("--stats", *options.stats, frame);
    return one;
}

bool is_rendered(const RenderOptions& frame, const Scene& scene, const Settings& settings, const DeviceInfo& device) {
    for (const auto& file : {frame.png, frame.stats}) {
        if (file && !fs::exists(*file)) return false;
    }
    if (!fs::exists(frame.output)) return false;
    ExrAttributes found;
    try {
        if (read_exr(frame.output).extent != *settings.size) return false;
        found = read_exr_attributes(frame.output);
    } catch (const Error&) {  // no picture: it is rendered over
        return false;
    }
    Report report;
    report.device = device.name;
    report.driver = device.driver;
    nlohmann::ordered_json wanted = settings_json(settings);
    if (!settings.seconds) wanted["iterations_done"] = settings.iterations;
    const auto is_found = [&](const auto& attribute) { return std::ranges::find(found, attribute) != found.end(); };
    return std::ranges::all_of(attributes_of(std::move(wanted), frame.scene, scene, report), is_found);
}

}  // namespace vkcppm
