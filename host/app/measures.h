#pragma once
// Errors as JSON, by the names of metrics().

#include <nlohmann/json.hpp>

#include "core/curve.h"
#include "core/metrics.h"
#include "study/measures.h"

namespace vkcppm {

/// Adds every metric of `comparison` to the object `json`. What is infinite or not a number becomes null when it is
/// written: JSON has neither.
void add_measures(nlohmann::ordered_json& json, const Comparison& comparison);

/// The same of named().
void add_measures(nlohmann::ordered_json& json, const PictureMeasures& measures);

/// [{iterations, seconds, a member a metric}], a snapshot each.
nlohmann::ordered_json curve_json(const Curve& curve);

}  // namespace vkcppm
