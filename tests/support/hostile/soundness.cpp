#include "support/hostile/soundness.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "scene/instances.h"

namespace vkcppm::test {
namespace {

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_unit(const glm::dvec3& v) { return std::abs(glm::length(v) - 1.0) < 1e-5; }

bool is_radiance(const glm::vec3& v) { return is_finite(v) && glm::all(glm::greaterThanEqual(v, glm::vec3(0.0f))); }

bool is_fraction(const glm::vec4& v) {
    return glm::all(glm::greaterThanEqual(v, glm::vec4(0.0f))) && glm::all(glm::lessThanEqual(v, glm::vec4(1.0f)));
}

/// What is wrong with a vector of vertices that is empty or has one entry a vertex.
template <typename T, typename IsSound>
std::string unsound_vertices(const char* name, const std::vector<T>& values, std::size_t vertices,
                             const IsSound& is_sound) {
    if (values.empty()) return "";
    if (values.size() != vertices) return fmt::format("{} {} for {} vertices", values.size(), name, vertices);
    const auto bad = std::ranges::find_if_not(values, is_sound);
    return bad == values.end() ? "" : fmt::format("{}[{}]", name, bad - values.begin());
}

std::string unsound_triangles(const Scene& scene) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& triangle = scene.triangles[i];
        if (triangle.material >= scene.materials.size()) return fmt::format("the material of triangle {}", i);
        for (const std::uint32_t vertex : triangle.vertex) {
            if (vertex >= scene.positions.size()) return fmt::format("a corner of triangle {}", i);
            if (!is_finite(scene.positions[vertex])) return fmt::format("the position of vertex {}", vertex);
            if (!is_unit(scene.normals[vertex])) return fmt::format("the normal of vertex {}", vertex);
        }
    }
    return "";
}

std::string unsound_instances(const Scene& scene) {
    std::uint32_t last = 0;
    for (const SharedMesh& mesh : scene.meshes) {
        if (mesh.first_triangle < last || mesh.first_triangle > scene.triangles.size()) return "the order of meshes";
        if (mesh.node >= scene.mesh_nodes.size()) return "the node of a mesh";
        last = mesh.first_triangle;
    }
    for (std::uint32_t i = world_triangles(scene).last; i < scene.triangles.size(); ++i) {
        const Material& material = scene.materials[scene.triangles[i].material];
        if (material.emission != glm::vec3(0.0f)) return fmt::format("triangle {}, which emits, is shared", i);
    }
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (instance.mesh >= scene.meshes.size()) return fmt::format("the mesh of instance {}", i);
        if (instance.node >= scene.mesh_nodes.size()) return fmt::format("the node of instance {}", i);
        if (!is_shareable(glm::dmat4(instance.to_world))) return fmt::format("the transform of instance {}", i);
        for (int column = 0; column < 4; ++column) {
            if (!is_finite(instance.to_world[column])) return fmt::format("the transform of instance {}", i);
        }
    }
    return "";
}

std::string unsound_material(const Scene& scene, const Material& m) {
    for (const auto* texture :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emissive_texture,
          &m.transmission_texture, &m.specular_texture, &m.specular_color_texture, &m.clearcoat_texture,
          &m.clearcoat_roughness_texture, &m.clearcoat_normal_texture, &m.anisotropy_texture, &m.iridescence_texture,
          &m.iridescence_thickness_texture, &m.sheen_color_texture, &m.sheen_roughness_texture}) {
        if (!*texture) continue;
        if ((*texture)->image >= scene.images.size() || (*texture)->uv_set > 1) return "a texture";
    }
    if (!is_fraction({m.base_color, m.opacity})) return "the base colour";
    if (!is_fraction({m.metallic, m.roughness, m.transmission, m.clearcoat})) return "a factor";
    if (!is_fraction({m.anisotropy, m.iridescence, 0.0f, 0.0f})) return "a factor";
    if (!is_fraction({m.sheen_color, m.sheen_roughness})) return "the sheen";
    if (!std::isfinite(m.anisotropy_rotation)) return "the rotation of the anisotropy";
    if (!(m.iridescence_ior >= 1.0f && m.iridescence_ior <= 100.0f)) return "the index of the film";
    for (const float thickness : {m.iridescence_thickness_minimum, m.iridescence_thickness_maximum}) {
        if (!(thickness >= 0.0f && std::isfinite(thickness))) return "the thickness of the film";
    }
    if (!is_radiance(m.emission)) return "the emission";
    if (!(m.ior == 0.0f || m.ior >= 1.0f)) return fmt::format("the ior {}", m.ior);
    return "";
}

std::string unsound_camera(const Camera& camera) {
    for (int c = 0; c < 3; ++c) {
        if (!is_unit(camera.to_world[c])) return "the axes";
    }
    if (!is_finite(camera.to_world[3])) return "the position";
    return camera.yfov > 0.0 && camera.yfov < 3.1416 ? "" : fmt::format("the yfov {}", camera.yfov);
}

}  // namespace

std::string unsoundness(const Scene& scene) {
    const std::size_t vertices = scene.positions.size();
    if (scene.normals.size() != vertices) {
        return fmt::format("{} normals of {} vertices", scene.normals.size(), vertices);
    }
    if (std::string text = unsound_triangles(scene); !text.empty()) return text;
    if (std::string text = unsound_instances(scene); !text.empty()) return text;
    for (const auto& uv : scene.uv) {
        const auto is_sound = [](const glm::vec2& v) { return is_finite({v, 0.0f}); };
        if (std::string text = unsound_vertices("uv", uv, vertices, is_sound); !text.empty()) return text;
    }
    if (std::string text = unsound_vertices("colors", scene.colors, vertices, is_fraction); !text.empty()) return text;
    const auto is_tangent = [](const glm::vec4& t) {
        return t == glm::vec4(0.0f) || (is_unit(glm::vec3(t)) && std::abs(t.w) == 1.0f);
    };
    if (std::string text = unsound_vertices("tangents", scene.tangents, vertices, is_tangent); !text.empty()) {
        return text;
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const std::string text = unsound_material(scene, scene.materials[i]);
        if (!text.empty()) return fmt::format("{} of material {}", text, i);
    }
    for (const TextureImage& image : scene.images) {
        if (image.rgba.size() != 4 * image.size.pixels() || image.rgba.empty() ||
            (!image.rest.empty() && image.rest.size() != image.rgba.size())) {
            return fmt::format("image '{}'", image.name);
        }
    }
    if (scene.cameras.empty()) return "no camera";
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const std::string text = unsound_camera(scene.cameras[i]);
        if (!text.empty()) return fmt::format("{} of camera {}", text, i);
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        if (!is_radiance(light.intensity)) return fmt::format("the intensity of light {}", i);
        if (!is_finite(light.position) || !is_unit(light.direction)) return fmt::format("the place of light {}", i);
    }
    return "";
}

}  // namespace vkcppm::test
