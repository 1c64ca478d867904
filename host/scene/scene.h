#pragma once
// A scene as a value: triangles in world space, meshes and where they stand, materials, lights and cameras. No Vulkan,
// no file format.

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/mat4x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"

namespace vkcppm {

/// A picture that textures read: 8 bits a channel as in the file, first row on top. Colours are sRGB-encoded, all else
/// is linear: which it is follows from the use.
struct TextureImage {
    std::string name;
    Extent size;
    std::vector<std::uint8_t> rgba;  // [4 x pixels]
    // [4 x pixels] what 16 bits a channel have beyond these: a value is rgba / 255 + rest / 65535. Empty: nothing.
    std::vector<std::int8_t> rest = {};
};

/// One use of an image by a material: where to look it up and how. uv' = matrix * uv + offset (KHR_texture_transform),
/// v' downwards from the first row.
struct Texture {
    enum class Wrap { repeat, mirrored_repeat, clamp_to_edge };
    std::uint32_t image = 0;   // into Scene::images
    std::uint32_t uv_set = 0;  // 0 or 1
    Wrap wrap_s = Wrap::repeat;
    Wrap wrap_t = Wrap::repeat;
    bool nearest = false;  // magnification filter: the nearest texel, else bilinear
    glm::mat2 matrix{1.0f};
    glm::vec2 offset{0.0f};
};

/// A glTF material. Defaults are glTF's. A texture multiplies the factor of its name, in the channels that glTF states.
struct Material {
    enum class Alpha { opaque, mask, blend };
    std::string name;
    glm::vec3 base_color{1.0f};  // linear Rec. 709
    float metallic = 1.0f;       // 0..1
    float roughness = 1.0f;      // 0..1, alpha = roughness^2
    glm::vec3 emission{0.0f};    // emissiveFactor * emissiveStrength: radiance, W m^-2 sr^-1
    float opacity = 1.0f;        // alpha of baseColorFactor
    Alpha alpha = Alpha::opaque;
    float alpha_cutoff = 0.5f;                          // mask: opaque where the alpha is at least this
    float normal_scale = 1.0f;                          // of the normal texture's x and y
    bool double_sided = false;                          // an emitter that is not emits from its front side alone
    std::optional<Texture> base_color_texture;          // sRGB, alpha
    std::optional<Texture> metallic_roughness_texture;  // g: roughness, b: metallic
    std::optional<Texture> normal_texture;
    std::optional<Texture> emissive_texture;  // sRGB
    bool unlit = false;                       // KHR_materials_unlit: the camera sees base_color, nothing is lit by it
    float ior = 1.5f;                         // KHR_materials_ior; >= 1 (0 means infinity in the extension)
    float attenuation_distance = std::numeric_limits<float>::infinity();  // KHR_materials_volume, m
#define EXTENSION(name, ...) __VA_ARGS__
#define FACTOR(member, json, standard, low, high) float member = standard;
#define COLOR(member, json, standard, high) glm::vec3 member{standard};
#define TEXTURE(NUMBER, member, json, words, encoding, where) std::optional<Texture> member;
#define NORMALS(NUMBER, member, json, words, scale, where) \
    std::optional<Texture> member;                         \
    float scale = 1.0f;
#include "scene/material_extensions.h"
};

/// Counter-clockwise seen from its front side: cross(p1 - p0, p2 - p0) is the front's normal.
struct Triangle {
    std::array<std::uint32_t, 3> vertex;  // into Scene::positions and Scene::normals
    std::uint32_t material;               // into Scene::materials
};

/// Where the triangles of a glTF node begin; they end where those of the next entry do.
struct MeshNode {
    std::uint32_t index = 0;  // into the file's nodes
    std::string name;
    std::uint32_t first_triangle = 0;  // into Scene::triangles
};

/// A mesh that is stored once, in a space of its own, and shown by instances. None of its triangles emits: lights are
/// in world space.
struct SharedMesh {
    std::uint32_t first_triangle = 0;  // into Scene::triangles; they end where those of the next mesh begin
    std::uint32_t node = 0;            // into Scene::mesh_nodes: the first that shows it
};

/// Where a shared mesh stands. Not singular, nor so sheared that rounding would count: is_shareable() of instances.h.
struct Instance {
    glm::dmat4x3 to_world{1.0};
    std::uint32_t mesh = 0;  // into Scene::meshes
    std::uint32_t node = 0;  // into Scene::mesh_nodes
};

/// KHR_lights_punctual in world space. intensity: W/sr a channel (point, spot) or W/m^2 (directional).
struct PunctualLight {
    enum class Kind { point, spot, directional };
    Kind kind = Kind::point;
    std::string name;
    glm::vec3 intensity{1.0f};               // color * intensity
    glm::dvec3 position{0.0};                // m; unused by directional
    glm::dvec3 direction{0.0, 0.0, -1.0};    // unit, where the light travels to; unused by point
    double range = 0.0;                      // m, where a point or spot light ends; 0: nowhere
    double inner_cone = 0.0;                 // rad, spot only
    double outer_cone = 0.7853981633974483;  // rad, spot only
};

/// A camera that looks along its local -z with +y up.
struct Camera {
    std::string name;
    std::string node;                  // the name of its node
    glm::dmat4 to_world{1.0};          // rigid: orthonormal columns and a position (scale removed)
    double yfov = 0.7853981633974483;  // rad, perspective
    std::optional<double> ymag;        // orthographic: half the height of what it sees, m
    std::optional<double> aspect;      // width / height, where the file states one
};

/// Light from infinitely far away. Row 0 is up (+y); the middle column is +x and columns go on towards +z:
/// u = 1/2 + atan2(z, x) / (2 pi), v = acos(y) / pi for a unit direction (x, y, z) away from the scene.
struct Environment {
    Extent size;
    std::vector<glm::vec3> radiance;  // [pixels] W m^-2 sr^-1, first row on top; constant over a pixel
};

/// What a file holds. Triangles and vertices are in world space, but for those of shared meshes. `positions` and
/// `normals` have one entry a vertex; the other vectors of vertices have one too, or are empty where no vertex of the
/// file has any.
struct Scene {
    std::filesystem::path file;
    std::vector<std::filesystem::path> inputs;  // the file, all that it names, and the environment
    std::uint64_t hash = 0;             // FNV-1a of the file and of every buffer, image and environment it is lit by
    std::vector<glm::dvec3> positions;  // [V] m
    std::vector<glm::vec3> normals;     // [V] unit, shading
    std::array<std::vector<glm::vec2>, 2> uv;  // [V] texture coordinates of either set
    std::vector<glm::vec4> colors;             // [V] linear, multiplies the base colour and its alpha
    std::vector<glm::vec4> tangents;   // [V] unit, w: sign of the bitangent cross(normal, tangent); 0: none given
    std::vector<Triangle> triangles;   // in world space, then those of `meshes` mesh by mesh
    std::vector<SharedMesh> meshes;    // first_triangle ascends
    std::vector<Instance> instances;   // of those
    std::vector<MeshNode> mesh_nodes;  // first_triangle ascends; empty in a scene that is of no file
    std::vector<Material> materials;   // at least one where there are triangles
    std::vector<TextureImage> images;  // those that materials use
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;  // those of the file, or one that frames the scene
    std::optional<Environment> environment;
    std::vector<std::string> warnings;  // one line each, for stderr
};

}  // namespace vkcppm
