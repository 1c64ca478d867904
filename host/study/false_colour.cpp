#include "study/false_colour.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

namespace vkcppm {
namespace {

constexpr std::array<glm::u8vec3, 11> classes = {{{49, 54, 149},
                                                  {69, 117, 180},
                                                  {116, 173, 209},
                                                  {171, 217, 233},
                                                  {224, 243, 248},
                                                  {255, 255, 191},
                                                  {254, 224, 144},
                                                  {253, 174, 97},
                                                  {244, 109, 67},
                                                  {215, 48, 39},
                                                  {165, 0, 38}}};
constexpr glm::u8vec3 no_value{128, 128, 128};

}  // namespace

glm::u8vec3 false_colour(double t) {
    const double at = std::clamp(t, 0.0, 1.0) * double(classes.size() - 1);
    const std::size_t i = std::min(std::size_t(at), classes.size() - 2);
    glm::u8vec3 colour;
    for (int c = 0; c < 3; ++c) {
        const double below = classes[i][c], above = classes[i + 1][c];
        colour[c] = std::uint8_t(std::lround(std::lerp(below, above, at - double(i))));
    }
    return colour;
}

std::optional<double> ColourScale::position(double value) const {
    if (!std::isfinite(value) || (logarithmic && !(value > 0.0))) return std::nullopt;
    if (!(high > low)) return 0.0;
    const double part = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return std::clamp(part, 0.0, 1.0);
}

double positive_quantile(std::span<const float> values, double part) {
    std::vector<float> kept;
    std::ranges::copy_if(values, std::back_inserter(kept), [](float v) { return std::isfinite(v) && v > 0.0f; });
    if (kept.empty()) return 0.0;
    const auto at = kept.begin() + std::ptrdiff_t(std::lround(part * double(kept.size() - 1)));
    std::nth_element(kept.begin(), at, kept.end());
    return *at;
}

std::vector<float> absolute_difference(const Image& image, const Image& reference) {
    assert(image.extent == reference.extent);
    std::vector<float> differences;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const glm::vec3 difference = abs(image.rgb[i] - reference.rgb[i]);
        differences.push_back((difference.r + difference.g + difference.b) / 3.0f);
    }
    return differences;
}

Bitmap false_colours(Extent extent, std::span<const float> values, const ColourScale& scale) {
    assert(values.size() == extent.pixels());
    Bitmap bitmap{extent, {}};
    for (const float value : values) {
        const auto position = scale.position(value);
        bitmap.rgb.push_back(position ? false_colour(*position) : no_value);
    }
    return bitmap;
}

}  // namespace vkcppm
