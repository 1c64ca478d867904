#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/measures.h"
#include "app/provenance.h"
#include "core/error.h"
#include "io/exr.h"
#include "study/measures.h"

namespace vkcppm {
namespace {

nlohmann::ordered_json json_of(const CompareOptions& options, const PictureMeasures& measures) {
    const Comparison& comparison = measures.comparison;
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
    add_measures(json, measures);
    json["psnr"] = comparison.psnr;
    return json;
}

std::string plain_text(const PictureMeasures& measures) {
    const Comparison& comparison = measures.comparison;
    const glm::dvec3& ratio = comparison.mean_ratio;
    std::string text = fmt::format("{:<40}{:.6f} {:.6f} {:.6f}\n", "mean ratio R G B", ratio.r, ratio.g, ratio.b);
    for (const NamedMeasure& measure : named(measures)) {
        text += fmt::format("{:<40}{:.6g}\n", measure.title, measure.value);
    }
    return text + fmt::format("{:<40}{:.2f} dB\n", "PSNR (8-bit sRGB)", comparison.psnr);
}

}  // namespace

void execute(const CompareOptions& options) {
    const Image image = read_exr(options.image);
    const PictureMeasures measures = measure(image, read_exr(options.reference));
    const Comparison& comparison = measures.comparison;
    if (comparison.pixels == 0) {
        throw Error(ExitCode::bad_input, fmt::format("no pixel is finite in both {} and {}", options.image.string(),
                                                     options.reference.string()));
    }
    if (comparison.pixels < image.extent.pixels()) {
        print_message(
            fmt::format("warning: {} pixels of the image and {} of the reference are NaN or infinite; "
                        "they are left out",
                        comparison.image_non_finite, comparison.reference_non_finite));
    }
    print_result(options.json ? json_text(json_of(options, measures), 2) + "\n" : plain_text(measures));
}

}  // namespace vkcppm
