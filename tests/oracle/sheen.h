#pragma once
// KHR_materials_sheen with the visibility of Estevez and Kulla 2017, in double precision. alpha is sheenRoughness^2; a
// roughness below 0.07 is as 0.07.

namespace vkcppm::oracle {

/// D V of white sheen, 1/sr, over the largest of 1 and the albedos in both directions: the formula reflects more than
/// arrives where roughness is small and a direction nearly grazing. Cosines of wo, wi and the half vector to the
/// normal, those of wo and wi above 0.
double sheen_value(double cos_o, double cos_i, double cos_h, double alpha);

/// The formula's share of light from everywhere that it reflects to a direction of that cosine: the integral of D V cos
/// over the hemisphere, by Gauss and Legendre's rule, and a spline along the cosine.
double sheen_albedo(double cosine, double alpha);

}  // namespace vkcppm::oracle
