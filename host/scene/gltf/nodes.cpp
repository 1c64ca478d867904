#include "scene/gltf/nodes.h"

#include <cmath>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/values.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr const char* instancing = "EXT_mesh_gpu_instancing";

constexpr glm::dquat no_rotation(1.0, 0.0, 0.0, 0.0);  // glm: w first

/// The rotation of a quaternion (x, y, z, w) of any length, which object() names; none, with a warning, where it is
/// zero, as exporters leave one that nobody has set.
template <typename Object>
glm::dquat unit_rotation(const glm::dvec4& q, const Object& object, const std::string& file, Warnings& warnings) {
    const double length = glm::length(q);
    if (length == 0.0) {
        warnings.add("a quaternion of zeros, taken for no rotation", object());
        return no_rotation;
    }
    if (!std::isfinite(length)) {
        bad_scene(file, object(), fmt::format("({}, {}, {}, {})", q.x, q.y, q.z, q.w), "it must be a unit quaternion");
    }
    constexpr double rounding = 0.02;  // of bytes, in which glTF has rotations as well
    if (std::abs(length - 1.0) > rounding) warnings.add("not a unit quaternion, normalised", object());
    return glm::dquat(q.w, q.x, q.y, q.z) / length;  // glm: w first
}

/// translation * rotation * scale
glm::dmat4 compose(const glm::dvec3& translation, const glm::dquat& rotation, const glm::dvec3& scale) {
    glm::dmat4 transform = glm::mat4_cast(rotation);
    for (int c = 0; c < 3; ++c) transform[c] *= scale[c];
    transform[3] = glm::dvec4(translation, 1.0);
    return transform;
}

template <typename Object>
void check_finite(const glm::dmat4& to_world, const Object& object, const std::string& file) {
    for (int column = 0; column < 4; ++column) {
        if (is_finite(glm::dvec3(to_world[column]))) continue;
        bad_scene(file, fmt::format("column {} of the world transform of {}", column, object()),
                  to_text(to_world[column]), "it must be finite");
    }
}

/// The attributes of EXT_mesh_gpu_instancing; null where the node has none.
const json* instance_attributes(const GltfFile& file, int node) {
    const json& source = file.document["nodes"][node];
    const auto extensions = source.find("extensions");
    if (extensions == source.end() || !extensions->contains(instancing)) return nullptr;
    return &(*extensions)[instancing]["attributes"];
}

std::string attributes_name(int node) { return fmt::format("nodes[{}].extensions.{}.attributes", node, instancing); }

/// [nodes] the parent of each node, or -1. A node has one parent at most and is not its own ancestor.
std::vector<int> parents(const GltfFile& file, const tinygltf::Model& model) {
    std::vector<int> parent(model.nodes.size(), -1);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (const int child : model.nodes[i].children) {
            if (parent[child] >= 0) {
                bad_scene(file.name, fmt::format("nodes[{}]", child),
                          fmt::format("a child of nodes[{}] and nodes[{}]", parent[child], i), "a node has one parent");
            }
            parent[child] = int(i);
        }
    }
    std::vector<int> reached_from(model.nodes.size(), -1);
    for (int i = 0; i < int(model.nodes.size()); ++i) {
        int node = i;
        while (node >= 0 && reached_from[node] < 0) {
            reached_from[node] = i;
            node = parent[node];
        }
        if (node >= 0 && reached_from[node] == i) {
            bad_scene(file.name, fmt::format("nodes[{}]", node), "its own ancestor", "the nodes must form trees");
        }
    }
    return parent;
}

/// The nodes of the default scene, else of the first, else all that have no parent.
std::vector<int> root_nodes(const GltfFile& file, const tinygltf::Model& model) {
    const std::vector<int> parent = parents(file, model);
    std::vector<int> roots;
    if (model.scenes.empty()) {
        for (int i = 0; i < int(parent.size()); ++i) {
            if (parent[i] < 0) roots.push_back(i);
        }
        return roots;
    }
    const int scene = std::max(model.defaultScene, 0);
    roots = model.scenes[scene].nodes;
    std::vector<bool> listed(parent.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const std::string object = fmt::format("scenes[{}].nodes[{}]", scene, i);
        const int node = roots[i];
        if (parent[node] >= 0) {
            bad_scene(file.name, object, fmt::to_string(node),
                      fmt::format("a root has no parent, it has nodes[{}]", parent[node]));
        }
        if (listed[node]) bad_scene(file.name, object, fmt::to_string(node), "the scene lists it already");
        listed[node] = true;
    }
    return roots;
}

/// The matrix of a node, or translation * rotation * scale.
glm::dmat4 local_transform(const GltfFile& file, const tinygltf::Model& model, int index, Warnings& warnings) {
    const tinygltf::Node& node = model.nodes[index];
    if (!node.matrix.empty()) {
        for (const char* member : {"translation", "rotation", "scale"}) {
            if (file.document["nodes"][index].contains(member)) {
                warnings.add("ignored beside a matrix", fmt::format("nodes[{}].{}", index, member));
            }
        }
        glm::dmat4 matrix = glm::make_mat4(node.matrix.data());
        for (int column = 0; column < 4; ++column) {
            constexpr double rounding = 1e-5;  // of products of matrices in floats
            const double expected = column == 3 ? 1.0 : 0.0;
            if (!(std::abs(matrix[column][3] - expected) <= rounding)) {
                bad_scene(file.name, fmt::format("nodes[{}].matrix[{}]", index, 4 * column + 3),
                          fmt::to_string(matrix[column][3]), fmt::format("it must be {}", expected));
            }
            matrix[column][3] = expected;
        }
        return matrix;
    }
    glm::dvec3 translation(0.0), scale(1.0);
    glm::dquat rotation = no_rotation;
    if (!node.translation.empty()) translation = glm::make_vec3(node.translation.data());
    if (!node.scale.empty()) scale = glm::make_vec3(node.scale.data());
    if (!node.rotation.empty()) {
        const auto object = [&] { return fmt::format("nodes[{}].rotation", index); };
        rotation = unit_rotation(glm::make_vec4(node.rotation.data()), object, file.name, warnings);
    }
    return compose(translation, rotation, scale);
}

/// KHR_node_visibility.
bool is_visible(const GltfFile& file, int node) {
    static const json::json_pointer pointer("/extensions/KHR_node_visibility/visible");
    return file.document["nodes"][node].value(pointer, true);
}

}  // namespace

std::vector<PlacedNode> place_nodes(const GltfFile& file, const tinygltf::Model& model, Warnings& warnings) {
    const std::vector<int> roots = root_nodes(file, model);
    std::vector<PlacedNode> placed;
    std::vector<PlacedNode> stack;  // with the parent's transform; no recursion: the depth of the tree is free
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, glm::dmat4(1.0)});
    while (!stack.empty()) {
        const PlacedNode top = stack.back();
        stack.pop_back();
        const int index = top.index;
        const tinygltf::Node& node = model.nodes[index];
        const glm::dmat4 to_world = top.to_world * local_transform(file, model, index, warnings);
        check_finite(
            to_world, [&] { return fmt::format("nodes[{}]", index); }, file.name);
        placed.push_back({index, to_world, top.is_visible && is_visible(file, index)});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
            stack.push_back({*child, to_world, placed.back().is_visible});
        }
    }
    return placed;
}

std::size_t instance_count(const GltfFile& file, const GltfAccessors& accessors, int node) {
    const json* attributes = instance_attributes(file, node);
    if (!attributes) return 1;
    std::optional<std::size_t> count;
    for (const auto& [name, accessor] : attributes->items()) {
        const std::size_t found = accessors.count(accessor.get<int>());
        if (count.value_or(found) != found) {
            bad_scene(file.name,
                      fmt::format("accessors[{}].count ({} of {})", accessor.get<int>(), name, attributes_name(node)),
                      fmt::to_string(found), fmt::format("the attributes before it have {}", *count));
        }
        count = found;
    }
    return count.value_or(0);
}

std::vector<glm::dmat4> instances(const GltfFile& file, GltfAccessors& accessors, const PlacedNode& node,
                                  Warnings& warnings) {
    const json* attributes = instance_attributes(file, node.index);
    if (!attributes) return {node.to_world};
    SharedVectors<3> translations, scales;
    SharedVectors<4> rotations;
    if (attributes->contains("TRANSLATION")) {
        translations = accessors.vectors<3>((*attributes)["TRANSLATION"], "TRANSLATION");
    }
    if (attributes->contains("ROTATION")) rotations = accessors.vectors<4>((*attributes)["ROTATION"], "ROTATION");
    if (attributes->contains("SCALE")) scales = accessors.vectors<3>((*attributes)["SCALE"], "SCALE");
    std::vector<glm::dmat4> to_world(instance_count(file, accessors, node.index));
    for (std::size_t i = 0; i < to_world.size(); ++i) {
        const auto object = [&] { return fmt::format("element {} of {}", i, attributes_name(node.index)); };
        const glm::dquat rotation =
            rotations ? unit_rotation((*rotations)[i], object, file.name, warnings) : no_rotation;
        to_world[i] = node.to_world * compose(translations ? (*translations)[i] : glm::dvec3(0.0), rotation,
                                              scales ? (*scales)[i] : glm::dvec3(1.0));
        check_finite(to_world[i], object, file.name);
    }
    return to_world;
}

}  // namespace vkcppm
