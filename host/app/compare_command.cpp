#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/measures.h"
#include "app/record.h"
#include "core/metrics.h"
#include "io/exr.h"

namespace vkcppm {
namespace {

nlohmann::ordered_json json_of(const CompareOptions& options, const Comparison& comparison) {
    const glm::dvec3& ratio = comparison.mean_ratio;
    nlohmann::ordered_json json;
    json["image"] = options.image.string();
    json["reference"] = options.reference.string();
    json["width"] = comparison.extent.width;
    json["height"] = comparison.extent.height;
    json["pixels"] = comparison.pixels;
    json["image_non_finite"] = comparison.image_non_finite;
    json["reference_non_finite"] = comparison.reference_non_finite;
    json["mean_ratio"] = {ratio.r, ratio.g, ratio.b};
    add_measures(json, comparison);
    json["psnr"] = comparison.psnr;
    return json;
}

std::string plain_text(const Comparison& comparison) {
    const glm::dvec3& ratio = comparison.mean_ratio;
    std::string text = fmt::format("{:<40}{:.6f} {:.6f} {:.6f}\n", "mean ratio R G B", ratio.r, ratio.g, ratio.b);
    for (const Metric& metric : metrics()) {
        text += fmt::format("{:<40}{:.6g}\n", metric.title, metric.of(comparison));
    }
    return text + fmt::format("{:<40}{:.2f} dB\n", "PSNR (8-bit sRGB)", comparison.psnr);
}

}  // namespace

void execute(const CompareOptions& options) {
    const Image image = read_exr(options.image);
    const Comparison comparison = compare(image, read_exr(options.reference));
    if (comparison.pixels < image.extent.pixels()) {
        print_message(
            fmt::format("warning: {} pixels of the image and {} of the reference are NaN or infinite; "
                        "they are left out",
                        comparison.image_non_finite, comparison.reference_non_finite));
    }
    print_result(options.json ? json_text(json_of(options, comparison), 2) + "\n" : plain_text(comparison));
}

}  // namespace vkcppm
