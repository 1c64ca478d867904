#include "app/reference_provenance.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/provenance.h"
#include "app/version.h"
#include "core/blocks.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

Json reference_settings_json(const ReferenceSettings& settings) {
    Json json = settings_json(settings.render, setting::is_of_reference);
    json["samples"] = settings.samples;
    json["trust"] = settings.trust;
    return json;
}

Json error_json(const Reference& reference) {
    return {{"samples_done", reference.samples},
            {"iterations_done", reference.iterations},
            {"batches", reference.batches},
            {"mse", reference.mse},
            {"srgb_mse", reference.srgb_mse},
            {"relmse", reference.relmse},
            {"relmse_paths", reference.relmse_paths},
            {"relmse_caustics", reference.relmse_caustics},
            {"caustic_share", reference.caustic_share},
            {"median_error", reference.median_error},
            {"error_99", reference.error_99},
            {"untrusted", reference.untrusted}};
}

/// To 1 part in 8: nobody knows an error better, and the noise of more digits takes room in a file.
float rounded_error(float error) {
    int exponent = 0;
    const float fraction = std::frexp(error, &exponent);
    return std::ldexp(std::round(8.0f * fraction) / 8.0f, exponent);
}

/// Root mean square over the channels, rounded.
float told_error(const glm::vec3& error) { return rounded_error(std::sqrt(glm::dot(error, error) / 3.0f)); }

}  // namespace

ExrAttributes reference_attributes(const ReferenceOptions& options, const Scene& scene, const Reference& reference) {
    Json json = reference_settings_json(reference.settings);
    json.update(error_json(reference));
    if (!commit().empty()) json["commit"] = commit();
    return attributes_of(std::move(json), options.scene, scene, reference.report);
}

ExrChannels reference_channels(const Reference& reference) {
    ExrChannels channels = to_channels(reference.mean);
    for (const glm::vec3& error : reference.standard_error.rgb) channels.values["StdErr"].push_back(told_error(error));
    for (const BlockErrors& blocks : reference.block_errors) {
        std::vector<float>& values = channels.values[fmt::format("StdErr.{}", blocks.side)];
        for (std::size_t i = 0; i < channels.extent.pixels(); ++i) {
            values.push_back(told_error(blocks.standard_error[block_at(channels.extent, blocks.side, i)]));
        }
    }
    channels.values["Trust"] = reference.trusted;
    return channels;
}

std::string reference_json(const ReferenceOptions& options, const Scene& scene, const Reference& reference,
                           bool stats) {
    Json json;
    json["version"] = version();
    json["scene"] = scene_json(options.scene, scene);
    json["settings"] = reference_settings_json(reference.settings);
    json["error"] = error_json(reference);
    json["warnings"] = warnings_json(scene, reference.warnings);
    if (stats) json.update(report_json(reference.report));
    return json_text(json, 2) + "\n";
}

std::string relmse_text(const ReferenceProgress& progress) {
    return progress.relmse > 0.0 ? fmt::format(", relMSE about {:.2g}", progress.relmse) : "";
}

std::string reference_summary(const Reference& reference) {
    const std::size_t pixels = reference.trusted.size();
    const auto share = [](double part, double whole) { return whole > 0.0 ? 100.0 * part / whole : 0.0; };
    std::string text = fmt::format("{} paths a pixel, {} iterations of caustics in {:.0f} s\n", reference.samples,
                                   reference.iterations, reference.report.wall_seconds);
    text += fmt::format("{:<40}{:.1f} %\n", "light by caustics", 100.0 * reference.caustic_share);
    text += fmt::format("{:<40}{:.3g}, {:.0f} % of it from caustics\n", "expected relMSE (eps 0.01)", reference.relmse,
                        share(reference.relmse_caustics, reference.relmse));
    text += fmt::format("{:<40}{:.2g} median, {:.2g} at 99 %\n", "relative standard error of pixels",
                        reference.median_error, reference.error_99);
    text += fmt::format("{:<40}{} of {}, around which it is above {:g}\n", "pixels not trusted", reference.untrusted,
                        pixels, reference.settings.trust);
    return text;
}

}  // namespace vkcppm
