#include "support/scenes/instanced.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/instances.h"

namespace vkcppm::test {
namespace {

using nlohmann::json;

json material(const json& color, double emission) {
    json m = {{"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0.0}}},
              {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.0}}}}}};
    if (emission > 0.0) {
        m["emissiveFactor"] = {1.0, 1.0, 1.0};
        m["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", emission}};
    }
    return m;
}

int bumpy_sphere(GltfBuilder& builder, std::uint32_t wanted) {
    const auto side = std::uint32_t(std::max(3.0, std::round(std::sqrt(0.5 * wanted))));
    const std::uint32_t columns = side, rows = side < 4 ? 2 : side + 1;
    std::vector<Float3> positions{{0.0f, 1.0f, 0.0f}}, normals{{0.0f, 1.0f, 0.0f}};
    for (std::uint32_t row = 1; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const double theta = std::numbers::pi * row / rows, phi = 2.0 * std::numbers::pi * column / columns;
            const Float3 n = {float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                              float(std::sin(theta) * std::sin(phi))};
            const double bump = std::sin(theta) * std::sin(theta) * std::sin(7.0 * theta) * std::sin(5.0 * phi);
            const auto radius = float(1.0 + 0.1 * bump);
            positions.push_back({radius * n[0], radius * n[1], radius * n[2]});
            normals.push_back(n);
        }
    }
    positions.push_back({0.0f, -1.0f, 0.0f});
    normals.push_back({0.0f, -1.0f, 0.0f});
    const auto last = std::uint32_t(positions.size() - 1);
    const auto at = [&](std::uint32_t row, std::uint32_t column) { return 1 + (row - 1) * columns + column % columns; };
    std::vector<std::uint32_t> indices;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        indices.insert(indices.end(), {a, b, c});
    };
    for (std::uint32_t column = 0; column < columns; ++column) {
        add(0, at(1, column + 1), at(1, column));
        add(last, at(rows - 1, column), at(rows - 1, column + 1));
        for (std::uint32_t row = 1; row + 1 < rows; ++row) {
            add(at(row, column), at(row, column + 1), at(row + 1, column));
            add(at(row, column + 1), at(row + 1, column + 1), at(row + 1, column));
        }
    }
    return builder.mesh({{"attributes", {{"POSITION", builder.float3(positions)}, {"NORMAL", builder.float3(normals)}}},
                         {"indices", builder.accessor(builder.view(indices), "SCALAR", 5125, indices.size())},
                         {"material", 0}});
}

int quad(GltfBuilder& builder, const std::vector<Float3>& corners, int material) {
    return builder.mesh({{"attributes", {{"POSITION", builder.float3(corners)}}},
                         {"indices", builder.u16({0, 1, 2, 0, 2, 3})},
                         {"material", material}});
}

}  // namespace

GltfBuilder instanced_spheres(std::uint32_t instances, std::uint32_t triangles) {
    GltfBuilder builder;
    builder.document["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_emissive_strength",
                                          "EXT_mesh_gpu_instancing"};
    builder.add("materials", material({0.7, 0.5, 0.3, 1.0}, 0.0));
    builder.add("materials", material({0.7, 0.7, 0.7, 1.0}, 0.0));
    builder.add("materials", material({0.0, 0.0, 0.0, 1.0}, 8.0));
    const int sphere = bumpy_sphere(builder, triangles);
    builder.add("nodes",
                {{"mesh", quad(builder, {{-1.2f, 0, -1.2f}, {-1.2f, 0, 1.2f}, {1.2f, 0, 1.2f}, {1.2f, 0, -1.2f}}, 1)}});
    builder.add(
        "nodes",
        {{"mesh",
          quad(builder, {{-0.4f, 1.5f, -0.4f}, {0.4f, 1.5f, -0.4f}, {0.4f, 1.5f, 0.4f}, {-0.4f, 1.5f, 0.4f}}, 2)}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}});
    builder.add(
        "nodes",
        {{"camera", 0}, {"translation", {0.0, 1.1, 2.4}}, {"rotation", {-std::sin(0.2), 0.0, 0.0, std::cos(0.2)}}});
    std::mt19937 random(1);
    const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
    const auto across = std::uint32_t(std::ceil(std::sqrt(double(instances))));
    const double step = 2.0 / across;
    std::vector<Float3> places, scales;
    std::vector<std::array<float, 4>> turns;
    for (std::uint32_t i = 0; i < instances; ++i) {
        const double size = 0.45 * step * uniform(0.5, 1.0), mirror = i % 5 == 0 ? -1.0 : 1.0;
        places.push_back(
            {float(-1.0 + (i % across + 0.5) * step), float(1.2 * size), float(-1.0 + (i / across + 0.5) * step)});
        scales.push_back({float(mirror * size), float(size * uniform(0.7, 1.0)), float(size)});
        std::array<double, 4> q{};
        double length2 = 0.0;
        for (double& c : q) {
            c = uniform(-1.0, 1.0);
            length2 += c * c;
        }
        for (int c = 0; c < 4; ++c) q[c] /= std::sqrt(length2);
        turns.push_back({float(q[0]), float(q[1]), float(q[2]), float(q[3])});
    }
    const json attributes = {{"TRANSLATION", builder.float3(places)},
                             {"ROTATION", builder.accessor(builder.view(turns), "VEC4", 5126, turns.size())},
                             {"SCALE", builder.float3(scales)}};
    builder.add("nodes",
                {{"mesh", sphere}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    return builder;
}

namespace {

/// Adds a triangle of another scene, moved.
void add_moved(const Scene& from, const Triangle& source, const glm::dmat4& transform, Scene& to) {
    const glm::dmat3 linear(transform), normals = glm::transpose(glm::inverse(linear));
    const bool mirrors = glm::determinant(linear) < 0.0;
    Triangle triangle = source;
    if (mirrors) std::swap(triangle.vertex[1], triangle.vertex[2]);
    for (std::uint32_t& v : triangle.vertex) {
        to.positions.emplace_back(transform * glm::dvec4(from.positions[v], 1.0));
        to.normals.emplace_back(glm::normalize(normals * glm::dvec3(from.normals[v])));
        for (int set = 0; set < 2; ++set) {
            if (!from.uv[set].empty()) to.uv[set].push_back(from.uv[set][v]);
        }
        if (!from.colors.empty()) to.colors.push_back(from.colors[v]);
        if (!from.tangents.empty()) {
            const glm::vec4 t = from.tangents[v];
            const glm::dvec3 along = t.w == 0.0f ? glm::dvec3(0.0) : glm::normalize(linear * glm::dvec3(t));
            to.tangents.emplace_back(glm::vec3(along), mirrors ? -t.w : t.w);
        }
        v = std::uint32_t(to.positions.size() - 1);
    }
    to.triangles.push_back(triangle);
}

}  // namespace

Scene copied(const Scene& scene) {
    Scene copy = scene;
    copy.triangles.resize(world_triangles(scene).count());
    copy.meshes.clear();
    copy.instances.clear();
    for (const Instance& instance : scene.instances) {
        const TriangleRange triangles = triangles_of_mesh(scene, instance.mesh);
        for (std::uint32_t i = triangles.first; i < triangles.last; ++i) {
            add_moved(scene, scene.triangles[i], glm::dmat4(instance.to_world), copy);
        }
    }
    return copy;
}

Scene shared(const Scene& scene, std::uint32_t material, const glm::dmat4& to_world) {
    Scene result = scene;
    const glm::dmat4 back = glm::inverse(to_world);
    const auto removed =
        std::uint32_t(std::erase_if(result.triangles, [&](const Triangle& t) { return t.material == material; }));
    for (SharedMesh& mesh : result.meshes) mesh.first_triangle -= removed;
    result.meshes.push_back({std::uint32_t(result.triangles.size()), 0});
    for (const Triangle& triangle : scene.triangles) {
        if (triangle.material == material) add_moved(scene, triangle, back, result);
    }
    result.instances.push_back({glm::dmat4x3(to_world), std::uint32_t(result.meshes.size() - 1), 0});
    if (result.mesh_nodes.empty()) result.mesh_nodes.emplace_back();
    return result;
}

}  // namespace vkcppm::test
