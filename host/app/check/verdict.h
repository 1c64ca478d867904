#pragma once
// A check as text: JSON, and XML for CI servers.

#include <string>

#include <nlohmann/json.hpp>

#include "app/options.h"
#include "study/check.h"

namespace vkcppm {

/// "passes: ..." or "differs: ...", one line without its end.
std::string verdict_line(const Check& check);

/// The verdict, its conditions, all measures and what the test of the noise found.
nlohmann::ordered_json check_json(const CheckOptions& options, const Check& check, Extent extent);

/// JUnit's XML, as Jenkins, GitLab and others read it: a test case a condition.
std::string junit_xml(const CheckOptions& options, const Check& check);

}  // namespace vkcppm
