#pragma once
// What scenes/NAME.expect.json says of a scene with a closed form.

#include <cstdint>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "support/files/places.h"

namespace vkcppm::test {

inline nlohmann::json expectation_of(const std::string& name) {
    std::ifstream file(source_folder() / "scenes" / (name + ".expect.json"));
    return nlohmann::json::parse(file);
}

/// Calls `visit` with x and y of every pixel of one of its regions.
template <typename Visit> void for_each_pixel(const nlohmann::json& region, const Visit& visit) {
    for (std::uint32_t y = region["y"][0]; y < region["y"][1]; ++y) {
        for (std::uint32_t x = region["x"][0]; x < region["x"][1]; ++x) visit(x, y);
    }
}

}  // namespace vkcppm::test
