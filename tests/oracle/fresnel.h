#pragma once
// Reflectances, in the angle form of Fresnel's own equations (the GPU has the cosine form).

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

/// Reflectance of unpolarised light at a smooth dielectric: Rs = sin^2(i - t) / sin^2(i + t),
/// Rp = tan^2(i - t) / tan^2(i + t). `cosine` = cos(i) in [0, 1], `ior_ratio` = index behind / index before the face.
/// 1 where the reflection is total.
double fresnel_dielectric(double cosine, double ior_ratio);

/// Schlick's approximation: f0 + (f90 - f0)(1 - cosine)^5, `cosine` in [0, 1].
glm::dvec3 fresnel_schlick(const glm::dvec3& f0, double f90, double cosine);

/// glTF's metal (Schlick): base + (1 - base)(1 - cosine)^5.
glm::dvec3 fresnel_metal(const glm::dvec3& base, double cosine);

/// KHR_materials_iridescence: of a film of that index and thickness (nm) on a base of reflectance f0 at normal
/// incidence, whose index follows from it; faces reflect by Schlick. `cosine` is outside. Light goes `orders` times to
/// and fro in the film (without end: Airy's sum). For each channel the quadrature over wave numbers with its
/// sensitivity, the Gaussians of Belcour and Barla 2017 turned to sRGB, over what the channel has of white; in [0, 1].
inline constexpr int endless = -1;
glm::dvec3 fresnel_film(const glm::dvec3& f0, double cosine, double index, double thickness, int orders = 4);

}  // namespace vkcppm::oracle
