#include "study/check.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/blocks.h"

namespace vkcppm {
namespace {

void compare_pixels(Check& result, const Image& image, const Image& reference) {
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const bool x_finite = is_finite(image.rgb[i]), r_finite = is_finite(reference.rgb[i]);
        double squared = x_finite == r_finite ? 0.0 : INFINITY;
        for (int c = 0; x_finite && r_finite && c < 3; ++c) {
            const double x = image.rgb[i][c], r = reference.rgb[i][c];
            squared += (x - r) * (x - r) / (r * r + relmse_epsilon) / 3.0;
        }
        result.difference.push_back(float(std::sqrt(squared)));
        result.unlike += x_finite != r_finite ? 1 : 0;
        result.masked += !x_finite && !r_finite ? 1 : 0;
    }
}

Condition keep_bound(const Bound& bound, const PictureMeasures& measures) {
    const std::vector<NamedMeasure> all = named(measures);
    const auto found = std::ranges::find(all, bound.name, &NamedMeasure::name);
    assert(found != all.end());
    if (std::isnan(found->value)) return {bound.name, false, fmt::format("{} is no number", bound.name)};
    const bool holds = found->value <= bound.most;
    return {bound.name, holds,
            fmt::format("{} {:.4g} is {} {:.4g}", bound.name, found->value, holds ? "within" : "above", bound.most)};
}

Condition keep_pixels(const Check& result, double most, double pixel_bound) {
    const auto count =
        std::ranges::count_if(result.difference, [&](float difference) { return difference > pixel_bound; });
    const double share = double(count) / double(std::max<std::size_t>(result.difference.size(), 1));
    const bool holds = share <= most;
    return {
        "max-pixels", holds,
        fmt::format("{} of {} pixels ({:.3g} %) differ by more than {:g} %, {} {:g} %", count, result.difference.size(),
                    100.0 * share, 100.0 * pixel_bound, holds ? "within" : "above", 100.0 * most)};
}

/// Of one scale; `extent` is the picture's.
Condition explain(const Scale& scale, Extent extent) {
    const Extent blocks = blocks_of(extent, scale.side);
    if (scale.side > 1 && blocks.pixels() == 1) {
        const bool holds = scale.differing == 0;
        return {"whole picture", holds,
                fmt::format("{} the mean of the whole picture, {:.3g} sigma",
                            holds ? "noise explains" : "more than noise is in", scale.worst)};
    }
    const std::string what = scale.side == 1 ? "pixels" : fmt::format("blocks of {0}x{0}", scale.side);
    const std::string worst =
        fmt::format("the worst {:.3g} sigma {} column {}, row {}", scale.worst, scale.side == 1 ? "at" : "from",
                    scale.worst_at % blocks.width * scale.side, scale.worst_at / blocks.width * scale.side);
    return {what, scale.differing == 0,
            scale.differing == 0
                ? fmt::format("noise explains {} {}, {}", scale.tests, what, worst)
                : fmt::format("{} of {} {} differ by more than noise, {}", scale.differing, scale.tests, what, worst)};
}

}  // namespace

bool Check::passes() const { return std::ranges::all_of(conditions, &Condition::holds); }

std::string Check::why() const {
    const bool all = passes();
    const std::size_t scales = significance ? significance->scales.size() : 0;
    std::vector<std::string> told;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
        const bool is_scale = i + scales >= conditions.size();  // they are the last, and told together where they hold
        if (all ? !is_scale : !conditions[i].holds) told.push_back(conditions[i].told);
    }
    if (significance) {
        std::size_t tests = 0;
        double worst = 0.0;
        for (const Scale& scale : significance->scales) {
            tests += scale.tests;
            worst = std::max(worst, scale.worst);
        }
        if (all)
            told.push_back(
                fmt::format("noise explains all {} pixels and blocks, the worst {:.3g} sigma", tests, worst));
        told.push_back(fmt::format("p = {:.2g} at level {:g} %", significance->p_value, 100.0 * significance->level));
    }
    return fmt::format("{}", fmt::join(told, "; "));
}

Check check(const NoisyPicture& image, const NoisyPicture& reference, const CheckSettings& settings) {
    Check result;
    result.measures = measure(image.mean, reference.mean);
    compare_pixels(result, image.mean, reference.mean);
    for (const Bound& bound : settings.bounds) result.conditions.push_back(keep_bound(bound, result.measures));
    if (result.measures.comparison.pixels == 0) {
        result.conditions.push_back({"finite", false, "no pixel is finite in both pictures"});
    }
    if (settings.max_pixels) {
        result.conditions.push_back(keep_pixels(result, *settings.max_pixels, settings.pixel_bound));
    } else if (result.unlike > 0) {
        result.conditions.push_back(
            {"finite", false,
             fmt::format("{} pixels are NaN or infinite in one picture and finite in the other", result.unlike)});
    }
    if (settings.level) {
        assert(!image.standard_error.empty() && !reference.standard_error.empty());
        result.significance = test_difference(image, reference, *settings.level);
        for (const Scale& scale : result.significance->scales) {
            result.conditions.push_back(explain(scale, image.mean.extent));
        }
    }
    return result;
}

}  // namespace vkcppm
