#include "study/measures.h"

#include <algorithm>

namespace vkcppm {

PictureMeasures measure(const Image& image, const Image& reference) {
    Comparison comparison = compare(image, reference);  // says so where the sizes differ
    return {std::move(comparison), hdr_flip(image, reference), ldr_flip(image, reference)};
}

std::vector<NamedMeasure> named(const PictureMeasures& measures) {
    std::vector<NamedMeasure> all;
    for (const Metric& metric : metrics()) all.push_back({metric.name, metric.title, metric.of(measures.comparison)});
    all.push_back({"flip", "FLIP (HDR)", measures.flip.mean});
    all.push_back({"ldr_flip", "FLIP (8-bit sRGB)", measures.ldr_flip.mean});
    return all;
}

std::string measure_names() {
    std::string names;
    for (const NamedMeasure& measure : named({})) names += (names.empty() ? "" : ", ") + std::string(measure.name);
    return names;
}

bool is_measure(std::string_view name) {
    return std::ranges::any_of(named({}), [&](const NamedMeasure& measure) { return measure.name == name; });
}

}  // namespace vkcppm
