#pragma once
// The shape of the parts of glTF 2.0 that the loader reads: types, required members, hard limits, references.

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace vkcppm {

/// Checks `document` against the tables of the glTF 2.0 schema for what the loader reads, supported extensions
/// included: a member has its type, lies in its hard limits, and an index names an element that exists. Numbers
/// (not indices or counts) are rewritten as floating point. Throws Error(bad_input) with object, value, limit, file.
void check_gltf_schema(nlohmann::json& document, std::string_view file);

/// The names in the root array `member` ("extensionsUsed" or "extensionsRequired") that the loader does not support, as
/// JSON strings. Throws Error(bad_input) where the member is not an array of strings.
std::vector<std::string> unsupported_extensions(const nlohmann::json& document, std::string_view member,
                                                std::string_view file);

/// `value` as JSON text for a message: one line, at most 60 bytes.
std::string json_text(const nlohmann::json& value);

}  // namespace vkcppm
