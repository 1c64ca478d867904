#include "oracle/dispersion.h"

#include <algorithm>
#include <cmath>

namespace vkcppm::oracle {
namespace {

constexpr double half_width = 100.0;  // nm

double hat(double wavelength, double centre) { return std::max(0.0, 1.0 - std::abs(wavelength - centre) / half_width); }

}  // namespace

double ior_at(double ior, double dispersion, double wavelength) {
    const auto wavenumber2 = [](double l) { return 1.0 / (l * l); };
    const double spread = (ior - 1.0) * dispersion / 20.0;  // n_F - n_C
    const double b = spread / (wavenumber2(486.1) - wavenumber2(656.3));
    return ior + b * (wavenumber2(wavelength) - wavenumber2(587.6));
}

glm::dvec3 wavelength_color(double wavelength) {
    // Areas: the whole triangle is its half width; red and blue lose the outer half of a slope, an eighth.
    const double range = longest_wavelength - shortest_wavelength;
    return range / half_width *
           glm::dvec3(hat(wavelength, 650.0) / 0.875, hat(wavelength, 550.0), hat(wavelength, 450.0) / 0.875);
}

}  // namespace vkcppm::oracle
