#include "scene/gltf.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <tiny_gltf.h>

#include "scene/accessor.h"
#include "scene/bad_scene.h"
#include "scene/gltf_file.h"
#include "scene/gltf_schema.h"
#include "scene/warnings.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr std::size_t max_triangles = std::size_t(1) << 27;       // of all instances, degenerate ones included
constexpr std::size_t max_vertices = std::size_t(1) << 27;        // of all instances
constexpr std::size_t max_primitives = std::size_t(1) << 24;      // of all instances, empty ones included
constexpr std::size_t max_zero_elements = std::size_t(1) << 22;   // of an accessor that no bytes of the file back
constexpr double max_coordinate = FLT_MAX;                        // m; its square is finite in double

/// The document as tinygltf's structures. Only what the loader reads is handed over: the buffers are read already,
/// and images, animations and the like can't trip the parser.
tinygltf::Model parse_model(const GltfFile& file) {
    json document;
    for (const char* member : {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "materials",
                               "cameras", "extensions"}) {
        if (const auto found = file.document.find(member); found != file.document.end()) document[member] = *found;
    }
    // tinygltf 2.7 refuses indices without a bufferView, which glTF allows: they get one past the last of the file.
    const std::size_t no_view = document["bufferViews"].size();
    document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (json& accessor : document["accessors"]) accessor.emplace("bufferView", no_view);
    const std::string text = document.dump();
    if (text.size() > INT32_MAX) {
        bad_scene(file.name, "the size of the JSON", fmt::to_string(text.size()),
                  fmt::format("the limit is {} bytes", INT32_MAX));
    }
    tinygltf::Model model;
    std::string error, warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "",
                                                  tinygltf::NO_REQUIRE)) {
        std::ranges::replace(error, '\n', ' ');
        bad_scene(file.name, "the document", "refused by tinygltf", error);
    }
    return model;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

double number_or(const tinygltf::Value* extension, const char* key, double otherwise) {
    return extension && extension->Has(key) ? extension->Get(key).GetNumberAsDouble() : otherwise;
}

glm::dvec3 vec3_or(const tinygltf::Value* extension, const char* key, const glm::dvec3& otherwise) {
    if (!extension || !extension->Has(key)) return otherwise;
    const tinygltf::Value& value = extension->Get(key);
    return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble(), value.Get(2).GetNumberAsDouble()};
}

bool is_textured(const tinygltf::Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    for (const int index : {pbr.baseColorTexture.index, pbr.metallicRoughnessTexture.index,
                            material.normalTexture.index, material.occlusionTexture.index,
                            material.emissiveTexture.index}) {
        if (index >= 0) return true;
    }
    for (const auto& [name, extension] : material.extensions) {
        for (const std::string& key : extension.Keys()) {
            if (key.ends_with("Texture")) return true;
        }
    }
    return false;
}

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string to_text(const glm::dvec3& v) { return fmt::format("({}, {}, {})", v.x, v.y, v.z); }

/// A frame of orthonormal columns x, y, z whose z is along `z` and whose y is as near to `up` as that allows; nothing
/// where the two are zero or parallel.
std::optional<glm::dmat3> orthonormal_frame(const glm::dvec3& z, const glm::dvec3& up) {
    const glm::dvec3 unit_z = z / glm::length(z);
    const glm::dvec3 unit_up = up / glm::length(up);
    const glm::dvec3 x = glm::cross(unit_up, unit_z);
    const double sine = glm::length(x);
    if (!(sine > 1e-9)) return std::nullopt;  // NaN where a length was zero
    return glm::dmat3(x / sine, glm::cross(unit_z, x / sine), unit_z);
}

/// How a mesh gets from its own space to the world.
struct Placement {
    glm::dmat4 to_world;
    glm::dmat3 normal_to_world;  // the inverse transpose, but for a positive factor
    bool mirrored = false;       // the determinant is negative: the winding turns over

    /// Nothing where the transform is singular.
    static std::optional<Placement> of(const glm::dmat4& to_world) {
        glm::dmat3 linear(to_world);
        const double size = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
        if (!(size > 0.0)) return std::nullopt;
        linear /= size;
        // Volume of the parallelepiped of unit edges: 0 is flat, whatever the scales are.
        const double volume = glm::determinant(
            glm::dmat3(glm::normalize(linear[0]), glm::normalize(linear[1]), glm::normalize(linear[2])));
        if (!(std::abs(volume) > 1e-12)) return std::nullopt;
        // The cofactors are det(M) M^-T: no division, and the sign of the determinant turns them to M^-T.
        const double sign = volume < 0.0 ? -1.0 : 1.0;
        const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                   glm::cross(linear[0], linear[1]));
        return Placement{to_world, sign * cofactors, volume < 0.0};
    }

    glm::dvec3 point(const glm::dvec3& p) const { return glm::dvec3(to_world * glm::dvec4(p, 1.0)); }

    /// A unit normal, or zero where `n` has no direction.
    glm::vec3 normal(const glm::dvec3& n) const {
        const glm::dvec3 world = normal_to_world * n;
        const double length = glm::length(world);
        return length > 0.0 && std::isfinite(length) ? glm::vec3(world / length) : glm::vec3(0.0f);
    }
};

using Vectors = std::shared_ptr<const std::vector<glm::dvec3>>;
using Corners = std::array<std::uint32_t, 3>;

/// One primitive in the space of its mesh.
struct LocalPrimitive {
    Vectors positions;
    Vectors normals;  // null: flat
    std::vector<Corners> triangles;
};

/// The triangles of glTF 2.0, section 3.7.2.1, in its order and winding: a list, a strip or a fan of `indices`.
std::vector<Corners> assemble_triangles(int mode, const std::vector<std::uint32_t>& indices) {
    std::vector<Corners> triangles;
    const std::size_t n = indices.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        for (std::size_t i = 0; i + 2 < n; i += 3) triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t i = 0; i + 2 < n; ++i) {
            triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
        }
    } else {
        for (std::size_t i = 0; i + 2 < n; ++i) triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    }
    return triangles;
}

/// One reading of one file: fills a Scene from the model, node by node.
class SceneReader {
public:
    SceneReader(const GltfFile& file, const tinygltf::Model& model) : file_(file), model_(model) {}

    Scene read() {
        warn_of_ignored_parts();
        check_buffer_views();
        for (std::size_t i = 0; i < model_.materials.size(); ++i) scene_.materials.push_back(read_material(i));
        const std::vector<PlacedNode> nodes = place_nodes(root_nodes(parents()));
        check_totals(nodes);
        for (const PlacedNode& node : nodes) add_node(node);
        if (degenerate_triangles_ > 0) {
            warnings_.add(fmt::format("{} dropped", degenerate_triangles_), "triangles of zero area");
        }
        if (scene_.cameras.empty()) {
            warnings_.add("there is no perspective camera, one that frames it is used", "the scene");
            scene_.cameras.push_back(framing_camera());
        }
        if (scene_.triangles.empty()) warnings_.add("there is no triangle", "the scene");
        scene_.hash = file_.hash;
        scene_.warnings = warnings_.lines(file_.name);
        return std::move(scene_);
    }

private:
    [[noreturn]] void fail(std::string_view object, std::string_view value, std::string_view limit) const {
        bad_scene(file_.name, object, value, limit);
    }

    void warn_of_ignored_parts() {
        const auto unsupported = unsupported_extensions(file_.document, "extensionsUsed", file_.name);
        if (!unsupported.empty()) {
            warnings_.add("ignored, this program lacks them",
                          fmt::format("extensions {}", fmt::join(unsupported, ", ")));
        }
        if (!file_.document.value("animations", json::array()).empty()) {
            warnings_.add("ignored, the scene is at rest", "animations");
        }
        const auto textured = std::ranges::count_if(model_.materials, is_textured);
        if (textured > 0) {
            warnings_.add(fmt::format("ignored in {} of {} materials", textured, model_.materials.size()), "textures");
        }
    }

    // ---- materials ----

    /// `value`, within the range; a warning where it is not.
    double clamped(double value, double low, double high, const std::string& object) {
        if (value < low || value > high) {
            warnings_.add("outside its range, clamped", fmt::format("{} = {} ({} to {})", object, value, low, high));
        }
        return std::clamp(value, low, high);
    }

    glm::vec3 clamped(const glm::dvec3& value, double low, double high, const std::string& object) {
        return {clamped(value.x, low, high, object), clamped(value.y, low, high, object),
                clamped(value.z, low, high, object)};
    }

    /// color * strength a channel: both must be non-negative and the product a finite float; color is at most 1.
    glm::vec3 emitted(const glm::dvec3& color, double strength, const std::string& color_name,
                      const std::string& strength_name) {
        for (int c = 0; c < 3; ++c) {
            if (color[c] < 0.0) fail(color_name, to_text(color), "it must not be negative");
        }
        if (strength < 0.0) fail(strength_name, fmt::to_string(strength), "it must not be negative");
        if (strength > FLT_MAX) fail(strength_name, fmt::to_string(strength), fmt::format("the limit is {}", FLT_MAX));
        return clamped(color, 0.0, 1.0, color_name) * float(strength);
    }

    Material read_material(std::size_t i) {
        const tinygltf::Material& source = model_.materials[i];
        const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
        const tinygltf::Value* strength = find_extension(source.extensions, "KHR_materials_emissive_strength");
        const tinygltf::Value* transmission = find_extension(source.extensions, "KHR_materials_transmission");
        const tinygltf::Value* ior = find_extension(source.extensions, "KHR_materials_ior");
        const tinygltf::Value* volume = find_extension(source.extensions, "KHR_materials_volume");
        const tinygltf::Value* specular = find_extension(source.extensions, "KHR_materials_specular");
        const auto member = [&](const char* name) { return fmt::format("materials[{}].{}", i, name); };

        Material material;
        material.name = source.name;
        material.base_color = clamped(glm::make_vec3(pbr.baseColorFactor.data()), 0.0, 1.0, member("baseColorFactor"));
        material.metallic = float(clamped(pbr.metallicFactor, 0.0, 1.0, member("metallicFactor")));
        material.roughness = float(clamped(pbr.roughnessFactor, 0.0, 1.0, member("roughnessFactor")));
        material.emission =
            emitted(glm::make_vec3(source.emissiveFactor.data()), number_or(strength, "emissiveStrength", 1.0),
                    member("emissiveFactor"), member("emissiveStrength"));
        material.transmission =
            float(clamped(number_or(transmission, "transmissionFactor", 0.0), 0.0, 1.0, member("transmissionFactor")));
        material.thickness =
            float(clamped(number_or(volume, "thicknessFactor", 0.0), 0.0, FLT_MAX, member("thicknessFactor")));
        if (const double value = number_or(ior, "ior", 1.5); value != 0.0) {
            material.ior = float(clamped(value, 1.0, FLT_MAX, member("ior")));
        } else {
            material.ior = 0.0f;  // KHR_materials_ior: stands for infinity
        }
        material.specular =
            float(clamped(number_or(specular, "specularFactor", 1.0), 0.0, 1.0, member("specularFactor")));
        material.specular_color = clamped(vec3_or(specular, "specularColorFactor", glm::dvec3(1.0)), 0.0, FLT_MAX,
                                          member("specularColorFactor"));
        material.attenuation_color =
            clamped(vec3_or(volume, "attenuationColor", glm::dvec3(1.0)), 0.0, 1.0, member("attenuationColor"));
        if (volume && volume->Has("attenuationDistance")) {
            const double distance = number_or(volume, "attenuationDistance", 0.0);
            material.attenuation_distance = float(clamped(distance, FLT_MIN, FLT_MAX, member("attenuationDistance")));
        }
        material.double_sided = source.doubleSided;
        if (source.alphaMode != "OPAQUE") warnings_.add("its alpha mode is ignored, it is opaque", member("alphaMode"));
        return material;
    }

    /// The material of a primitive; glTF's default, added once, where it names none.
    std::uint32_t material_index(const tinygltf::Primitive& primitive) {
        if (primitive.material >= 0) return std::uint32_t(primitive.material);
        if (scene_.materials.size() == model_.materials.size()) scene_.materials.push_back({.name = "default"});
        return std::uint32_t(model_.materials.size());
    }

    // ---- nodes ----

    /// [nodes] the parent of each node, or -1. A node has one parent at most and is not its own ancestor.
    std::vector<int> parents() const {
        std::vector<int> parent(model_.nodes.size(), -1);
        for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
            for (const int child : model_.nodes[i].children) {
                if (parent[child] >= 0) {
                    fail(fmt::format("nodes[{}]", child),
                         fmt::format("a child of nodes[{}] and nodes[{}]", parent[child], i), "a node has one parent");
                }
                parent[child] = int(i);
            }
        }
        std::vector<int> reached_from(model_.nodes.size(), -1);
        for (int i = 0; i < int(model_.nodes.size()); ++i) {
            int node = i;
            while (node >= 0 && reached_from[node] < 0) {
                reached_from[node] = i;
                node = parent[node];
            }
            if (node >= 0 && reached_from[node] == i) {
                fail(fmt::format("nodes[{}]", node), "its own ancestor", "the nodes must form trees");
            }
        }
        return parent;
    }

    /// The nodes of the default scene, else of the first, else all that have no parent.
    std::vector<int> root_nodes(const std::vector<int>& parent) const {
        std::vector<int> roots;
        if (model_.scenes.empty()) {
            for (int i = 0; i < int(parent.size()); ++i) {
                if (parent[i] < 0) roots.push_back(i);
            }
            return roots;
        }
        const int scene = std::max(model_.defaultScene, 0);
        roots = model_.scenes[scene].nodes;
        std::vector<bool> listed(parent.size());
        for (std::size_t i = 0; i < roots.size(); ++i) {
            const std::string object = fmt::format("scenes[{}].nodes[{}]", scene, i);
            const int node = roots[i];
            if (parent[node] >= 0) {
                fail(object, fmt::to_string(node), fmt::format("a root has no parent, it has nodes[{}]", parent[node]));
            }
            if (listed[node]) fail(object, fmt::to_string(node), "the scene lists it already");
            listed[node] = true;
        }
        return roots;
    }

    struct PlacedNode {
        int index;
        glm::dmat4 to_world;
    };

    /// The roots and all below them, depth first, in the order of the file.
    std::vector<PlacedNode> place_nodes(const std::vector<int>& roots) {
        std::vector<PlacedNode> placed;
        std::vector<PlacedNode> stack;  // with the parent's transform; no recursion: the depth of the tree is free
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, glm::dmat4(1.0)});
        while (!stack.empty()) {
            const auto [index, parent_to_world] = stack.back();
            stack.pop_back();
            const tinygltf::Node& node = model_.nodes[index];
            const glm::dmat4 to_world = parent_to_world * local_transform(index);
            for (int column = 0; column < 4; ++column) {
                if (!is_finite(glm::dvec3(to_world[column]))) {
                    fail(fmt::format("column {} of the world transform of nodes[{}]", column, index),
                         to_text(to_world[column]), "it must be finite");
                }
            }
            placed.push_back({index, to_world});
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                stack.push_back({*child, to_world});
            }
        }
        return placed;
    }

    void add_node(const PlacedNode& placed) {
        const tinygltf::Node& node = model_.nodes[placed.index];
        if (node.mesh >= 0) add_mesh(placed.index, placed.to_world);
        if (node.camera >= 0) add_camera(placed.index, placed.to_world);
        if (const auto* extension = find_extension(node.extensions, "KHR_lights_punctual")) {
            add_light(placed.index, extension->Get("light").GetNumberAsInt(), placed.to_world);
        }
    }

    /// The matrix of a node, or translation * rotation * scale.
    glm::dmat4 local_transform(int index) {
        const tinygltf::Node& node = model_.nodes[index];
        if (!node.matrix.empty()) {
            for (const char* member : {"translation", "rotation", "scale"}) {
                if (file_.document["nodes"][index].contains(member)) {
                    warnings_.add("ignored beside a matrix", fmt::format("nodes[{}].{}", index, member));
                }
            }
            const glm::dmat4 matrix = glm::make_mat4(node.matrix.data());
            for (int column = 0; column < 4; ++column) {
                const double expected = column == 3 ? 1.0 : 0.0;
                if (matrix[column][3] != expected) {
                    fail(fmt::format("nodes[{}].matrix[{}]", index, 4 * column + 3), fmt::to_string(matrix[column][3]),
                         fmt::format("it must be {}", expected));
                }
            }
            return matrix;
        }
        glm::dmat4 transform(1.0);
        if (!node.rotation.empty()) {
            const auto& r = node.rotation;
            const glm::dquat rotation(r[3], r[0], r[1], r[2]);  // glm: w first
            const double length = glm::length(rotation);
            if (!(length > 0.0) || !std::isfinite(length)) {
                fail(fmt::format("nodes[{}].rotation", index), fmt::format("({}, {}, {}, {})", r[0], r[1], r[2], r[3]),
                     "it must be a unit quaternion");
            }
            if (std::abs(length - 1.0) > 1e-3) {
                warnings_.add("not a unit quaternion, normalised", fmt::format("nodes[{}].rotation", index));
            }
            transform = glm::mat4_cast(rotation / length);
        }
        for (int c = 0; c < 3 && !node.scale.empty(); ++c) transform[c] *= node.scale[c];
        if (!node.translation.empty()) transform[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1.0);
        return transform;
    }

    /// The object's own name, or its node's where it has none.
    static std::string name_of(const std::string& own, const tinygltf::Node& node) {
        return own.empty() ? node.name : own;
    }

    void add_camera(int index, const glm::dmat4& to_world) {
        const tinygltf::Node& node = model_.nodes[index];
        const tinygltf::Camera& source = model_.cameras[node.camera];
        const std::string object = fmt::format("cameras[{}]", node.camera);
        if (source.type != "perspective") {
            warnings_.add("orthographic cameras are skipped", object);
            return;
        }
        const double yfov = source.perspective.yfov;
        if (!(yfov > 0.0 && yfov < std::numbers::pi)) {
            fail(object + ".perspective.yfov", fmt::to_string(yfov), "it must lie between 0 and pi");
        }
        const std::optional<glm::dmat3> frame = orthonormal_frame(glm::dvec3(to_world[2]), glm::dvec3(to_world[1]));
        if (!frame) {
            warnings_.add("its camera is skipped, the transform is singular", fmt::format("nodes[{}]", index));
            return;
        }
        Camera camera;
        camera.name = name_of(source.name, node);
        camera.to_world = glm::dmat4(*frame);
        camera.to_world[3] = to_world[3];
        camera.yfov = yfov;
        if (file_.document["cameras"][node.camera]["perspective"].contains("aspectRatio")) {
            camera.aspect = source.perspective.aspectRatio;
            if (!(*camera.aspect > 0.0)) {
                fail(object + ".perspective.aspectRatio", fmt::to_string(*camera.aspect), "it must be positive");
            }
        }
        scene_.cameras.push_back(std::move(camera));
    }

    void add_light(int index, int light_index, const glm::dmat4& to_world) {
        const tinygltf::Node& node = model_.nodes[index];
        const tinygltf::Light& source = model_.lights[light_index];
        const std::string object = fmt::format("lights[{}]", light_index);
        PunctualLight light;
        light.kind = source.type == "point"  ? PunctualLight::Kind::point
                     : source.type == "spot" ? PunctualLight::Kind::spot
                                             : PunctualLight::Kind::directional;
        light.name = name_of(source.name, node);
        const glm::dvec3 color = source.color.empty() ? glm::dvec3(1.0) : glm::make_vec3(source.color.data());
        light.intensity = emitted(color, source.intensity, object + ".color", object + ".intensity");
        light.position = glm::dvec3(to_world[3]);
        if (light.kind != PunctualLight::Kind::point) {
            const glm::dvec3 direction = -glm::dvec3(to_world[2]);
            const double length = glm::length(direction);
            if (!(length > 0.0)) {
                warnings_.add("its light is skipped, the transform is singular", fmt::format("nodes[{}]", index));
                return;
            }
            light.direction = direction / length;
        }
        if (light.kind == PunctualLight::Kind::spot) read_cone(source.spot, object, light);
        if (source.range != 0.0) warnings_.add("ignored, light falls off without end", object + ".range");
        scene_.lights.push_back(std::move(light));
    }

    /// KHR_lights_punctual: 0 <= inner < outer <= pi/2.
    void read_cone(const tinygltf::SpotLight& spot, const std::string& object, PunctualLight& light) {
        constexpr double right_angle = std::numbers::pi / 2.0;
        constexpr double rounding = 1e-6;         // pi/2 written as float lies above pi/2
        constexpr double widest_inner = 1.0 - 1e-3;  // of outer: a hard edge that is still a falloff
        if (!(spot.outerConeAngle > 0.0)) {
            fail(object + ".spot.outerConeAngle", fmt::to_string(spot.outerConeAngle), "it must lie above 0, to pi/2");
        }
        const double outer = clamped(spot.outerConeAngle, 0.0, right_angle + rounding, object + ".spot.outerConeAngle");
        light.outer_cone = std::min(outer, right_angle);
        light.inner_cone =
            clamped(spot.innerConeAngle, 0.0, widest_inner * light.outer_cone, object + ".spot.innerConeAngle");
    }

    // ---- accessors ----

    void check_buffer_views() const {
        for (std::size_t i = 0; i < view_count_; ++i) {
            const tinygltf::BufferView& view = model_.bufferViews[i];
            const std::size_t size = file_.buffers[view.buffer].size;
            if (!elements_fit(view.byteOffset, 1, 1, view.byteLength, size)) {
                fail(fmt::format("bufferViews[{}]", i),
                     fmt::format("{} bytes from {} on", view.byteLength, view.byteOffset),
                     fmt::format("buffers[{}] has {}", view.buffer, size));
            }
        }
    }

    /// `count` elements of `size` bytes from `offset` on in a view; `stride` 0 takes the view's, or none between them.
    ElementBytes elements(int view_index, std::size_t offset, std::size_t count, std::size_t size,
                          const std::string& object, bool packed) const {
        const tinygltf::BufferView& view = model_.bufferViews[view_index];
        const std::size_t stride = packed || view.byteStride == 0 ? size : view.byteStride;
        if (stride < size) {
            fail(fmt::format("bufferViews[{}].byteStride", view_index), fmt::to_string(stride),
                 fmt::format("an element of {} has {} bytes", object, size));
        }
        if (!elements_fit(offset, count, stride, size, view.byteLength)) {
            fail(object, fmt::format("{} elements of {} bytes, {} apart, from {} on", count, size, stride, offset),
                 fmt::format("bufferViews[{}] has {} bytes", view_index, view.byteLength));
        }
        const GltfBuffer& buffer = file_.buffers[view.buffer];
        if (buffer.bytes.empty()) fail(fmt::format("buffers[{}]", view.buffer), "absent", buffer.absent);
        return {std::span(buffer.bytes).subspan(view.byteOffset + offset, (count - 1) * stride + size), stride};
    }

    static bool is_unsigned(ComponentType type) {
        return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
    }

    /// The checked view of an accessor of `components` (1: SCALAR, 3: VEC3) that serves as `use`.
    AccessorView accessor_view(int index, int components, std::string_view use) const {
        const tinygltf::Accessor& source = model_.accessors[index];
        const std::string object = fmt::format("accessors[{}]", index);
        AccessorView view;
        view.count = source.count;
        view.type = ComponentType(source.componentType);
        view.normalized = source.normalized;
        const std::size_t size = component_size(view.type) * components;
        if (size == 0 || (components == 1 && !is_unsigned(view.type))) {
            fail(object + ".componentType", fmt::to_string(source.componentType), fmt::format("not a type of {}", use));
        }
        if (const int found = tinygltf::GetNumComponentsInType(source.type); found != components) {
            fail(object + ".type", fmt::format("of {} components", found), fmt::format("{} needs {}", use, components));
        }
        if (std::size_t(source.bufferView) < view_count_) {
            view.base = elements(source.bufferView, source.byteOffset, source.count, size, object, false);
        } else if (source.count > max_zero_elements) {
            fail(object + ".count", fmt::to_string(source.count),
                 fmt::format("without a bufferView the limit is {}", max_zero_elements));
        }
        if (source.sparse.isSparse) {
            const auto& sparse = source.sparse;
            SparseBytes bytes;
            bytes.count = std::size_t(sparse.count);
            bytes.index_type = ComponentType(sparse.indices.componentType);
            if (!is_unsigned(bytes.index_type)) {
                fail(object + ".sparse.indices.componentType", fmt::to_string(sparse.indices.componentType),
                     "it must be 5121, 5123 or 5125");
            }
            bytes.indices = elements(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), bytes.count,
                                     component_size(bytes.index_type), object + ".sparse.indices", true);
            bytes.values = elements(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), bytes.count, size,
                                    object + ".sparse.values", true);
            view.sparse = bytes;
        }
        if (const auto bad = bad_sparse_index(view)) {
            fail(fmt::format("{}.sparse.indices element {}", object, *bad), "out of order or range",
                 fmt::format("they must rise and lie below {}", view.count));
        }
        return view;
    }

    /// The vectors of an accessor, read once.
    Vectors vectors(int index, std::string_view use) {
        Vectors& cached = vectors_[index];
        if (!cached) {
            const AccessorView view = accessor_view(index, 3, use);
            read_vectors_ += view.count;
            check_total(read_vectors_, max_vertices, "vertices");
            cached = std::make_shared<const std::vector<glm::dvec3>>(read_vec3(view));
        }
        return cached;
    }

    void check_total(std::size_t total, std::size_t limit, std::string_view what) const {
        if (total <= limit) return;
        fail(fmt::format("the number of {}", what), fmt::to_string(total), fmt::format("the limit is {}", limit));
    }

    // ---- meshes ----

    /// How many corners a primitive has, or 0 where it makes no triangles.
    std::size_t corner_count(const tinygltf::Primitive& source) const {
        const auto positions = source.attributes.find("POSITION");
        if (source.mode < TINYGLTF_MODE_TRIANGLES || positions == source.attributes.end()) return 0;
        return model_.accessors[source.indices >= 0 ? source.indices : positions->second].count;
    }

    /// Limits what the meshes of all nodes add up to, before any is read: a small file can name one mesh very often.
    void check_totals(const std::vector<PlacedNode>& nodes) const {
        std::vector<std::size_t> triangles(model_.meshes.size());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            for (const tinygltf::Primitive& source : model_.meshes[i].primitives) {
                const std::size_t corners = corner_count(source);
                const bool is_list = source.mode == TINYGLTF_MODE_TRIANGLES;
                triangles[i] += is_list ? corners / 3 : std::max<std::size_t>(corners, 2) - 2;
                check_total(triangles[i], max_triangles, fmt::format("triangles of meshes[{}]", i));
            }
        }
        std::size_t all_triangles = 0, all_primitives = 0;
        for (const PlacedNode& node : nodes) {
            const int mesh = model_.nodes[node.index].mesh;
            if (mesh < 0) continue;
            check_total(all_triangles += triangles[mesh], max_triangles, "triangles");
            check_total(all_primitives += model_.meshes[mesh].primitives.size(), max_primitives, "primitives");
        }
    }

    /// The triangles of one primitive in its own space, indices checked. `positions` is its POSITION accessor.
    LocalPrimitive read_primitive(const tinygltf::Primitive& source, int positions, const std::string& object) {
        LocalPrimitive primitive;
        primitive.positions = vectors(positions, "POSITION");
        const bool is_new = finite_.insert(positions).second;
        for (std::size_t i = 0; is_new && i < primitive.positions->size(); ++i) {
            if (const glm::dvec3& p = (*primitive.positions)[i]; !is_finite(p)) {
                fail(fmt::format("accessors[{}] element {} (POSITION of {})", positions, i, object), to_text(p),
                     "a position must be finite");
            }
        }
        const std::size_t vertices = primitive.positions->size();
        if (const auto normals = source.attributes.find("NORMAL"); normals != source.attributes.end()) {
            primitive.normals = vectors(normals->second, "NORMAL");
            if (primitive.normals->size() != vertices) {
                fail(fmt::format("accessors[{}].count (NORMAL of {})", normals->second, object),
                     fmt::to_string(primitive.normals->size()), fmt::format("POSITION has {}", vertices));
            }
        }
        primitive.triangles = assemble_triangles(source.mode, corner_indices(source, vertices, object));
        return primitive;
    }

    /// The vertex of each corner in the order of the file: the indices, or 0, 1, 2... without them.
    std::vector<std::uint32_t> corner_indices(const tinygltf::Primitive& source, std::size_t vertices,
                                              const std::string& object) const {
        if (source.indices < 0) {
            std::vector<std::uint32_t> indices(vertices);
            for (std::size_t i = 0; i < vertices; ++i) indices[i] = std::uint32_t(i);
            return indices;
        }
        const AccessorView view = accessor_view(source.indices, 1, "indices");
        const std::uint32_t restart = UINT32_MAX >> (32 - 8 * component_size(view.type));
        std::vector<std::uint32_t> indices = read_indices(view);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] < vertices && indices[i] != restart) continue;
            fail(fmt::format("accessors[{}] element {} (indices of {})", source.indices, i, object),
                 fmt::to_string(indices[i]),
                 fmt::format("POSITION has {} vertices, and {} is no index", vertices, restart));
        }
        return indices;
    }

    void add_mesh(int node, const glm::dmat4& to_world) {
        const int mesh = model_.nodes[node].mesh;
        if (model_.nodes[node].skin >= 0) {
            warnings_.add("its skin is ignored, it is at rest", fmt::format("nodes[{}]", node));
        }
        const std::optional<Placement> placement = Placement::of(to_world);
        if (!placement) {
            warnings_.add("its mesh is dropped, the transform is singular", fmt::format("nodes[{}]", node));
            return;
        }
        scene_.mesh_nodes.push_back(
            {std::uint32_t(node), model_.nodes[node].name, std::uint32_t(scene_.triangles.size())});
        VertexBlocks blocks;
        for (std::size_t i = 0; i < model_.meshes[mesh].primitives.size(); ++i) {
            add_primitive(node, mesh, i, *placement, blocks);
        }
    }

    /// First vertex in the scene of what primitives of one mesh instance share: their POSITION and NORMAL accessors.
    using VertexBlocks = std::map<std::pair<const void*, const void*>, std::size_t>;

    void add_primitive(int node, int mesh, std::size_t index, const Placement& placement, VertexBlocks& blocks) {
        const tinygltf::Primitive& source = model_.meshes[mesh].primitives[index];
        const std::string object = fmt::format("meshes[{}].primitives[{}]", mesh, index);
        const auto positions = source.attributes.find("POSITION");
        if (source.mode < TINYGLTF_MODE_TRIANGLES) {
            warnings_.add("points and lines are skipped", object);
            return;
        }
        if (positions == source.attributes.end()) {
            warnings_.add("skipped, it has no POSITION", object);
            return;
        }
        if (!source.targets.empty()) warnings_.add("its morph targets are ignored", object);
        if (source.attributes.contains("COLOR_0")) warnings_.add("its vertex colours are ignored", object);

        const std::size_t corners = corner_count(source);
        if (source.mode == TINYGLTF_MODE_TRIANGLES ? corners % 3 != 0 : corners < 3) {
            warnings_.add("the corners that make no triangle are ignored", object);
        }

        auto& local = primitives_[{mesh, index}];
        if (!local) local = read_primitive(source, positions->second, object);
        if (local->normals) {
            add_smooth(*local, placement, material_index(source), first_vertex(*local, node, placement, blocks));
        } else {
            add_flat(*local, node, placement, material_index(source));
        }
    }

    /// A point of the world, checked.
    glm::dvec3 placed(const Placement& placement, const glm::dvec3& local, int node) const {
        const glm::dvec3 p = placement.point(local);
        if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= max_coordinate) || !is_finite(p)) {
            fail(fmt::format("the world position of a vertex of nodes[{}]", node), to_text(p),
                 fmt::format("the limit is {}", max_coordinate));
        }
        return p;
    }

    std::uint32_t add_vertex(const glm::dvec3& position, const glm::vec3& normal) {
        check_total(scene_.positions.size() + 1, max_vertices, "vertices");
        scene_.positions.push_back(position);
        scene_.normals.push_back(normal);
        return std::uint32_t(scene_.positions.size() - 1);
    }

    /// Puts the vertices of a primitive with normals into the scene, once an instance, and returns the first.
    std::size_t first_vertex(const LocalPrimitive& local, int node, const Placement& placement, VertexBlocks& blocks) {
        const auto [block, is_new] =
            blocks.try_emplace({local.positions.get(), local.normals.get()}, scene_.positions.size());
        for (std::size_t i = 0; is_new && i < local.positions->size(); ++i) {
            add_vertex(placed(placement, (*local.positions)[i], node), placement.normal((*local.normals)[i]));
        }
        return block->second;
    }

    /// cross(p1 - p0, p2 - p0) as a unit vector; zero, and counted, where the area is zero.
    glm::vec3 geometric_normal(const std::array<glm::dvec3, 3>& p) {
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(normal);
        if (length > 0.0) return glm::vec3(normal / length);
        ++degenerate_triangles_;
        return glm::vec3(0.0f);
    }

    /// The corners counter-clockwise in the world: a mirroring transform turns them over.
    static Corners wound(Corners corners, const Placement& placement) {
        if (placement.mirrored) std::swap(corners[1], corners[2]);
        return corners;
    }

    void add_smooth(const LocalPrimitive& local, const Placement& placement, std::uint32_t material,
                    std::size_t first) {
        for (const Corners& corners : local.triangles) {
            Triangle triangle{wound(corners, placement), material};
            std::array<glm::dvec3, 3> p;
            for (int k = 0; k < 3; ++k) {
                triangle.vertex[k] += std::uint32_t(first);
                p[k] = scene_.positions[triangle.vertex[k]];
            }
            const glm::vec3 geometric = geometric_normal(p);
            if (geometric == glm::vec3(0.0f)) continue;
            for (int k = 0; k < 3; ++k) {
                if (scene_.normals[triangle.vertex[k]] != glm::vec3(0.0f)) continue;
                triangle.vertex[k] = add_vertex(p[k], geometric);
                warnings_.add("no direction, the triangle's own is used", "a normal");
            }
            scene_.triangles.push_back(triangle);
        }
    }

    /// Three vertices a triangle with its own normal, as glTF 2.0, section 3.7.2.1, asks for where NORMAL is missing.
    void add_flat(const LocalPrimitive& local, int node, const Placement& placement, std::uint32_t material) {
        for (const Corners& corners : local.triangles) {
            Triangle triangle{wound(corners, placement), material};
            std::array<glm::dvec3, 3> p;
            for (int k = 0; k < 3; ++k) p[k] = placed(placement, (*local.positions)[triangle.vertex[k]], node);
            const glm::vec3 geometric = geometric_normal(p);
            if (geometric == glm::vec3(0.0f)) continue;
            for (int k = 0; k < 3; ++k) triangle.vertex[k] = add_vertex(p[k], geometric);
            scene_.triangles.push_back(triangle);
        }
    }

    // ---- the whole ----

    /// From slightly above the front (+z), far enough to see the bounding sphere whole where the image is not upright.
    Camera framing_camera() const {
        glm::dvec3 low(0.0), high(0.0);
        bool first = true;
        for (const Triangle& triangle : scene_.triangles) {
            for (const std::uint32_t vertex : triangle.vertex) {
                low = first ? scene_.positions[vertex] : glm::min(low, scene_.positions[vertex]);
                high = first ? scene_.positions[vertex] : glm::max(high, scene_.positions[vertex]);
                first = false;
            }
        }
        const glm::dvec3 centre = 0.5 * low + 0.5 * high;
        const double radius = first ? 1.0 : 0.5 * glm::length(high - low);
        constexpr double margin = 1.05;
        const glm::dvec3 towards_camera = glm::normalize(glm::dvec3(0.0, 0.35, 1.0));
        Camera camera;
        camera.name = "framing";
        camera.to_world = glm::dmat4(*orthonormal_frame(towards_camera, glm::dvec3(0.0, 1.0, 0.0)));
        const double distance = margin * radius / std::sin(0.5 * camera.yfov);
        camera.to_world[3] = glm::dvec4(centre + distance * towards_camera, 1.0);
        return camera;
    }

    const GltfFile& file_;
    const tinygltf::Model& model_;
    const std::size_t view_count_ = model_.bufferViews.size() - 1;  // the last one is parse_model's
    Scene scene_;
    Warnings warnings_;
    std::map<int, Vectors> vectors_;                                             // by accessor
    std::map<std::pair<int, std::size_t>, std::optional<LocalPrimitive>> primitives_;  // by mesh and primitive
    std::set<int> finite_;                                                       // accessors known to be finite
    std::size_t read_vectors_ = 0;
    std::size_t degenerate_triangles_ = 0;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& path) {
    try {
        const GltfFile file = read_gltf_file(path);
        const tinygltf::Model model = parse_model(file);
        Scene scene = SceneReader(file, model).read();
        scene.file = path;
        return scene;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        bad_scene(path.string(), "its size", "too large", "the memory is exhausted");
    } catch (const std::exception& error) {  // what a library throws on input it does not expect
        bad_scene(path.string(), "the file", "refused", error.what());
    }
}

}  // namespace vkcppm
