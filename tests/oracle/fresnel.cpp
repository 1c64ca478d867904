#include "oracle/fresnel.h"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

namespace vkcppm::oracle {
namespace {

constexpr int nodes = 96;  // enough for any film that a channel can tell from none: what they sum is smooth

/// Weights of the channels at wave numbers 1/nm, each of sum 1 over all.
struct Spectrum {
    std::array<double, nodes> wave_number;
    std::array<glm::dvec3, nodes> weight;
};

Spectrum spectrum() {
    // Belcour and Barla 2017: height, centre (1/m) and, halved, variance (1/m^2) of the sensitivities of X, Y, Z, and
    // the second hump of X.
    struct Gaussian {
        double height, centre, half_variance;
        glm::dvec3 xyz;
    };
    constexpr Gaussian gaussians[] = {{5.4856e-13, 1.6810e6, 4.3278e9, {1, 0, 0}},
                                      {4.4201e-13, 1.7953e6, 9.3046e9, {0, 1, 0}},
                                      {5.2481e-13, 2.2084e6, 6.6121e9, {0, 0, 1}},
                                      {9.7470e-14, 2.2399e6, 4.5282e9, {1, 0, 0}}};
    // IEC 61966-2-1, by columns.
    const glm::dmat3 srgb({3.2404542, -0.9692660, 0.0556434}, {-1.5371385, 1.8760108, -0.2040259},
                          {-0.4985314, 0.0415560, 1.0572252});
    Spectrum s;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < nodes; ++i) {
        const double k = 0.9e6 + (3.3e6 - 0.9e6) * (i + 0.5) / nodes;
        glm::dvec3 xyz(0.0);
        for (const Gaussian& g : gaussians)
            xyz += g.xyz * g.height * std::exp(-(k - g.centre) * (k - g.centre) / (4.0 * g.half_variance));
        s.wave_number[i] = k * 1e-9;
        s.weight[i] = srgb * xyz;
        sum += s.weight[i];
    }
    for (glm::dvec3& weight : s.weight) weight /= sum;
    return s;
}

}  // namespace

double fresnel_dielectric(double cosine, double ior_ratio) {
    const double incident = std::acos(cosine);
    const double sine = std::sin(incident) / ior_ratio;
    if (sine >= 1.0) return 1.0;
    if (incident < 1e-6) {  // the limit of 0/0; off by less than 1e-12
        return std::pow((ior_ratio - 1.0) / (ior_ratio + 1.0), 2);
    }
    const double transmitted = std::asin(sine);
    const double perpendicular = std::sin(incident - transmitted) / std::sin(incident + transmitted);
    const double parallel = std::tan(incident - transmitted) / std::tan(incident + transmitted);
    return (perpendicular * perpendicular + parallel * parallel) / 2.0;
}

glm::dvec3 fresnel_schlick(const glm::dvec3& f0, double f90, double cosine) {
    const double x = 1.0 - cosine;
    return f0 + (f90 - f0) * (x * x * x * x * x);
}

glm::dvec3 fresnel_metal(const glm::dvec3& base, double cosine) { return fresnel_schlick(base, 1.0, cosine); }

glm::dvec3 fresnel_film(const glm::dvec3& f0, double cosine, double index, double thickness, int orders) {
    static const Spectrum channels = spectrum();
    const double beyond = std::cos(std::asin(std::sqrt(1.0 - cosine * cosine) / index));
    const auto schlick = [](double amplitude, double c) {
        return fresnel_schlick(glm::dvec3(amplitude * amplitude), 1.0, c).x;
    };
    const double outer = schlick((index - 1.0) / (index + 1.0), cosine);
    glm::dvec3 sum(0.0);
    for (int c = 0; c < 3; ++c) {
        const double root = std::sqrt(std::min(f0[c], 0.9999)), base = (1.0 + root) / (1.0 - root);
        const double inner = schlick((base - index) / (base + index), beyond);
        const double both = std::min(outer * inner, 0.9999);
        // Of amplitude: what comes back after the base and the inside of the outer face. A denser base turns its sign.
        const double back = base > index ? -std::sqrt(both) : std::sqrt(both);
        const double once = (1.0 - outer) * (1.0 - outer) * inner / (1.0 - both);
        for (int i = 0; i < nodes; ++i) {
            const double phase = 4.0 * std::numbers::pi * index * thickness * beyond * channels.wave_number[i];
            const std::complex<double> q = std::polar(1.0, phase) * back;
            const std::complex<double> tail = orders == endless ? 0.0 : std::pow(q, orders);
            const double harmonics = (q * (1.0 - tail) / (1.0 - q)).real();
            sum[c] += channels.weight[i][c] * (outer + once + 2.0 * (once - (1.0 - outer)) * harmonics);
        }
    }
    return glm::clamp(sum, 0.0, 1.0);
}

}  // namespace vkcppm::oracle
