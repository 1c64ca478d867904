#include "app/provenance.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/measures.h"
#include "app/version.h"
#include "core/fnv1a.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(ThinGlass thin_glass) { return thin_glass == ThinGlass::solid ? "solid" : "thin"; }

Json json_of_setting(const auto& value) { return value; }
Json json_of_setting(const Extent& size) { return fmt::format("{}x{}", size.width, size.height); }

/// What of the scene was asked for beside its files, where that is not what is usual.
Json chosen(const SceneOptions& options) {
    Json json = Json::object();
    if (!options.animation.empty()) {
        json["animation"] = options.animation;
        json["at"] = options.at;
    }
    if (!options.variant.empty()) json["variant"] = options.variant;
    for (const MaterialChange& change : options.set) json["set"].push_back(change.text());
    if (options.punctual_units != PunctualUnits::by_generator) json["punctual_units"] = name_of(options.punctual_units);
    if (options.environment_rotation != 0.0) json["environment_rotation"] = options.environment_rotation;
    if (options.environment_strength != 1.0) json["environment_strength"] = options.environment_strength;
    return json;
}

}  // namespace

std::string json_text(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string json_name(std::string_view option) {
    std::string name(option);
    std::ranges::replace(name, '-', '_');
    return name;
}

Json settings_json(const Settings& settings, const std::function<bool(setting::Kind)>& wanted) {
    Json json;
    setting::for_each([&](const auto& row) {
        const auto* value = setting::given(settings.*row.member);
        if (value && wanted(row.kind)) json[json_name(row.name)] = json_of_setting(*value);
    });
    return json;
}

Json scene_json(const SceneOptions& options, const Scene& scene) {
    Json json{{"file", scene.file.string()},
              {"hash", hash_text(scene.hash)},
              {"triangles", scene.triangles.size()},
              {"environment", options.environment ? Json(options.environment->string()) : Json()},
              {"thin_glass", name_of(options.thin_glass)}};
    json.update(chosen(options));
    return json;
}

Json warnings_json(const Scene& scene, const std::vector<std::string>& of_the_render) {
    Json json = scene.warnings;
    for (const std::string& line : of_the_render) json.push_back(line);
    return json;
}

ExrAttributes attributes_of(Json json, const SceneOptions& options, const Scene& scene, const Report& report) {
    json["scene"] = scene.file.filename().string();
    json["scene_hash"] = hash_text(scene.hash);
    if (options.environment) json["environment"] = options.environment->filename().string();
    json["thin_glass"] = name_of(options.thin_glass);
    json.update(chosen(options));
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["version"] = version();
    ExrAttributes attributes;
    for (const auto& [name, value] : json.items()) {
        attributes.emplace_back("vkcppm." + name, value.is_string() ? value.get<std::string>() : json_text(value));
    }
    return attributes;
}

ExrAttributes exr_attributes(const SceneOptions& options, const Scene& scene, const Rendering& rendering) {
    Json json = settings_json(rendering.settings);
    json["iterations_done"] = rendering.report.iterations;
    json["emitted_photons"] = rendering.report.emitted_paths;
    if (rendering.estimate) {
        json.update(estimate_json(*rendering.estimate));
        json["batches"] = ERROR_GROUPS;  // that StdErr is the spread of
    }
    if (!commit().empty()) json["commit"] = commit();
    return attributes_of(std::move(json), options, scene, rendering.report);
}

Json estimate_json(const ErrorEstimate& estimate) {
    Json json;
    const auto add = [&](const std::string& name, const Expected& expected) {
        json["expected_" + name] = expected.value;
        json["expected_" + name + "_error"] = expected.standard_error;
    };
    const auto add_parts = [&](const std::string& name, const ExpectedRelmse& relmse) {
        add(name, relmse.error);
        json["expected_" + name + "_noise"] = relmse.noise;
        json["expected_" + name + "_bias"] = relmse.bias;
    };
    add_parts("relmse", estimate.relmse);
    add_parts("relmse_trimmed", estimate.relmse_trimmed);
    add("noise", estimate.noise);
    json["rare_light"] = estimate.rare;
    return json;
}

std::string estimate_line(const ErrorEstimate& estimate) {
    const ExpectedRelmse& relmse = estimate.relmse_trimmed;
    constexpr double confidence = 0.9;
    return fmt::format(
        "error of its own estimate: relmse_trimmed {:.3g} ({:.3g} noise, {:.3g} bias), at most {:.3g} "
        "by {:g} %; relmse {:.3g}; median noise of a pixel {:.2g} %",
        relmse.error.value, relmse.noise, relmse.bias, upper_bound(relmse.error, confidence), 100.0 * confidence,
        estimate.relmse.error.value, 100.0 * estimate.noise.value);
}

Json stop_at_json(const StopAt& stop_at) { return {{"metric", stop_at.metric->name}, {"value", stop_at.value}}; }

Json report_json(const Report& report) {
    Json json;
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["totals"] = {{"iterations", report.iterations},
                      {"emitted_paths", report.emitted_paths},
                      {"stored_photons", report.stored_photons},
                      {"rays", report.rays},
                      {"wall_seconds", report.wall_seconds},
                      {"cpu_seconds", report.cpu_seconds},
                      {"setup_seconds", report.setup_seconds},
                      {"peak_memory_bytes", report.peak_memory_bytes},
                      {"device_memory_bytes", report.device_memory_bytes}};
    if (!report.memory.empty()) json["memory"] = Json::array();
    for (const MemoryReport& row : report.memory) {
        json["memory"].push_back(
            {{"of", row.of}, {"count", row.count}, {"bytes_each", row.bytes_each()}, {"bytes", row.bytes}});
    }
    json["passes"] = Json::array();
    for (const PassReport& pass : report.passes) {
        json["passes"].push_back({{"name", pass.name}, {"calls", pass.calls}, {"device_seconds", pass.device_seconds}});
        if (!pass.form.empty()) json["passes"].back()["form"] = pass.form;
    }
    return json;
}

std::string stats_json(const RenderOptions& options, const Scene& scene, const Rendering& rendering,
                       const Display& display) {
    Json json;
    json["version"] = version();
    if (!commit().empty()) json["commit"] = commit();
    json["scene"] = scene_json(options.scene, scene);
    json["settings"] = settings_json(rendering.settings);
    json["warnings"] = warnings_json(scene, rendering.warnings);
    json.update(report_json(rendering.report));
    if (rendering.estimate) json["estimate"] = estimate_json(*rendering.estimate);
    if (options.target) {
        json["target"] = {{"measure", options.target->measure->name},
                          {"value", options.target->value},
                          {"confidence", options.target->confidence},
                          {"reached", is_met(*options.target, rendering.estimate)}};
    }
    if (options.reference) {
        json["reference"] = options.reference->string();
        if (options.stop_at) {
            json["stop_at"] = stop_at_json(*options.stop_at);
            json["stop_at"]["reached"] = reached(*options.stop_at, rendering.curve);
        }
        json["curve"] = curve_json(rendering.curve);
    }
    if (options.png) {
        json["png"] = {{"file", options.png->string()},
                       {"tone_map", name_of(display.tone_map)},
                       {"exposure", display.exposure},
                       {"clipped", clipped_share(rendering.image, display)}};
    }
    return json_text(json, 2) + "\n";
}

std::string stats_table(const Report& report) {
    double total = 0.0;
    for (const PassReport& pass : report.passes) total += pass.device_seconds;
    std::string text = fmt::format("{:<20}{:>10}{:>14}{:>8}\n", "pass", "calls", "device s", "%");
    const auto out = std::back_inserter(text);
    for (const PassReport& pass : report.passes) {
        fmt::format_to(out, "{:<20}{:>10}{:>14.4f}{:>8.1f}{}{}\n", pass.name, pass.calls, pass.device_seconds,
                       total > 0.0 ? 100.0 * pass.device_seconds / total : 0.0, pass.form.empty() ? "" : "  ",
                       pass.form);
    }
    fmt::format_to(out, "{:<20}{:>10}{:>14.4f}\n", "all", "", total);
    fmt::format_to(out, "{:<20}{:>10}{:>14}{:>8}\n", "memory of a", "count", "bytes each", "MiB");
    for (const MemoryReport& row : report.memory) {
        fmt::format_to(out, "{:<20}{:>10}{:>14.1f}{:>8.1f}\n", row.of, row.count, row.bytes_each(),
                       double(row.bytes) / 1048576.0);
    }
    fmt::format_to(out, "{} emitted paths, {} stored photons, {} rays\n", report.emitted_paths, report.stored_photons,
                   report.rays);
    fmt::format_to(out, "{:.3f} s wall, {:.3f} s CPU, {:.3f} s setup, {:.1f} MiB resident, {:.1f} MiB on the device\n",
                   report.wall_seconds, report.cpu_seconds, report.setup_seconds,
                   double(report.peak_memory_bytes) / 1048576.0, double(report.device_memory_bytes) / 1048576.0);
    fmt::format_to(out, "{}, {}", report.device, report.driver);
    return text;
}

}  // namespace vkcppm
