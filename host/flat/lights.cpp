#include "flat/lights.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "flat/alias_table.h"
#include "flat/bounds.h"
#include "flat/environment_light.h"
#include "flat/textured_emitter.h"
#include "flat/weighed_light.h"

namespace vkcppm {
namespace {

using std::numbers::pi;

/// 1 - cos of an angle.
double versine(double angle) { return 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle); }

const gpu::SurfaceMaterial& material_of(const FlatScene& flat, std::uint32_t triangle) {
    return flat.materials[flat.shading[triangle].material & ~SHADING_FLAT];
}

/// Triangles that emit, in the order of the scene: the light that a random number chooses does not hang on the BVH.
std::vector<std::uint32_t> emitters(const FlatScene& flat) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < flat.triangles.size(); ++i) {
        const gpu::SurfaceMaterial& surface = material_of(flat, i);
        if (surface.emission != glm::vec3(0.0f) && !(surface.flags & SURFACE_UNLIT)) found.push_back(i);
    }
    std::ranges::sort(found, {}, [&](std::uint32_t i) { return flat.bvh.order[i]; });
    return found;
}

void add_emitters(const Scene& scene, const FlatScene& flat, std::vector<WeighedLight>& lights) {
    std::vector<MeansOfImages> means(scene.materials.size());
    for (const std::uint32_t i : emitters(flat)) {
        const gpu::SurfaceMaterial& surface = material_of(flat, i);
        const gpu::TriangleGeometry& triangle = flat.triangles[i];
        gpu::Light light{};
        light.kind = LIGHT_TRIANGLE;
        light.position = triangle.v0;
        light.e1 = triangle.e1;
        light.e2 = triangle.e2;
        light.triangle = i;
        light.double_sided = (surface.flags & SURFACE_DOUBLE_SIDED) != 0 ? 1 : 0;
        const double area = 0.5 * glm::length(glm::cross(glm::dvec3(triangle.e1), glm::dvec3(triangle.e2)));
        light.power = glm::vec3(glm::dvec3(surface.emission) * (pi * area * (light.double_sided ? 2.0 : 1.0)));
        const bool is_uneven = surface.texture[TEXTURE_EMISSIVE] != 0 || surface.clearcoat > 0.0f;
        if (is_uneven || (surface.flags & (SURFACE_MASK | SURFACE_BLEND)) != 0) {
            const Triangle source = source_of(scene, flat, i);
            add_textured_emitter(scene, source, light, lights, means[source.material]);
        } else {
            lights.push_back({light, mean_channel(glm::dvec3(light.power))});
        }
    }
}

void add_punctual_lights(const Scene& scene, const FlatScene& flat, std::vector<WeighedLight>& lights) {
    const double scale2 = flat.frame.scale * flat.frame.scale;
    for (const PunctualLight& source : scene.lights) {
        gpu::Light light{};
        const glm::dvec3 intensity(source.intensity);
        light.position = glm::vec3(flat.frame.point(source.position));
        light.e1 = glm::vec3(source.direction);
        // Not 0, which would be without end.
        const float range = source.range > 0.0 ? std::max(FLT_MIN, float(source.range * flat.frame.scale)) : 0.0f;
        light.e2 = glm::vec3(0.0f, 0.0f, range);
        switch (source.kind) {
            case PunctualLight::Kind::point:
                light.kind = LIGHT_POINT;
                light.power = glm::vec3(intensity * (4.0 * pi * scale2));
                break;
            case PunctualLight::Kind::spot: {
                light.kind = LIGHT_SPOT;
                const double inner = versine(source.inner_cone), outer = versine(source.outer_cone);
                light.e2 = glm::vec3(inner, outer, range);
                // Integral of clamp((outer - v) / (outer - inner), 0, 1)^2 over the sphere.
                light.power = glm::vec3(intensity * (2.0 * pi * scale2 * (inner + (outer - inner) / 3.0)));
                break;
            }
            case PunctualLight::Kind::directional: {
                light.kind = LIGHT_DIRECTIONAL;
                const double box = glm::dot(face_areas(flat), glm::abs(source.direction));
                light.power = glm::vec3(intensity * entry_area(flat, box));
                break;
            }
        }
        lights.push_back({light, mean_channel(glm::dvec3(light.power))});
    }
}

/// Points of lights of which a path asks for one, for so many lights of a group: tests/bench/results/transport.md. A
/// square lamp is two triangles, and of one lamp the next point of the sequence is better than a choice.
std::uint32_t candidates(std::size_t lights) { return std::uint32_t(std::clamp<std::size_t>(lights / 2, 1, 4)); }

/// Adds the group of those lights that `is_of` says, where there are any; returns its power.
template <typename IsOf> double add_asked(const std::vector<WeighedLight>& lights, FlatScene& flat, IsOf is_of) {
    std::vector<std::uint32_t> members;
    std::vector<double> weights;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        if (!is_of(lights[i].light.kind)) continue;
        members.push_back(i);
        weights.push_back(lights[i].weight);
    }
    if (members.empty()) return 0.0;
    const AliasTable table(weights);
    flat.asked.push_back({std::uint32_t(flat.asked_lights.size()), std::uint32_t(members.size()),
                          candidates(members.size()), float(table.total)});
    for (std::size_t i = 0; i < members.size(); ++i) {
        flat.asked_lights.push_back({members[i], table.keep[i], members[table.alias[i]], 0});
    }
    return table.total;
}

}  // namespace

void add_lights(const Scene& scene, FlatScene& flat) {
    std::vector<WeighedLight> lights;
    add_punctual_lights(scene, flat, lights);
    add_emitters(scene, flat, lights);
    add_environment(scene, flat, lights);
    std::erase_if(lights, [](const WeighedLight& light) { return !(light.weight > 0.0); });
    if (lights.empty()) return;
    std::vector<double> weights;
    for (const WeighedLight& light : lights) weights.push_back(light.weight);
    const AliasTable table(weights);
    flat.light_power = table.total;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        gpu::Light light = lights[i].light;
        light.power = glm::vec3(glm::dvec3(light.power) * (table.total / lights[i].weight));  // flux / probability
        light.keep = table.keep[i];
        light.alias_entry = table.alias[i];
        flat.lights.push_back(light);
    }
    flat.local_power =
        add_asked(lights, flat, [](auto kind) { return kind != LIGHT_DIRECTIONAL && kind != LIGHT_ENVIRONMENT; });
    add_asked(lights, flat, [](auto kind) { return kind == LIGHT_DIRECTIONAL; });
    flat.environment_power = add_asked(lights, flat, [](auto kind) { return kind == LIGHT_ENVIRONMENT; });
}

}  // namespace vkcppm
