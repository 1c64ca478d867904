#include "app/race/data.h"

#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "app/measures.h"
#include "app/page/html.h"
#include "app/provenance.h"
#include "app/version.h"
#include "core/display.h"
#include "study/seeds.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr double drawn_spacing = 0.01;  // decades between drawn points: a hair's breadth, however long the curve

Json json_of(const Estimate& estimate) {
    Json json{{"mean", estimate.mean}, {"low", nullptr}, {"high", nullptr}};
    if (estimate.interval) {
        json["low"] = estimate.interval->low;
        json["high"] = estimate.interval->high;
    }
    return json;
}

Json json_of(const std::optional<Estimate>& estimate) { return estimate ? json_of(*estimate) : Json(); }

/// Points that are too near to the one before to be seen are left out, never the last.
Json json_of(const Band& band) {
    Json json{{"slope", json_of(band.slope)}, {"points", Json::array()}};
    std::optional<double> last;
    for (std::size_t i = 0; i < band.x.size(); ++i) {
        const double place = std::log10(band.x[i]);
        if (last && place - *last < drawn_spacing && i + 1 < band.x.size()) continue;
        last = place;
        Json point{{"x", band.x[i]}};
        point.update(json_of(band.error[i]));
        json["points"].push_back(std::move(point));
    }
    return json;
}

Json json_of(const EqualError& equal) {
    return {{"reached", equal.reached}, {"at", json_of(equal.at)}, {"speedup", json_of(equal.speedup)}};
}

/// Everything about one metric of one entrant.
Json metric_json(const RaceRun& run, const RaceRun& baseline, const Metric& metric) {
    const auto equal = [&](Axis axis) {
        return json_of(&run == &baseline ? equal_error(run.curves, axis)
                                         : equal_error(run.curves, baseline.curves, metric, axis));
    };
    return {{"final", json_of(final_error(run.curves, metric))},
            {"against_iterations", json_of(band(run.curves, metric, Axis::iterations))},
            {"against_seconds", json_of(band(run.curves, metric, Axis::seconds))},
            {"equal_iterations", equal(Axis::iterations)},
            {"equal_seconds", equal(Axis::seconds)}};
}

Json run_json(const Curve& curve, const Report& report, std::uint32_t seed) {
    Json json{{"seed", seed},
              {"iterations", curve.back().iterations},
              {"seconds", curve.back().seconds},
              {"emitted_paths", report.emitted_paths},
              {"stored_photons", report.stored_photons},
              {"rays", report.rays},
              {"pass_seconds", Json::object()},
              {"curve", curve_json(curve)}};
    for (const PassReport& pass : report.passes) json["pass_seconds"][pass.name] = pass.device_seconds;
    return json;
}

/// Seconds to the error at which entrants end, the mean over seeds; null where one has not come to it.
Json seconds_to(const StopAt& stop_at, const std::vector<Curve>& curves) {
    double sum = 0.0;
    for (const Curve& curve : curves) {
        if (!reached(stop_at, curve)) return {};
        sum += curve.back().seconds;
    }
    return sum / double(curves.size());
}

std::string colour_text(const glm::u8vec3& colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b);
}

}  // namespace

std::string file_stem(const Entrant& entrant) {
    std::string stem = entrant.name;
    for (char& c : stem) {
        if (c == ':' || c == '=') c = '-';
    }
    return stem;
}

std::string view_file(const Entrant& entrant, const std::string& view) {
    return file_stem(entrant) + (view == "picture" ? "" : "-" + view) + ".png";
}

Json race_json(const RaceOptions& options, const RaceInput& input, const RaceResult& result,
               const RacePictures& pictures) {
    const RaceRun& first = result.runs.front();
    const RaceRun& baseline = result.runs[result.baseline];
    Json json;
    json["version"] = version();
    json["command"] = options.command;
    json["scene"] = scene_json(options.scene, input.scene);
    json["device"] = first.reports.front().device;
    json["driver"] = first.reports.front().driver;
    json["reference"] = {{"file", input.reference.string()}, {"attributes", Json::object()}};
    for (const auto& [name, value] : input.reference_attributes) json["reference"]["attributes"][name] = value;
    json["reference_made"] = options.make_reference.has_value();
    json["width"] = first.image.extent.width;
    json["height"] = first.image.extent.height;
    json["exposure"] = pictures.display.exposure;
    json["tone_map"] = name_of(pictures.display.tone_map);
    const Settings& settings = first.entrant.settings;
    json["seconds"] = settings.seconds ? Json(*settings.seconds) : Json();
    json["iterations"] = settings.iterations == unbounded_iterations ? Json() : Json(settings.iterations);
    if (options.race.stop_at) json["stop_at"] = stop_at_json(*options.race.stop_at);
    json["seeds"] = result.seeds;
    json["interrupted"] = result.interrupted;
    json["baseline"] = baseline.entrant.name;
    json["confidence"] = confidence;
    json["difference_scale"] = scale_json(pictures.difference);
    json["radius_scale"] = scale_json(pictures.radius);
    json["winner_reach"] = winner_reach;
    json["parameters"] = Json::array();
    setting::for_each([&](const auto& row) {
        if (setting::is_of_entrant(row.kind)) json["parameters"].push_back(json_name(row.name));
    });
    json["metric"] = default_metric().name;
    json["metrics"] = Json::array();
    for (const Metric& metric : metrics()) {
        json["metrics"].push_back({{"name", metric.name}, {"title", metric.title}});
    }
    json["entrants"] = Json::array();
    for (std::size_t e = 0; e < result.runs.size(); ++e) {
        const RaceRun& run = result.runs[e];
        Json entrant{{"name", run.entrant.name},
                     {"files", file_stem(run.entrant)},
                     {"colour", colour_text(entrant_colour(e))},
                     {"pixels_won", pictures.winner.shares[e]},
                     {"pixels_won_around", pictures.winner_around.shares[e]},
                     {"settings", settings_json(run.entrant.settings)},
                     {"metrics", Json::object()},
                     {"runs", Json::array()}};
        if (options.race.stop_at) entrant["seconds_to_stop"] = seconds_to(*options.race.stop_at, run.curves);
        for (const Metric& metric : metrics()) {
            entrant["metrics"][std::string(metric.name)] = metric_json(run, baseline, metric);
        }
        for (std::size_t s = 0; s < result.seeds.size(); ++s) {
            entrant["runs"].push_back(run_json(run.curves[s], run.reports[s], result.seeds[s]));
        }
        json["entrants"].push_back(std::move(entrant));
    }
    return json;
}

std::string curves_csv(const RaceResult& result) {
    std::string csv = "entrant,seed,iterations,seconds";
    const auto out = std::back_inserter(csv);
    for (const Metric& metric : metrics()) fmt::format_to(out, ",{}", metric.name);
    csv += '\n';
    for (const RaceRun& run : result.runs) {
        for (std::size_t s = 0; s < result.seeds.size(); ++s) {
            for (const CurvePoint& point : run.curves[s]) {
                fmt::format_to(out, "{},{},{},{}", run.entrant.name, result.seeds[s], point.iterations, point.seconds);
                for (const Metric& metric : metrics()) fmt::format_to(out, ",{}", metric.of(point.error));
                csv += '\n';
            }
        }
    }
    return csv;
}

}  // namespace vkcppm
