#pragma once
// Names for tests that have a parameter.

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "render/estimators.h"

namespace vkcppm::test {

/// The name as GoogleTest takes it: letters, digits and underscores.
inline std::string identifier(std::string_view name) {
    std::string result(name);
    std::ranges::replace_if(
        result, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return result;
}

/// Of all estimators, as --estimator takes them.
inline std::vector<std::string> all_estimators() {
    std::vector<std::string> names;
    for (const EstimatorRow& row : estimators()) names.emplace_back(row.name);
    return names;
}

}  // namespace vkcppm::test
