#pragma once
// What a path meets: the surface at a hit and how it scatters.

#include <random>

#include <glm/vec3.hpp>

#include "reference/intersect.h"
#include "scene/scene.h"

namespace vkcppm::reference {

enum class Scattering { lambert, mirror, glass };

/// Throws std::invalid_argument with the material's name where it is neither pure Lambert (metallic 0, specular 0,
/// transmission 0), nor mirror (metallic 1, roughness 0), nor solid clear glass (transmission 1, thickness > 0).
Scattering scattering(const Material& material);

/// Normals are turned to the side that the path arrived from.
struct Surface {
    glm::dvec3 position;                   // m
    glm::dvec3 geometric_normal;           // unit
    glm::dvec3 shading_normal;             // unit, in the hemisphere of the geometric one
    bool front = true;                     // the path arrived on the counter-clockwise side
    Scattering scattering = Scattering::lambert;
    glm::dvec3 base_color{1.0};
    double ior = 1.5;
    glm::dvec3 emission{0.0};              // radiance towards the path; zero behind a one-sided emitter
};

/// `direction`: unit, the way the path travels.
Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction);

/// Uniform in [0, 1).
double uniform(std::mt19937_64& random);

/// A new direction and the factor f cos / pdf on the path's radiance (eye paths). Glass chooses reflection with
/// probability F. Radiance is not scaled by the squared index: paths start and end in air. Weight zero: absorbed.
struct Scatter {
    glm::dvec3 direction;                  // unit
    glm::dvec3 weight;
};
Scatter sample_scatter(const Surface& surface, const glm::dvec3& direction, std::mt19937_64& random);

/// A ray that leaves the surface, started off it on the side it goes to.
Ray leave(const Surface& surface, const glm::dvec3& direction);

}  // namespace vkcppm::reference
