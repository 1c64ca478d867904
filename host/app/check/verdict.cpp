#include "app/check/verdict.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/measures.h"
#include "app/provenance.h"
#include "app/version.h"
#include "core/blocks.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_places = 20;  // of a scale, that are told by name

Json scale_json(const Scale& scale, Extent extent) {
    const std::uint32_t columns = blocks_of(extent, scale.side).width;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < scale.sigma.size(); ++i) {
        if (scale.differs[i]) order.push_back(i);
    }
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return scale.sigma[a] > scale.sigma[b]; });
    if (order.size() > most_places) order.resize(most_places);
    Json json{{"side", scale.side},
              {"tests", scale.tests},
              {"differing", scale.differing},
              {"worst_sigma", scale.worst},
              {"places", Json::array()}};
    for (const std::size_t i : order) {
        json["places"].push_back(
            {{"x", i % columns * scale.side}, {"y", i / columns * scale.side}, {"sigma", scale.sigma[i]}});
    }
    return json;
}

/// Text that XML takes: no character that it has another meaning for, none that it cannot hold.
std::string xml(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '<': escaped += "&lt;"; break;
            case '>': escaped += "&gt;"; break;
            case '&': escaped += "&amp;"; break;
            case '"': escaped += "&quot;"; break;
            default: escaped += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e ? '?' : c;
        }
    }
    return escaped;
}

}  // namespace

std::string verdict_line(const Check& check) {
    return fmt::format("{}: {}", check.passes() ? "passes" : "differs", check.why());
}

Json check_json(const CheckOptions& options, const Check& check, Extent extent) {
    const Comparison& comparison = check.measures.comparison;
    Json json{{"version", version()},
              {"image", options.image.string()},
              {"reference", options.reference.string()},
              {"width", extent.width},
              {"height", extent.height},
              {"passes", check.passes()},
              {"why", check.why()},
              {"conditions", Json::array()},
              {"pixels", comparison.pixels},
              {"image_non_finite", comparison.image_non_finite},
              {"reference_non_finite", comparison.reference_non_finite},
              {"finite_in_one", check.unlike},
              {"measures", Json::object()}};
    for (const Condition& condition : check.conditions) {
        json["conditions"].push_back({{"name", condition.name}, {"holds", condition.holds}, {"told", condition.told}});
    }
    add_measures(json["measures"], check.measures);
    if (const auto& significance = check.significance) {
        Json& noise = json["noise"];
        noise = {{"level", significance->level}, {"p_value", significance->p_value}, {"scales", Json::array()}};
        for (const Scale& scale : significance->scales) noise["scales"].push_back(scale_json(scale, extent));
    }
    return json;
}

std::string junit_xml(const CheckOptions& options, const Check& check) {
    const auto failures = std::ranges::count(check.conditions, false, &Condition::holds);
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
    text += fmt::format("  <testsuite name=\"vkcppm check\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n",
                        check.conditions.size(), failures);
    for (const Condition& condition : check.conditions) {
        text +=
            fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xml(options.image.string()), xml(condition.name));
        text += condition.holds
                    ? "/>\n"
                    : fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n", xml(condition.told));
    }
    return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace vkcppm
