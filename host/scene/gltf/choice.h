#pragma once
// What a command line chooses of a glTF file by name.

#include <charconv>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace vkcppm {

/// The place of what `wanted` names in `array`, by name, else by index. Throws Error(usage) with what there is of
/// `things`.
inline std::size_t choose(const char* option, const std::string& wanted, const nlohmann::json& array,
                          const char* things, const std::string& file) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < array.size(); ++i) {
        const std::string name = array[i].value("name", "");
        if (name == wanted) return i;
        names.push_back(fmt::format("{} '{}'", i, name));
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < array.size()) return index;
    throw Error(ExitCode::usage,
                fmt::format("{} '{}' is none of the {} of {}: {}", option, wanted, things, file,
                            names.empty() ? "there are none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace vkcppm
