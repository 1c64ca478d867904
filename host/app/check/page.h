#pragma once
// A check as one page for a browser.

#include <string>

#include <nlohmann/json.hpp>

#include "core/display.h"
#include "study/check.h"

namespace vkcppm {

/// HTML that needs nothing besides itself: check.html with the style and script of all pages, check.js, `json`
/// (check_json) and both pictures and maps of where they differ in it.
std::string check_page(const nlohmann::ordered_json& json, const Check& check, const Image& image,
                       const Image& reference, const Display& display);

}  // namespace vkcppm
