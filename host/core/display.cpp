#include "core/display.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace vkcppm {
namespace {

constexpr double middle_grey = 0.18;
constexpr double least_exposure = -128.0;  // stops: any float is black

// AgX: into a wider gamut, log2 between two exposures, a sigmoid, and back (Sobotka, github.com/sobotka/AgX); numbers
// of Wrensch, columns as there.
constexpr double agx_first = -12.47393, agx_last = 4.026069;                           // stops
const glm::dmat3 agx_inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051,  //
                           0.0784335999999992, 0.878468636469772, 0.0784336,           //
                           0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const glm::dmat3 agx_outset(1.19687900512017, -0.0528968517574562, -0.0529716355144438,  //
                            -0.0980208811401368, 1.15190312990417, -0.0980434501171241,  //
                            -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
constexpr double agx_gamma = 2.2;

/// The sigmoid: x of 0..1 between the exposures to the encoded value. Mean squared error 3.7e-6.
double agx_sigmoid(double x) {
    return ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.00232;
}

glm::dvec3 agx(const glm::dvec3& x) {
    const glm::dvec3 wide = agx_inset * x;
    glm::dvec3 encoded;
    for (int c = 0; c < 3; ++c) {
        const double stops = std::clamp(std::log2(wide[c]), agx_first, agx_last);  // of 0: the first
        encoded[c] = agx_sigmoid((stops - agx_first) / (agx_last - agx_first));
    }
    return glm::pow(glm::max(agx_outset * encoded, glm::dvec3(0.0)), glm::dvec3(agx_gamma));
}

glm::dvec3 exposed(const glm::dvec3& radiance, double exposure) {
    glm::dvec3 x = radiance * std::exp2(exposure);
    for (int c = 0; c < 3; ++c) x[c] = x[c] > 0.0 ? std::min(x[c], 1e30) : 0.0;  // NaN: 0; below where squares overflow
    return x;
}

bool is_clipped(const glm::dvec3& radiance, const Display& display) {
    if (std::isnan(radiance.r + radiance.g + radiance.b)) return false;
    const glm::dvec3 x = display.tone_map == ToneMap::agx
                             ? agx_inset * exposed(radiance, display.exposure) / std::exp2(agx_last)
                             : shown(radiance, display);
    return std::max({x.r, x.g, x.b}) > 1.0;
}

}  // namespace

std::string_view name_of(ToneMap tone_map) {
    switch (tone_map) {
        case ToneMap::none: break;
        case ToneMap::reinhard: return "reinhard";
        case ToneMap::aces: return "aces";
        case ToneMap::agx: return "agx";
    }
    return "none";
}

double luminance(const glm::dvec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

double aces_curve(double x) {
    const double y = 0.6 * x;
    return y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14);
}

glm::dvec3 shown(const glm::dvec3& radiance, const Display& display) {
    const glm::dvec3 x = exposed(radiance, display.exposure);
    switch (display.tone_map) {
        case ToneMap::none: break;
        case ToneMap::reinhard: return x / (1.0 + luminance(x));
        case ToneMap::aces: return {aces_curve(x.r), aces_curve(x.g), aces_curve(x.b)};
        case ToneMap::agx: return agx(x);
    }
    return x;
}

double automatic_exposure(const Image& image) {
    std::vector<double> lit;
    for (const glm::vec3& pixel : image.rgb) {
        const double y = luminance(pixel);
        if (std::isfinite(y) && y > 0.0) lit.push_back(y);
    }
    if (lit.empty()) return 0.0;
    const auto middle = lit.begin() + std::ptrdiff_t(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    return std::log2(middle_grey / *middle);
}

double clipped_share(const Image& image, const Display& display) {
    const auto clipped =
        std::ranges::count_if(image.rgb, [&](const auto& pixel) { return is_clipped(pixel, display); });
    return image.rgb.empty() ? 0.0 : double(clipped) / double(image.rgb.size());
}

double exposure_without_clipping(const Image& image, const Display& display, double share) {
    // Curves rise with the exposure, and so does what is clipped. In hundredths of a stop.
    long fits = long(100.0 * least_exposure), clips = long(std::floor(100.0 * display.exposure)) + 1;
    while (clips - fits > 1) {
        const long middle = fits + (clips - fits) / 2;
        const Display dimmer{display.tone_map, double(middle) / 100.0};
        (clipped_share(image, dimmer) <= share ? fits : clips) = middle;
    }
    return double(fits) / 100.0;
}

}  // namespace vkcppm
