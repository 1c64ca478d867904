#pragma once
// What a path meets: the surface at a hit, with its textures, and how it scatters.

#include <glm/vec3.hpp>

#include "oracle/bsdf.h"
#include "oracle/intersect.h"
#include "scene/scene.h"

namespace vkcppm::oracle {

/// The pure cases: Lambert (metallic 0, specular 0, transmission 0), mirror (metallic 1, roughness 0), solid clear
/// glass (transmission 1, roughness 0, thickness > 0), all without a coat; and everything else.
enum class Scattering { lambert, mirror, glass, mixed };

/// Normals are turned to the side that the path arrived from: the shading normals with the sign that brings the
/// interpolated normal of the vertices into the hemisphere of the geometric one.
struct Surface {
    glm::dvec3 position;          // m
    glm::dvec3 geometric_normal;  // unit
    glm::dvec3 shading_normal;    // unit, with the normal texture
    bool front = true;            // the path arrived on the counter-clockwise side
    Scattering scattering = Scattering::lambert;
    glm::dvec3 base_color{1.0};  // with texture and vertex colours
    double ior = 1.5;
    glm::dvec3 emission{0.0};  // radiance towards the path; zero behind a one-sided emitter, and of unlit
    Bsdf bsdf;
};

/// `direction`: unit, the way the path travels.
Surface surface_at(const Scene& scene, const Hit& hit, const glm::dvec3& direction);

/// Whether a surface is there, 0 to 1: its alpha where that blends, 0 or 1 where it is masked.
double coverage(const Scene& scene, const Hit& hit);

/// Absorption coefficient behind a surface with a volume, 1/m: -ln(attenuation colour) / attenuation distance.
/// Infinite where the colour is black.
glm::dvec3 absorption(const Material& material);

/// A ray that leaves the surface, started off it on the side it goes to.
Ray leave(const Surface& surface, const glm::dvec3& direction);

}  // namespace vkcppm::oracle
