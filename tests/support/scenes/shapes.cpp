#include "support/scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <glm/geometric.hpp>

#include "support/scenes/materials.h"

namespace vkcppm::test {
namespace {

/// Walls of [0, 2]^3 that face inwards, and a lamp of 0.5 x 0.5 under the ceiling that faces down.
void add_walls(Scene& scene, std::uint32_t left, std::uint32_t right, std::uint32_t rest, const glm::vec3& radiance) {
    add_quad(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, left);
    add_quad(scene, {2, 0, 0}, {0, 0, 2}, {0, 2, 0}, right);
    add_quad(scene, {0, 0, 0}, {0, 0, 2}, {2, 0, 0}, rest);
    add_quad(scene, {0, 2, 0}, {2, 0, 0}, {0, 0, 2}, rest);
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, rest);
    add_quad(scene, {0, 0, 2}, {0, 2, 0}, {2, 0, 0}, rest);
    add_quad(scene, {0.75, 1.98, 0.75}, {0.5, 0, 0}, {0, 0, 0.5}, add_material(scene, emitter(radiance)));
}

}  // namespace

std::uint32_t add_material(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return std::uint32_t(scene.materials.size() - 1);
}

void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, std::uint32_t material) {
    const auto first = std::uint32_t(scene.positions.size());
    const glm::dvec3 cross = glm::cross(b - a, c - a);
    const double twice_area = glm::length(cross);
    for (const glm::dvec3& corner : {a, b, c}) {
        scene.positions.push_back(corner);
        scene.normals.push_back(twice_area > 0.0 ? glm::vec3(cross / twice_area) : glm::vec3(0.0f, 0.0f, 1.0f));
    }
    scene.triangles.push_back({{first, first + 1, first + 2}, material});
}

void add_quad(Scene& scene, const glm::dvec3& corner, const glm::dvec3& side1, const glm::dvec3& side2,
              std::uint32_t material) {
    add_triangle(scene, corner, corner + side1, corner + side1 + side2, material);
    add_triangle(scene, corner, corner + side1 + side2, corner + side2, material);
}

void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t material, bool inwards) {
    const glm::dvec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0.0), u(0.0), v(0.0);
        normal[axis] = size[axis];
        u[(axis + 1) % 3] = size[(axis + 1) % 3];
        v[(axis + 2) % 3] = size[(axis + 2) % 3];
        add_quad(scene, low, inwards ? u : v, inwards ? v : u, material);
        add_quad(scene, low + normal, inwards ? v : u, inwards ? u : v, material);
    }
}

void add_sphere(Scene& scene, const glm::dvec3& centre, double radius, int levels, std::uint32_t material,
                bool smooth) {
    const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
    std::vector<glm::dvec3> points;
    for (const double one : {-1.0, 1.0}) {
        for (const double phi : {-golden, golden}) {
            points.insert(points.end(), {{0, one, phi}, {one, phi, 0}, {phi, 0, one}});
        }
    }
    for (glm::dvec3& p : points) p = glm::normalize(p);
    // Faces of the icosahedron: triples of mutual neighbours.
    std::vector<std::array<std::size_t, 3>> faces;
    const double edge = 1.0515;  // of the icosahedron in the unit sphere, rounded up
    const auto near = [&](std::size_t i, std::size_t j) { return glm::distance(points[i], points[j]) < edge; };
    for (std::size_t i = 0; i < 12; ++i) {
        for (std::size_t j = i + 1; j < 12; ++j) {
            for (std::size_t k = j + 1; k < 12; ++k) {
                if (!near(i, j) || !near(j, k) || !near(i, k)) continue;
                const bool outwards =
                    glm::dot(glm::cross(points[j] - points[i], points[k] - points[i]), points[i]) > 0.0;
                faces.push_back(outwards ? std::array{i, j, k} : std::array{i, k, j});
            }
        }
    }
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
        const auto middle = [&](std::size_t i, std::size_t j) {
            const auto [place, fresh] = middles.try_emplace(std::minmax(i, j), points.size());
            if (fresh) points.push_back(glm::normalize(points[i] + points[j]));
            return place->second;
        };
        std::vector<std::array<std::size_t, 3>> finer;
        for (const auto& [i, j, k] : faces) {
            const std::size_t a = middle(i, j), b = middle(j, k), c = middle(k, i);
            for (const auto& face :
                 {std::array{i, a, c}, std::array{a, j, b}, std::array{c, b, k}, std::array{a, b, c}}) {
                finer.push_back(face);
            }
        }
        faces = finer;
    }
    for (const auto& [i, j, k] : faces) {
        add_triangle(scene, centre + radius * points[i], centre + radius * points[j], centre + radius * points[k],
                     material);
        if (!smooth) continue;
        for (const auto& [corner, point] : {std::pair(3, i), std::pair(2, j), std::pair(1, k)}) {
            scene.normals[scene.normals.size() - corner] = glm::vec3(points[point]);
        }
    }
}

void add_point_light(Scene& scene, const glm::dvec3& position, const glm::vec3& intensity) {
    PunctualLight light;
    light.position = position;
    light.intensity = intensity;
    scene.lights.push_back(light);
}

void add_spot_light(Scene& scene, const glm::dvec3& position, const glm::dvec3& direction, double outer_cone,
                    const glm::vec3& intensity) {
    PunctualLight light;
    light.kind = PunctualLight::Kind::spot;
    light.position = position;
    light.direction = direction;
    light.outer_cone = outer_cone;
    light.intensity = intensity;
    scene.lights.push_back(light);
}

void add_directional_light(Scene& scene, const glm::dvec3& direction, const glm::vec3& irradiance) {
    PunctualLight light;
    light.kind = PunctualLight::Kind::directional;
    light.direction = direction;
    light.intensity = irradiance;
    scene.lights.push_back(light);
}

void add_camera(Scene& scene, const glm::dvec3& eye, const glm::dvec3& target, double yfov) {
    Camera camera;
    const glm::dvec3 back = glm::normalize(eye - target);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
    camera.to_world[0] = glm::dvec4(right, 0.0);
    camera.to_world[1] = glm::dvec4(glm::cross(back, right), 0.0);
    camera.to_world[2] = glm::dvec4(back, 0.0);
    camera.to_world[3] = glm::dvec4(eye, 1.0);
    camera.yfov = yfov;
    scene.cameras.push_back(camera);
}

Scene room() {
    Scene scene;
    const std::uint32_t white = add_material(scene, lambert({0.75f, 0.75f, 0.75f}));
    add_walls(scene, add_material(scene, lambert({0.7f, 0.2f, 0.1f})),
              add_material(scene, lambert({0.15f, 0.3f, 0.7f})), white, {20.0f, 18.0f, 15.0f});
    add_sphere(scene, {0.55, 0.45, 0.8}, 0.35, 3, add_material(scene, glass(1.5f)), true);
    add_sphere(scene, {1.45, 0.4, 0.9}, 0.3, 2, white, true);
    add_box(scene, {0.9, 0.0, 1.3}, {1.3, 0.5, 1.6}, white, false);
    add_quad(scene, {1.2, 0.3, 0.2}, {0.6, 0.0, 0.25}, {0.0, 1.0, 0.1},
             add_material(scene, mirror({0.9f, 0.8f, 0.6f})));
    PunctualLight point;
    point.intensity = glm::vec3(0.8f, 0.9f, 1.0f);
    point.position = {0.4, 1.5, 1.5};
    scene.lights.push_back(point);
    PunctualLight spot;
    spot.kind = PunctualLight::Kind::spot;
    spot.intensity = glm::vec3(6.0f, 3.0f, 2.0f);
    spot.position = {1.7, 1.7, 1.7};
    spot.direction = glm::normalize(glm::dvec3(-1.0, -1.1, -0.9));
    spot.inner_cone = 0.2;
    spot.outer_cone = 0.4;
    scene.lights.push_back(spot);
    add_camera(scene, {1.0, 1.0, 1.95}, {1.0, 0.8, 0.0}, 1.3);
    return scene;
}

Scene bare_room(float albedo) {
    Scene scene;
    const std::uint32_t wall = add_material(scene, lambert(glm::vec3(albedo)));
    add_walls(scene, wall, wall, wall, {5.0f, 5.0f, 5.0f});
    scene.materials.back().base_color = glm::vec3(albedo);
    add_camera(scene, {1.0, 1.0, 1.95}, {1.0, 0.8, 0.0}, 1.3);
    return scene;
}

Scene photon_plane() {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(glm::vec3(1.0f))));
    add_point_light(scene, {0, 0, 1}, glm::vec3(1.0f));  // never traced: without a light there would be no photon lanes
    add_camera(scene, {0, 0, 2}, {0, 0, 0}, 1.0);
    return scene;
}

}  // namespace vkcppm::test
