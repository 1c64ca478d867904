#include "app/race/page.h"

#include <cassert>
#include <string_view>
#include <utility>

#include "app/race/base64.h"
#include "app/record.h"
#include "io/png.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view page =
#include "page.html.inc"
    ;
constexpr std::string_view style =
#include "page.css.inc"
    ;
constexpr std::string_view scripts[] = {
#include "plot.js.inc"
    ,
#include "tables.js.inc"
    ,
#include "tiles.js.inc"
    ,
#include "page.js.inc"  // the last: it calls the others
};

std::string data_uri(const Bitmap& bitmap) { return "data:image/png;base64," + encode_base64(encode_png(bitmap)); }

/// [width] colours from 0 to 1.
Bitmap colour_ramp() {
    Bitmap ramp{{256, 1}, {}};
    for (std::uint32_t i = 0; i < ramp.extent.width; ++i) {
        ramp.rgb.push_back(false_colour(double(i) / (ramp.extent.width - 1)));
    }
    return ramp;
}

Json pictures_json(const RacePictures& pictures) {
    Json json{{"reference", data_uri(pictures.reference)},
              {"winner", data_uri(pictures.winner.map)},
              {"winner_around", data_uri(pictures.winner_around.map)},
              {"ramp", data_uri(colour_ramp())},
              {"entrants", Json::array()}};
    for (const EntrantPictures& entrant : pictures.entrants) {
        json["entrants"].push_back({{"picture", data_uri(entrant.picture)},
                                    {"difference", data_uri(entrant.difference)},
                                    {"radius", data_uri(entrant.radius)}});
    }
    return json;
}

/// JSON that may stand in a script element, which "</" would end and "<!--" would change.
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

}  // namespace

std::string race_page(const Json& race, const RacePictures& pictures) {
    Json drawn = race;
    for (Json& entrant : drawn["entrants"]) {
        for (Json& run : entrant["runs"]) run.erase("curve");
    }
    std::string script;
    for (const std::string_view part : scripts) script += part;
    const std::pair<std::string_view, std::string> parts[] = {
        {"@title@", escaped(race["scene"]["file"].get<std::string>())},
        {"@style@", std::string(style)},
        {"@race@", script_text(drawn)},
        {"@pictures@", script_text(pictures_json(pictures))},
        {"@script@", script},
    };
    std::string html;
    std::string_view rest = page;
    for (const auto& [mark, text] : parts) {  // in the order in which the page has them
        const std::size_t at = rest.find(mark);
        assert(at != rest.npos);
        html += std::string(rest.substr(0, at)) + text;
        rest.remove_prefix(at + mark.size());
    }
    return html + std::string(rest);
}

}  // namespace vkcppm
