#include "oracle/sheen.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <boost/math/quadrature/gauss.hpp>

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;

constexpr double least_alpha = 0.07 * 0.07;
constexpr double least_cosine = 1e-6;

/// The specification's l(x, alpha_g): of its two columns of numbers the second weighs (1 - alpha_g)^2.
double l(double x, double alpha) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const double a = std::lerp(21.5473, 25.3245, t), b = std::lerp(3.82987, 3.32435, t);
    const double c = std::lerp(0.19823, 0.16801, t), d = std::lerp(-1.97760, -1.27393, t);
    const double e = std::lerp(-4.32054, -4.85967, t);
    return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double lambda(double cosine, double alpha) {
    return std::exp(cosine < 0.5 ? l(cosine, alpha) : 2.0 * l(0.5, alpha) - l(1.0 - cosine, alpha));
}

double distribution(double cos_h, double alpha) {
    return (2.0 + 1.0 / alpha) * std::pow(std::max(0.0, 1.0 - cos_h * cos_h), 0.5 / alpha) / (2.0 * pi);
}

/// The albedo times 4 cos (1 + Lambda), a smooth function: integral of D (1 + Lambda_o) / (1 + Lambda_o + Lambda_i).
double smooth_integral(double cosine, double alpha) {
    const double sine = std::sqrt(1.0 - cosine * cosine), lambda_o = lambda(cosine, alpha);
    const auto around = [&](double cos_i) {
        const double sin_i = std::sqrt(1.0 - cos_i * cos_i);
        const auto at = [&](double turn) {
            const double length = std::sqrt(2.0 + 2.0 * (cosine * cos_i + sine * sin_i * std::cos(turn)));
            return distribution((cosine + cos_i) / length, alpha);
        };
        return 2.0 * boost::math::quadrature::gauss<double, 50>::integrate(at, 0.0, pi) * (1.0 + lambda_o) /
               (1.0 + lambda_o + lambda(cos_i, alpha));
    };
    // Lambda has another form beyond a cosine of 1/2, and roots at 0 and at 1.
    const auto low = [&](double t) { return around(0.5 * t * t * t) * 1.5 * t * t; };
    const auto high = [&](double t) { return around(1.0 - 0.5 * t * t * t) * 1.5 * t * t; };
    return boost::math::quadrature::gauss<double, 40>::integrate(low, 0.0, 1.0) +
           boost::math::quadrature::gauss<double, 40>::integrate(high, 0.0, 1.0);
}

using Spline = boost::math::interpolators::cardinal_cubic_b_spline<double>;

/// In [0, 1] like the cosine, and stretched at both ends, where Lambda has its roots.
double stretched(double cosine) {
    const double low = std::pow(cosine, 0.25), high = std::pow(1.0 - cosine, 0.25);
    return low / (low + high);
}

double cosine_at(double stretched) {
    const double low = std::pow(stretched, 4), high = std::pow(1.0 - stretched, 4);
    return low / (low + high);
}

/// Of the logarithm of smooth_integral along the stretched cosine.
Spline spline_of(double alpha) {
    constexpr int parts = 128;
    std::vector<double> values;
    for (int i = 0; i <= parts; ++i) {
        const double cosine = std::max(least_cosine, cosine_at(double(i) / parts));
        values.push_back(std::log(smooth_integral(cosine, alpha)));
    }
    return Spline(values.begin(), values.end(), 0.0, 1.0 / parts);
}

}  // namespace

double sheen_albedo(double cosine, double alpha) {
    alpha = std::max(alpha, least_alpha);
    static thread_local std::map<double, Spline> known;
    auto found = known.find(alpha);
    if (found == known.end()) found = known.emplace(alpha, spline_of(alpha)).first;
    cosine = std::max(cosine, least_cosine);
    return std::exp(found->second(stretched(cosine))) / (4.0 * cosine * (1.0 + lambda(cosine, alpha)));
}

double sheen_value(double cos_o, double cos_i, double cos_h, double alpha) {
    alpha = std::max(alpha, least_alpha);
    const double visibility = 1.0 / ((1.0 + lambda(cos_o, alpha) + lambda(cos_i, alpha)) * (4.0 * cos_o * cos_i));
    return distribution(cos_h, alpha) * visibility /
           std::max({1.0, sheen_albedo(cos_o, alpha), sheen_albedo(cos_i, alpha)});
}

}  // namespace vkcppm::oracle
