#include "app/measures.h"

#include <string>
#include <utility>

namespace vkcppm {

void add_measures(nlohmann::ordered_json& json, const Comparison& comparison) {
    for (const Metric& metric : metrics()) json[std::string(metric.name)] = metric.of(comparison);
}

void add_measures(nlohmann::ordered_json& json, const PictureMeasures& measures) {
    for (const NamedMeasure& measure : named(measures)) json[std::string(measure.name)] = measure.value;
}

nlohmann::ordered_json curve_json(const Curve& curve) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const CurvePoint& point : curve) {
        nlohmann::ordered_json row = {{"iterations", point.iterations}, {"seconds", point.seconds}};
        add_measures(row, point.error);
        json.push_back(std::move(row));
    }
    return json;
}

}  // namespace vkcppm
