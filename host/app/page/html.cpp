#include "app/page/html.h"

#include <cassert>

#include "app/page/base64.h"
#include "app/provenance.h"
#include "io/png.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view style =
#include "page.css.inc"
    ;
constexpr std::string_view crops =
#include "crops.html.inc"
    ;
constexpr std::string_view scripts[] = {
#include "common.js.inc"
    ,
#include "crops.js.inc"
};

}  // namespace

std::string data_uri(const Bitmap& bitmap) { return "data:image/png;base64," + encode_base64(encode_png(bitmap)); }

Bitmap colour_ramp() {
    Bitmap ramp{{256, 1}, {}};
    for (std::uint32_t i = 0; i < ramp.extent.width; ++i) {
        ramp.rgb.push_back(false_colour(double(i) / (ramp.extent.width - 1)));
    }
    return ramp;
}

Json scale_json(const ColourScale& scale) {
    return {{"low", scale.low}, {"high", scale.high}, {"logarithmic", scale.logarithmic}};
}

std::string script_text(const Json& json) {
    std::string text;
    for (const char c : json_text(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text) html += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return html;
}

std::string_view page_style() { return style; }

std::string_view page_crops() { return crops; }

std::string_view page_script() {
    static const std::string script = std::string(scripts[0]) + std::string(scripts[1]);
    return script;
}

std::string filled(std::string_view page, std::span<const std::pair<std::string_view, std::string>> parts) {
    std::string html;
    std::string_view rest = page;
    for (const auto& [mark, text] : parts) {
        const std::size_t at = rest.find(mark);
        assert(at != rest.npos);
        html += std::string(rest.substr(0, at)) + text;
        rest.remove_prefix(at + mark.size());
    }
    return html + std::string(rest);
}

}  // namespace vkcppm
