#include "app/race/page.h"

#include <string_view>
#include <utility>

#include "app/page/html.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view page =
#include "race.html.inc"
    ;
constexpr std::string_view scripts[] = {
#include "plot.js.inc"
    ,
#include "tables.js.inc"
    ,
#include "tiles.js.inc"
    ,
#include "race.js.inc"  // the last: it calls the others
};

Json pictures_json(const RacePictures& pictures) {
    Json json{{"reference", data_uri(pictures.reference)},
              {"winner", data_uri(pictures.winner.map)},
              {"winner_around", data_uri(pictures.winner_around.map)},
              {"ramp", data_uri(colour_ramp())},
              {"entrants", Json::array()}};
    for (const EntrantPictures& entrant : pictures.entrants) {
        Json views = Json::object();
        for (const auto& [view, bitmap] : entrant) views[view] = data_uri(bitmap);
        json["entrants"].push_back(std::move(views));
    }
    return json;
}

}  // namespace

std::string race_page(const Json& race, const RacePictures& pictures) {
    Json drawn = race;
    for (Json& entrant : drawn["entrants"]) {
        for (Json& run : entrant["runs"]) run.erase("curve");
    }
    std::string script(page_script());
    for (const std::string_view part : scripts) script += part;
    const std::pair<std::string_view, std::string> parts[] = {
        {"@title@", escaped(race["scene"]["file"].get<std::string>())},
        {"@style@", std::string(page_style())},
        {"@crops@", std::string(page_crops())},
        {"@race@", script_text(drawn)},
        {"@pictures@", script_text(pictures_json(pictures))},
        {"@script@", script},
    };
    return filled(page, parts);
}

}  // namespace vkcppm
