#include "core/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/srgb.h"

namespace vkcppm {
namespace {

/// Mean of the pixels' values, and without the largest. values [pixels], reordered.
Measure measure(std::vector<double> values) {
    const auto mean = [&](std::size_t count) {
        return std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(count), 0.0) / double(count);
    };
    Measure result;
    result.all = mean(values.size());
    const std::size_t kept = values.size() - values.size() / trimmed_one_in;
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(kept), values.end());
    result.trimmed = mean(kept);
    return result;
}

std::string text(const Extent& extent) { return std::to_string(extent.width) + "x" + std::to_string(extent.height); }

}  // namespace

Comparison compare(const Image& image, const Image& reference) {
    if (image.extent != reference.extent) {
        throw Error(ExitCode::usage, "the image is " + text(image.extent) + " pixels, the reference " +
                                         text(reference.extent) + ": only pictures of one size can be compared");
    }
    Comparison result;
    result.extent = image.extent;
    glm::dvec3 image_sum{0.0};
    glm::dvec3 reference_sum{0.0};
    std::vector<double> squares, relatives, ratios, levels;  // [pixels compared] means over the channels
    for (std::vector<double>* values : {&squares, &relatives, &ratios, &levels}) values->reserve(image.rgb.size());
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const bool image_finite = is_finite(image.rgb[i]);
        const bool reference_finite = is_finite(reference.rgb[i]);
        result.image_non_finite += !image_finite;
        result.reference_non_finite += !reference_finite;
        if (!image_finite || !reference_finite) continue;
        double square = 0.0, relative = 0.0, ratio = 0.0, level = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double x = image.rgb[i][c];
            const double r = reference.rgb[i][c];
            const double squared = (x - r) * (x - r);
            const double size = std::abs(x) + std::abs(r);
            const double step = double(srgb_byte(x)) - double(srgb_byte(r));
            image_sum[c] += x;
            reference_sum[c] += r;
            square += squared / 3.0;
            relative += squared / (r * r + relmse_epsilon) / 3.0;
            ratio += size > 0.0 ? std::abs(x - r) / size / 3.0 : 0.0;
            level += step * step / 3.0;
        }
        squares.push_back(square);
        relatives.push_back(relative);
        ratios.push_back(ratio);
        levels.push_back(level);
    }
    result.pixels = squares.size();
    for (int c = 0; c < 3; ++c) {
        const bool are_black = image_sum[c] == 0.0 && reference_sum[c] == 0.0;
        result.mean_ratio[c] = are_black ? 1.0 : image_sum[c] / reference_sum[c];
    }
    result.mse = measure(std::move(squares));
    result.rmse = {std::sqrt(result.mse.all), std::sqrt(result.mse.trimmed)};
    result.relmse = measure(std::move(relatives));
    result.smape = measure(std::move(ratios));
    result.srgb_mse = measure(std::move(levels));
    result.psnr = 10.0 * std::log10(255.0 * 255.0 / result.srgb_mse.all);
    return result;
}

std::span<const Metric> metrics() {
    static constexpr Metric table[] = {
        {"mse", "MSE", &Comparison::mse, &Measure::all},
        {"mse_trimmed", "MSE without the worst 0.1 %", &Comparison::mse, &Measure::trimmed},
        {"rmse", "RMSE", &Comparison::rmse, &Measure::all},
        {"rmse_trimmed", "RMSE without the worst 0.1 %", &Comparison::rmse, &Measure::trimmed},
        {"relmse", "relMSE (eps 0.01)", &Comparison::relmse, &Measure::all},
        {"relmse_trimmed", "relMSE without the worst 0.1 %", &Comparison::relmse, &Measure::trimmed},
        {"smape", "SMAPE", &Comparison::smape, &Measure::all},
        {"smape_trimmed", "SMAPE without the worst 0.1 %", &Comparison::smape, &Measure::trimmed},
        {"srgb_mse", "8-bit sRGB MSE", &Comparison::srgb_mse, &Measure::all},
        {"srgb_mse_trimmed", "8-bit sRGB MSE without the worst 0.1 %", &Comparison::srgb_mse, &Measure::trimmed},
    };
    return table;
}

const Metric& default_metric() { return find_metric("", "relmse_trimmed"); }

std::string metric_names() {
    std::string names;
    for (const Metric& metric : metrics()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
    return names;
}

const Metric& find_metric(std::string_view option, std::string_view name) {
    for (const Metric& metric : metrics()) {
        if (metric.name == name) return metric;
    }
    throw Error(ExitCode::usage,
                std::string(option) + ": '" + std::string(name) + "' is no metric: there are " + metric_names());
}

}  // namespace vkcppm
