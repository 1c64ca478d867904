// Scenes of any number of triangles, and renders of them.

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "bench/speed.h"
#include "render/render.h"
#include "support/scenes/shapes.h"

namespace vkcppm::bench {
namespace {

using std::numbers::pi;
using test::add_triangle;

/// A sphere of 2 steps^2 triangles whose radius swings by a fourth.
void add_bumpy_sphere(Scene& scene, const glm::dvec3& centre, double radius, int steps, std::uint32_t material) {
    const auto at = [&](int i, int j) {
        const double theta = pi * i / steps, phi = 2.0 * pi * j / steps;
        const double bumps = 1.0 + 0.2 * std::sin(5.0 * theta) * std::cos(7.0 * phi) +
                             0.05 * std::sin(31.0 * theta) * std::sin(23.0 * phi);
        return centre +
               radius * bumps *
                   glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            add_triangle(scene, at(i, j), at(i, j + 1), at(i + 1, j + 1), material);
            add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i + 1, j), material);
        }
    }
}

}  // namespace

Scene bumpy_room(std::uint32_t triangles) {
    Scene scene = test::bare_room(0.7f);
    const int steps = std::max(3, int(std::lround(std::sqrt(triangles / 16.0))));
    const std::uint32_t material = test::add_material(scene, test::lambert(glm::vec3(0.6f)));
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 centre(i & 1 ? 1.45 : 0.55, i & 2 ? 1.35 : 0.45, i & 4 ? 1.5 : 0.6);
        add_bumpy_sphere(scene, centre, 0.25 + 0.01 * i, steps, material);
    }
    return scene;
}

Scene soup(std::uint32_t triangles) {
    Scene scene;
    test::add_material(scene, test::lambert(glm::vec3(0.5f)));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    const double size = 3.0 / std::sqrt(double(triangles));
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const glm::dvec3 centre = point();
        const glm::dvec3 a = centre + size * point(), b = centre + size * point(), c = centre + size * point();
        add_triangle(scene, a, b, c, 0);
    }
    return scene;
}

std::vector<std::array<glm::vec3, 3>> corners_of(const FlatScene& flat) {
    std::vector<std::array<glm::vec3, 3>> corners;
    for (const gpu::TriangleGeometry& t : flat.triangles) corners.push_back({t.v0, t.v0 + t.e1, t.v0 + t.e2});
    return corners;
}

Render::Render(Device& device, Scene scene, const Settings& wanted)
    : scene_(std::move(scene)),
      settings_(resolve_settings(wanted, scene_)),
      flat_(flatten(scene_)),
      on_device_(device, flat_),
      integrator_(on_device_, camera_of(settings_, scene_), settings_) {
    integrator_.fill(report_);
}

void Render::run(std::uint32_t count) {
    Report before;
    integrator_.fill(before);
    const double cpu = cpu_now(), device = integrator_.seconds();
    integrator_.run(count);
    least_.keep({(integrator_.seconds() - device) / count, (cpu_now() - cpu) / count});
    integrator_.fill(report_);
    for (const PassReport& pass : report_.passes) {
        const auto same = [&](const PassReport& other) { return other.name == pass.name; };
        const auto old = std::ranges::find_if(before.passes, same);
        const double begun = old == before.passes.end() ? 0.0 : old->device_seconds;
        const double seconds = (pass.device_seconds - begun) / count;
        const auto entry = std::ranges::find_if(passes_, same);
        if (entry == passes_.end()) {
            passes_.push_back({pass.name, 1, seconds});
        } else {
            entry->device_seconds = std::min(entry->device_seconds, seconds);
        }
    }
}

}  // namespace vkcppm::bench
