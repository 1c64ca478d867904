#pragma once
// How a file is called.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace vkcppm {

/// The ending of a name with its dot, in lower case; empty where it has none.
inline std::string ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return ending;
}

}  // namespace vkcppm
