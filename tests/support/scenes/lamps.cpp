#include "support/scenes/lamps.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "support/scenes/shapes.h"

namespace vkcppm::test {

Scene lamps_of_every_kind(std::uint32_t count, double decades, std::uint32_t seed) {
    Scene scene;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
    for (std::uint32_t i = 0; i < count; ++i) {
        const double power = std::pow(10.0, decades * uniform(random));
        const glm::dvec3 place = vector(), direction = glm::normalize(vector());
        const glm::dvec3 side = 0.03 * glm::normalize(glm::cross(direction, glm::dvec3(0.36, 0.48, 0.8)));
        const glm::dvec3 other = glm::cross(direction, side);
        switch (i % 5) {
            case 0: add_point_light(scene, place, glm::vec3(float(power))); break;
            case 1:
                add_spot_light(scene, place, direction, 0.2 + 0.5 * (1.0 + uniform(random)), glm::vec3(float(power)));
                break;
            case 2:
                add_quad(scene, place, side, other, add_material(scene, emitter(glm::vec3(float(1000.0 * power)))));
                break;
            case 3:
                add_triangle(scene, place, place + side, place + other,
                             add_material(scene, emitter(glm::vec3(float(1000.0 * power)), true)));
                break;
            default:
                add_triangle(scene, place, place + side, place + other,
                             add_material(scene, emitter(glm::vec3(float(1000.0 * power)))));
        }
        if (i % 10 < 2) scene.lights.back().range = 0.5;
    }
    return scene;
}

Scene many_lamp_room(std::uint32_t count) {
    Scene scene;
    add_box(scene, {-2, 0, -1}, {2, 2, 1}, add_material(scene, lambert(glm::vec3(0.6f, 0.5f, 0.4f))), true);
    add_box(scene, {0.2, 0, -0.4}, {0.8, 0.6, 0.2}, add_material(scene, lambert(glm::vec3(0.4f, 0.5f, 0.6f))), false);
    const std::uint32_t dim = add_material(scene, emitter(glm::vec3(10.0f)));
    const std::uint32_t bright = add_material(scene, emitter(glm::vec3(1000.0f)));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const double x = 3.8 * uniform(random) - 1.9, z = 1.8 * uniform(random) - 0.9;
        add_quad(scene, {x, 1.98, z}, {0.06, 0, 0}, {0, 0, 0.06}, i % 3 == 0 ? bright : dim);
    }
    add_camera(scene, {-1.8, 1.0, 0.7}, {0.6, 0.5, -0.2}, 1.0);
    return scene;
}

Scene lamps_over_metal(float roughness) {
    Scene scene;
    Material metal = mirror(glm::vec3(0.6f, 0.7f, 0.8f));
    metal.roughness = roughness;
    add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, metal));
    for (int i = 0; i < 9; ++i) {
        const glm::dvec3 corner(1.2 * (i % 3 - 1) - 0.2, 0.6 + 0.05 * i, 1.2 * (i / 3 - 1) - 0.2);
        add_quad(scene, corner, {0.4, 0, 0}, {0, 0, 0.4}, add_material(scene, emitter(glm::vec3(float(1 + i)))));
    }
    add_camera(scene, {0, 0.5, 2.5}, {0, 0, 0.3}, 0.7);
    return scene;
}

}  // namespace vkcppm::test
