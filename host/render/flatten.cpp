#include "render/flatten.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "render/surface.h"

namespace vkcppm {
namespace {

using std::numbers::pi;

/// Octahedral snorm16x2, as pack_direction of shaders/include/frame.glsl.
std::uint32_t pack_direction(const glm::vec3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 p(n.x / sum, n.y / sum);
    if (n.z < 0.0f) {
        p = glm::vec2((1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                      (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    }
    const auto snorm = [](float x) {
        return std::uint32_t(std::int32_t(std::floor(std::clamp(x, -1.0f, 1.0f) * 32767.0f + 0.5f))) & 0xffffu;
    };
    return snorm(p.x) | snorm(p.y) << 16;
}

SceneFrame make_frame(const Scene& scene) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const Triangle& triangle : scene.triangles) {
        for (const std::uint32_t v : triangle.vertex) {
            low = glm::min(low, scene.positions[v]);
            high = glm::max(high, scene.positions[v]);
        }
    }
    SceneFrame frame;
    if (scene.triangles.empty()) return frame;
    frame.centre = 0.5 * (low + high);
    const double radius = 0.5 * glm::length(high - low);
    if (radius > 0.0) frame.scale = std::exp2(-std::ceil(std::log2(radius)));
    return frame;
}

void add_triangles(const Scene& scene, FlatScene& flat) {
    std::vector<std::array<glm::vec3, 3>> corners(scene.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            corners[i][c] = glm::vec3(flat.frame.point(scene.positions[scene.triangles[i].vertex[c]]));
        }
    }
    flat.bvh = build_bvh(corners);
    flat.low = glm::vec3(corners.empty() ? 0.0f : std::numeric_limits<float>::infinity());
    flat.high = -flat.low;
    for (const std::uint32_t source : flat.bvh.order) {
        const Triangle& triangle = scene.triangles[source];
        const auto& [p0, p1, p2] = corners[source];
        gpu::TriangleGeometry geometry{};
        geometry.v0 = p0;
        geometry.e1 = p1 - p0;
        geometry.e2 = p2 - p0;
        const glm::vec3 extent = glm::abs(geometry.v0) + glm::abs(geometry.e1) + glm::abs(geometry.e2);
        // Rounding of v0 + u e1 + v e2 and of the corners themselves: 8 half-ulps of the largest term.
        geometry.error = 4.8e-7f * std::max({extent.x, extent.y, extent.z});
        // Rounding of s . (d x e2) and d . (s x e1) for |s| = |d| = 1: 12 half-ulps of the longer edge.
        geometry.slack = 7.2e-7f * std::max(glm::length(geometry.e1), glm::length(geometry.e2));
        flat.triangles.push_back(geometry);

        const glm::dvec3 normal = glm::cross(glm::dvec3(geometry.e1), glm::dvec3(geometry.e2));
        const double twice_area = glm::length(normal);
        flat.area += 0.5 * twice_area;
        gpu::TriangleShading shading{};
        bool is_flat = true;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& n = scene.normals[triangle.vertex[c]];
            shading.normal[c] = pack_direction(n);
            is_flat = is_flat && (twice_area == 0.0 || glm::length(glm::dvec3(n) - normal / twice_area) < 1e-4);
        }
        shading.material = triangle.material | (is_flat ? SHADING_FLAT : 0u);
        flat.shading.push_back(shading);

        const std::uint32_t kind = flat.materials[triangle.material].kind & ~SURFACE_DOUBLE_SIDED;
        if (kind == SURFACE_MIRROR) flat.features |= FEATURE_MIRROR;
        if (kind == SURFACE_DIELECTRIC) flat.features |= FEATURE_DIELECTRIC;
        if (kind == SURFACE_DIFFUSE && !is_flat) flat.features |= FEATURE_SMOOTH_DIFFUSE;
        for (const glm::vec3& p : corners[source]) {
            flat.low = glm::min(flat.low, p);
            flat.high = glm::max(flat.high, p);
            flat.radius = std::max(flat.radius, double(glm::length(p)));
        }
    }
    flat.low -= 1e-5f;
    flat.high += 1e-5f;
}

double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// Lights with `power` set to their flux, in frame units (W times scale^2).
std::vector<gpu::Light> collect_lights(const Scene& scene, const FlatScene& flat) {
    std::vector<gpu::Light> lights;
    for (std::size_t i = 0; i < flat.triangles.size(); ++i) {
        const gpu::SurfaceMaterial& material = flat.materials[flat.shading[i].material & ~SHADING_FLAT];
        if (material.emission == glm::vec3(0.0f)) continue;
        const gpu::TriangleGeometry& triangle = flat.triangles[i];
        gpu::Light light{};
        light.kind = LIGHT_TRIANGLE;
        light.position = triangle.v0;
        light.e1 = triangle.e1;
        light.e2 = triangle.e2;
        light.double_sided = (material.kind & SURFACE_DOUBLE_SIDED) != 0 ? 1 : 0;
        const double area = 0.5 * glm::length(glm::cross(glm::dvec3(triangle.e1), glm::dvec3(triangle.e2)));
        light.power = glm::vec3(glm::dvec3(material.emission) * (pi * area * (light.double_sided ? 2.0 : 1.0)));
        lights.push_back(light);
    }
    const double scale2 = flat.frame.scale * flat.frame.scale;
    for (const PunctualLight& source : scene.lights) {
        gpu::Light light{};
        const glm::dvec3 intensity(source.intensity);
        light.position = glm::vec3(flat.frame.point(source.position));
        light.e1 = glm::vec3(source.direction);
        switch (source.kind) {
            case PunctualLight::Kind::point:
                light.kind = LIGHT_POINT;
                light.power = glm::vec3(intensity * (4.0 * pi * scale2));
                break;
            case PunctualLight::Kind::spot: {
                light.kind = LIGHT_SPOT;
                const double inner = std::cos(source.inner_cone), outer = std::cos(source.outer_cone);
                light.e2 = glm::vec3(inner, outer, 0.0);
                // Integral of clamp((c - outer) / (inner - outer), 0, 1)^2 over the sphere.
                light.power = glm::vec3(intensity * (2.0 * pi * scale2 * ((1.0 - inner) + (inner - outer) / 3.0)));
                break;
            }
            case PunctualLight::Kind::directional: {
                light.kind = LIGHT_DIRECTIONAL;
                const double radius = flat.radius * 1.001;
                light.position = glm::vec3(source.direction * (-1.5 * radius));
                light.e2 = glm::vec3(radius, 0.0, 0.0);
                light.power = glm::vec3(intensity * (pi * radius * radius));
                break;
            }
        }
        lights.push_back(light);
    }
    std::erase_if(lights, [](const gpu::Light& light) { return !(mean(light.power) > 0.0); });
    return lights;
}

/// Alias table (Walker 1974, Vose 1991) in proportion to the mean channel of the power; then `power` becomes flux over
/// probability: what one path carries.
void make_alias_table(std::vector<gpu::Light>& lights) {
    double total = 0.0;
    for (const auto& light : lights) total += mean(light.power);
    std::vector<double> share(lights.size());
    std::vector<std::uint32_t> small, large;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const double probability = mean(lights[i].power) / total;
        share[i] = probability * double(lights.size());
        lights[i].power = glm::vec3(glm::dvec3(lights[i].power) / probability);
        lights[i].keep = 1.0f;
        lights[i].alias_entry = i;
        (share[i] < 1.0 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        lights[poor].keep = float(share[poor]);
        lights[poor].alias_entry = rich;
        share[rich] -= 1.0 - share[poor];
        if (share[rich] < 1.0) {
            large.pop_back();
            small.push_back(rich);
        }
    }
}

/// One line for each kind of thing that is left out, with the materials' names.
std::vector<std::string> omissions(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Triangle& triangle : scene.triangles) used[triangle.material] = true;
    std::map<std::string, std::vector<std::string>> by_kind;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!used[i]) continue;
        if (const auto missing = left_out(scene.materials[i])) by_kind[*missing].push_back(scene.materials[i].name);
    }
    std::vector<std::string> lines;
    for (const auto& [missing, names] : by_kind) {
        const std::string more = names.size() > 3 ? fmt::format(" and {} more", names.size() - 3) : "";
        const std::vector<std::string> shown(names.begin(), names.begin() + std::min<std::size_t>(3, names.size()));
        lines.push_back(fmt::format("left out of material '{}'{}: {}", fmt::join(shown, "', '"), more, missing));
    }
    return lines;
}

}  // namespace

FlatScene flatten(const Scene& scene) {
    FlatScene flat;
    flat.frame = make_frame(scene);
    for (const Material& material : scene.materials) flat.materials.push_back(surface_of(material));
    add_triangles(scene, flat);
    flat.lights = collect_lights(scene, flat);
    make_alias_table(flat.lights);
    flat.warnings = omissions(scene);
    if (flat.lights.empty()) flat.warnings.push_back("the scene has no light: the picture is black");
    if (scene.triangles.empty()) flat.warnings.push_back("the scene has no triangles: the picture is black");
    return flat;
}

}  // namespace vkcppm
