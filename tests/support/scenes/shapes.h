#pragma once
// Scenes built in code: a few shapes of the materials of materials.h, and a room that has one of everything.

#include <cstdint>

#include <glm/vec3.hpp>

#include "scene/scene.h"
#include "support/scenes/materials.h"

namespace vkcppm::test {

/// Adds the material and returns its index.
std::uint32_t add_material(Scene& scene, const Material& material);

/// Flat; the front is the side from which a, b, c run counter-clockwise.
void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, std::uint32_t material);

/// The parallelogram corner + u side1 + v side2; its front is towards cross(side1, side2).
void add_quad(Scene& scene, const glm::dvec3& corner, const glm::dvec3& side1, const glm::dvec3& side2,
              std::uint32_t material);

/// Six faces with their fronts outwards, or inwards.
void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t material, bool inwards);

/// An icosahedron whose triangles are cut in four `levels` times: 20 * 4^levels triangles with shared positions.
/// `smooth`: shading normals of the sphere, else of the facets.
void add_sphere(Scene& scene, const glm::dvec3& centre, double radius, int levels, std::uint32_t material, bool smooth);

/// intensity: W sr^-1.
void add_point_light(Scene& scene, const glm::dvec3& position, const glm::vec3& intensity);

/// direction: unit; outer_cone: rad, from the axis, where the light ends.
void add_spot_light(Scene& scene, const glm::dvec3& position, const glm::dvec3& direction, double outer_cone,
                    const glm::vec3& intensity);

/// direction: unit; irradiance across it: W m^-2.
void add_directional_light(Scene& scene, const glm::dvec3& direction, const glm::vec3& irradiance);

void add_camera(Scene& scene, const glm::dvec3& eye, const glm::dvec3& target, double yfov);

/// A closed room [0, 2]^3: a lamp under the ceiling, a point and a spot light, a glass sphere, a diffuse sphere with
/// smooth normals, a tilted mirror, a box; one camera that sees them all.
Scene room();

/// The same with flat diffuse surfaces only, all albedos `albedo`: nothing but the lamp and the walls.
Scene bare_room(float albedo);

/// The square [-1, 1]^2 at z = 0 for photons that do not come from lights, seen from above.
Scene photon_plane();

}  // namespace vkcppm::test
