#pragma once
// KHR_materials_dispersion and the colours of single wavelengths.

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

inline constexpr double shortest_wavelength = 400.0, longest_wavelength = 700.0;  // nm

/// Index at a wavelength in nm by Cauchy's n = A + B / l^2 through n(587.6 nm) = `ior` with Abbe number
/// (n_d - 1) / (n_F - n_C) = 20 / `dispersion`. Fraunhofer's lines d, F, C: 587.6, 486.1, 656.3 nm.
double ior_at(double ior, double dispersion, double wavelength);

/// What a path of one wavelength in nm carries of red, green and blue: triangles about 650, 550, 450 nm of half width
/// 100 nm, cut to the range, each with mean 1 over it.
glm::dvec3 wavelength_color(double wavelength);

}  // namespace vkcppm::oracle
