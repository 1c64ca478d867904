#pragma once
// A race as one page for a browser.

#include <string>

#include <nlohmann/json.hpp>

#include "app/race/pictures.h"

namespace vkcppm {

/// HTML that needs nothing besides itself: race.html with the style and script of all pages, its own scripts, the
/// pictures and `race` (race_json) in it, the latter without the curves of single seeds, which are not drawn.
std::string race_page(const nlohmann::ordered_json& race, const RacePictures& pictures);

}  // namespace vkcppm
