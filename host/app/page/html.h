#pragma once
// Pages for a browser that need nothing besides themselves: what that of a race and that of a check have in common.

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/image.h"
#include "study/false_colour.h"

namespace vkcppm {

/// The bitmap as an address that holds it.
std::string data_uri(const Bitmap& bitmap);

/// [256] false_colour from 0 to 1, a row.
Bitmap colour_ramp();

/// {low, high, logarithmic}
nlohmann::ordered_json scale_json(const ColourScale& scale);

/// JSON that may stand in a script element, which "</" would end and "<!--" would change.
std::string script_text(const nlohmann::ordered_json& json);

/// Text that HTML shows as it is.
std::string escaped(std::string_view text);

/// The style of all pages.
std::string_view page_style();

/// The script that comes before a page's own: elements, numbers, tiles with a crop.
std::string_view page_script();

/// The end of a section with tiles: what chooses the crop of crops.js, and the tiles.
std::string_view page_crops();

/// `page` with texts in place of marks, {mark, text} in the order in which the page has them. Asserts that it has.
std::string filled(std::string_view page, std::span<const std::pair<std::string_view, std::string>> parts);

}  // namespace vkcppm
