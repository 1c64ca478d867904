#pragma once
// A scene as a value: world-space triangles, materials, lights and cameras. No Vulkan, no file format.

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace vkcppm {

/// A glTF material, as written in the file (factors only). Defaults are glTF's.
struct Material {
    std::string name;
    glm::vec3 base_color{1.0f};            // linear Rec. 709
    float metallic = 1.0f;                 // 0..1
    float roughness = 1.0f;                // 0..1, alpha = roughness^2
    glm::vec3 emission{0.0f};              // emissiveFactor * emissiveStrength: radiance, W m^-2 sr^-1
    float transmission = 0.0f;             // KHR_materials_transmission
    float thickness = 0.0f;                // KHR_materials_volume thicknessFactor; > 0 means a solid volume
    float ior = 1.5f;                      // KHR_materials_ior; >= 1 (0 means infinity in the extension)
    float specular = 1.0f;                 // KHR_materials_specular specularFactor
    glm::vec3 specular_color{1.0f};        // KHR_materials_specular specularColorFactor
    glm::vec3 attenuation_color{1.0f};     // KHR_materials_volume
    float attenuation_distance = std::numeric_limits<float>::infinity();  // m
    bool double_sided = false;             // an emitter that is not emits from its front side alone
    bool textured = false;                 // names a texture in the file, whatever for
};

/// Counter-clockwise seen from its front side: cross(p1 - p0, p2 - p0) is the front's normal.
struct Triangle {
    std::array<std::uint32_t, 3> vertex;   // into Scene::positions and Scene::normals
    std::uint32_t material;                // into Scene::materials
};

/// KHR_lights_punctual in world space. intensity: W/sr a channel (point, spot) or W/m^2 (directional).
struct PunctualLight {
    enum class Kind { point, spot, directional };
    Kind kind = Kind::point;
    std::string name;
    glm::vec3 intensity{1.0f};             // color * intensity
    glm::dvec3 position{0.0};              // m; unused by directional
    glm::dvec3 direction{0.0, 0.0, -1.0};  // unit, where the light travels to; unused by point
    double inner_cone = 0.0;               // rad, spot only
    double outer_cone = 0.7853981633974483;  // rad, spot only
};

/// A perspective camera that looks along its local -z with +y up.
struct Camera {
    std::string name;
    glm::dmat4 to_world{1.0};              // rigid: orthonormal columns and a position (scale removed)
    double yfov = 0.7853981633974483;      // rad
    std::optional<double> aspect;          // width / height, where the file states one
};

/// What a file holds, flattened to world space. `positions` and `normals` have one entry a vertex.
struct Scene {
    std::filesystem::path file;
    std::uint64_t hash = 0;                // FNV-1a of the file and of every buffer it names
    std::vector<glm::dvec3> positions;     // [V] m
    std::vector<glm::vec3> normals;        // [V] unit, shading
    std::vector<Triangle> triangles;
    std::vector<Material> materials;       // at least one where there are triangles
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;           // those of the file, or one that frames the scene
    std::vector<std::string> warnings;     // one line each, for stderr
};

}  // namespace vkcppm
