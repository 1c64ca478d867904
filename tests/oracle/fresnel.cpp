#include "oracle/fresnel.h"

#include <cmath>

namespace vkcppm::oracle {

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

}  // namespace vkcppm::oracle
