#include "app/check/page.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "app/page/html.h"
#include "core/blocks.h"
#include "io/png.h"
#include "study/false_colour.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view page =
#include "check.html.inc"
    ;
constexpr std::string_view script =
#include "check.js.inc"
    ;

constexpr double map_quantile = 0.99;
constexpr double most_sigma = 10.0;  // of the colours of a map of sigmas

Json map_json(const std::string& title, const std::string& unit, Extent extent, std::span<const float> values,
              const ColourScale& scale) {
    return {{"title", title},
            {"unit", unit},
            {"scale", scale_json(scale)},
            {"picture", data_uri(false_colours(extent, values, scale))}};
}

/// A scale's sigmas at all pixels.
std::vector<float> at_pixels(const Scale& scale, Extent extent) {
    std::vector<float> values;
    for (std::size_t i = 0; i < extent.pixels(); ++i) values.push_back(scale.sigma[block_at(extent, scale.side, i)]);
    return values;
}

Json maps_json(const Check& check, const Image& image, const Image& reference) {
    const Extent extent = image.extent;
    const std::vector<float> difference = absolute_difference(image, reference);
    Json maps = Json::array();
    maps.push_back(map_json("Difference", "W m⁻² sr⁻¹", extent, difference,
                            {0.0, positive_quantile(difference, map_quantile), false}));
    maps.push_back(map_json("FLIP", "", extent, check.measures.flip.error, {0.0, 1.0, false}));
    if (check.significance) {
        for (const Scale& scale : check.significance->scales) {
            if (scale.sigma.size() == 1) continue;  // the whole picture is one colour
            const std::string title = scale.side == 1 ? "Sigma" : fmt::format("Sigma of {0}×{0}", scale.side);
            maps.push_back(map_json(title, "sigma", extent, at_pixels(scale, extent), {0.0, most_sigma, false}));
        }
    }
    return maps;
}

}  // namespace

std::string check_page(const Json& json, const Check& check, const Image& image, const Image& reference,
                       const Display& display) {
    const Json pictures{{"image", data_uri(to_bitmap(image, display))},
                        {"reference", data_uri(to_bitmap(reference, display))},
                        {"ramp", data_uri(colour_ramp())},
                        {"maps", maps_json(check, image, reference)}};
    Json told = json;
    told["titles"] = Json::array();
    for (const NamedMeasure& measure : named(check.measures)) told["titles"].push_back({measure.name, measure.title});
    told["exposure"] = display.exposure;
    told["tone_map"] = name_of(display.tone_map);
    const std::pair<std::string_view, std::string> parts[] = {
        {"@title@", escaped(json["image"].get<std::string>())},
        {"@style@", std::string(page_style())},
        {"@crops@", std::string(page_crops())},
        {"@check@", script_text(told)},
        {"@pictures@", script_text(pictures)},
        {"@script@", std::string(page_script()) + std::string(script)},
    };
    return filled(page, parts);
}

}  // namespace vkcppm
