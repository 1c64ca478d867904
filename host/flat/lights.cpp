#include "flat/lights.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "flat/alias_table.h"
#include "flat/bounds.h"
#include "flat/environment_light.h"
#include "flat/light_tree.h"
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

/// Points of lights of which a path asks for one, for so many lights of a group without a tree:
/// tests/bench/results/transport.md. A square lamp is two triangles, and of one lamp the next point of the sequence is
/// better than a choice.
std::uint32_t candidates_of(std::size_t lights) { return std::uint32_t(std::clamp<std::size_t>(lights / 2, 1, 4)); }

/// Likewise of the lamps of a tree, and of an environment: about half of its points are below a surface's horizon.
constexpr std::uint32_t candidates_of_tree = 2, candidates_of_environment = 4;

/// Adds an alias table of those lights; returns their power.
double add_asked(const std::vector<WeighedLight>& lights, std::span<const std::uint32_t> members, FlatScene& flat) {
    std::vector<double> weights;
    for (const std::uint32_t i : members) weights.push_back(lights[i].weight);
    const AliasTable table(weights);
    for (std::size_t i = 0; i < members.size(); ++i) {
        flat.asked_lights.push_back({members[i], table.keep[i], members[table.alias[i]], float(table.total)});
    }
    return table.total;
}

/// Adds the group of those lights, where there are any, as one lamp; returns its power.
double add_group(const std::vector<WeighedLight>& lights, const std::vector<std::uint32_t>& members,
                 std::uint32_t candidates, FlatScene& flat) {
    if (members.empty()) return 0.0;
    flat.asked.push_back({std::uint32_t(flat.asked_lights.size()), std::uint32_t(members.size()), candidates, 0});
    return add_asked(lights, members, flat);
}

/// True of two triangles of one material, in one plane, with an edge in common: a quadrilateral, such as a square lamp.
bool are_one_face(const Scene& scene, const FlatScene& flat, const gpu::Light& a, const gpu::Light& b) {
    const Triangle p = source_of(scene, flat, a.triangle), q = source_of(scene, flat, b.triangle);
    if (p.material != q.material) return false;
    const glm::dvec3 normal_a = glm::normalize(glm::cross(glm::dvec3(a.e1), glm::dvec3(a.e2)));
    const glm::dvec3 normal_b = glm::normalize(glm::cross(glm::dvec3(b.e1), glm::dvec3(b.e2)));
    constexpr double nearly_flat = 1e-6;  // 1 - cos, by which an edge of two triangles is bent
    if (!(glm::dot(normal_a, normal_b) > 1.0 - nearly_flat)) return false;
    int common = 0;
    for (const std::uint32_t v : p.vertex) {
        common += std::ranges::any_of(q.vertex, [&](auto w) { return scene.positions[v] == scene.positions[w]; });
    }
    return common == 2;
}

/// The local lights, lamp by lamp: parts of a textured triangle are one, and two triangles of a quadrilateral, the one
/// after the other in the scene.
std::vector<std::span<const std::uint32_t>> lamps_of(const Scene& scene, const FlatScene& flat,
                                                     const std::vector<WeighedLight>& lights,
                                                     std::span<const std::uint32_t> local) {
    std::vector<std::span<const std::uint32_t>> lamps;
    std::size_t first = 0;
    for (std::size_t next = 1; next <= local.size(); ++next) {
        if (next < local.size()) {
            const gpu::Light& begins = lights[local[first]].light;
            const gpu::Light& light = lights[local[next]].light;
            const bool are_triangles = begins.kind == LIGHT_TRIANGLE && light.kind == LIGHT_TRIANGLE;
            if (are_triangles && begins.triangle == light.triangle) continue;
            const bool are_two = next == first + 1 && begins.textured == 0 && light.textured == 0;
            if (are_triangles && are_two && are_one_face(scene, flat, begins, light)) continue;
        }
        lamps.push_back(local.subspan(first, next - first));
        first = next;
    }
    return lamps;
}

/// What the light tree knows of a lamp.
Lamp lamp_of(const std::vector<WeighedLight>& lights, std::span<const std::uint32_t> members) {
    Lamp lamp;
    for (const std::uint32_t i : members) {
        const auto& [light, power] = lights[i];
        double solid_angle = 4.0 * pi;  // power over intensity
        lamp.low = glm::min(lamp.low, light.position);
        lamp.high = glm::max(lamp.high, light.position);
        if (light.kind == LIGHT_TRIANGLE) {
            for (const glm::vec3& corner : {light.position + light.e1, light.position + light.e2}) {
                lamp.low = glm::min(lamp.low, corner);
                lamp.high = glm::max(lamp.high, corner);
            }
            lamp.axis = glm::vec3(glm::normalize(glm::cross(glm::dvec3(light.e1), glm::dvec3(light.e2))));
            lamp.falloff = float(0.5 * pi);
            lamp.both_sides = light.double_sided != 0;
            lamp.reach = FAR;
            solid_angle = lamp.both_sides ? 2.0 * pi : pi;
        } else {
            lamp.reach = light.e2.z > 0.0f ? light.e2.z : FAR;
            lamp.spread = float(pi);
            if (light.kind == LIGHT_SPOT) {
                const double inner = light.e2.x, outer = light.e2.y;  // versines
                lamp.axis = light.e1;
                lamp.spread = float(2.0 * std::asin(std::sqrt(0.5 * inner)));
                lamp.falloff = float(2.0 * std::asin(std::sqrt(0.5 * outer))) - lamp.spread;
                solid_angle = 2.0 * pi * (inner + (outer - inner) / 3.0);
            }
        }
        lamp.intensity += power / solid_angle;
    }
    return lamp;
}

/// Adds the group of local lights, where there are any: one lamp, or a tree of them. Returns its power.
double add_local_lights(const Scene& scene, const std::vector<WeighedLight>& lights,
                        const std::vector<std::uint32_t>& local, FlatScene& flat) {
    const std::vector<std::span<const std::uint32_t>> members = lamps_of(scene, flat, lights, local);
    if (members.size() < 2) return add_group(lights, local, candidates_of(local.size()), flat);
    std::vector<Lamp> lamps;
    double power = 0.0;
    const auto first = std::uint32_t(flat.asked_lights.size());
    for (const std::span<const std::uint32_t> of_lamp : members) {
        Lamp& lamp = lamps.emplace_back(lamp_of(lights, of_lamp));
        lamp.first = std::uint32_t(flat.asked_lights.size());
        lamp.count = std::uint32_t(of_lamp.size());
        power += add_asked(lights, of_lamp, flat);
    }
    LightTree tree = build_light_tree(lamps);
    flat.asked.push_back({first, std::uint32_t(local.size()), candidates_of_tree, tree.depth});
    flat.light_tree = std::move(tree.branches);
    flat.lamps.assign(flat.triangles.size(), NO_LAMP);
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (const std::uint32_t light : members[i]) {
            if (lights[light].light.kind == LIGHT_TRIANGLE) flat.lamps[lights[light].light.triangle] = tree.lamps[i];
        }
    }
    return power;
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
    std::vector<std::uint32_t> local, directional, environment;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const std::uint32_t kind = lights[i].light.kind;
        (kind == LIGHT_DIRECTIONAL ? directional : kind == LIGHT_ENVIRONMENT ? environment : local).push_back(i);
    }
    flat.local_power = add_local_lights(scene, lights, local, flat);
    add_group(lights, directional, candidates_of(directional.size()), flat);
    flat.environment_power = add_group(lights, environment, candidates_of_environment, flat);
}

}  // namespace vkcppm
