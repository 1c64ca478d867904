#pragma once
// What a render was, as text: enough to make its picture again, and what it took.

#include <functional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "app/options.h"
#include "core/display.h"
#include "io/exr.h"
#include "render/render.h"
#include "render/settings_rows.h"
#include "scene/scene.h"

namespace vkcppm {

/// The name of a member of settings_json: that of the command line's option, with '_' for '-'.
std::string json_name(std::string_view option);

/// The settings of the kinds that are `wanted`, by default all; those that are absent are left out.
nlohmann::ordered_json settings_json(
    const Settings& settings, const std::function<bool(setting::Kind)>& wanted = [](setting::Kind) { return true; });

/// The scene's file and hash, its triangles, and what was done to it.
nlohmann::ordered_json scene_json(const SceneOptions& options, const Scene& scene);

/// All that was warned of: about the scene, and while it was rendered.
nlohmann::ordered_json warnings_json(const Scene& scene, const std::vector<std::string>& of_the_render);

/// What a render thinks of its own error, by name: expected_<measure>, its standard error as ..._error, its parts
/// ..._noise and ..._bias; rare_light.
nlohmann::ordered_json estimate_json(const ErrorEstimate& estimate);

/// The same in a line, for people.
std::string estimate_line(const ErrorEstimate& estimate);

/// What a run did: device, driver, totals, passes [{name, calls, device_seconds}] and, of a render, memory [{of, count,
/// bytes_each, bytes}].
nlohmann::ordered_json report_json(const Report& report);

/// EXR attributes "vkcppm.*": the members of `json`, then the scene's name and hash, what was done to it, device,
/// driver and version.
ExrAttributes attributes_of(nlohmann::ordered_json json, const SceneOptions& options, const Scene& scene,
                            const Report& report);

/// JSON as text; invalid UTF-8, which a file's names may hold, is replaced. indent: -1 for a single line.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// The attributes of a rendered EXR: all settings as resolved and what was rendered. Nothing that differs between two
/// runs of one seed on one device by one build.
ExrAttributes exr_attributes(const SceneOptions& options, const Scene& scene, const Rendering& rendering);

/// The text of --stats: a JSON object with version, scene, settings and the report; with a reference also its file,
/// what the render was to stop at, and the curve, and with a PNG how it shows the picture.
std::string stats_json(const RenderOptions& options, const Scene& scene, const Rendering& rendering,
                       const Display& display);

/// As --stats and race.json have it.
nlohmann::ordered_json stop_at_json(const StopAt& stop_at);

/// The passes and totals as a table to read.
std::string stats_table(const Report& report);

}  // namespace vkcppm
