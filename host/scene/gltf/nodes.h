#pragma once
// Where the nodes of a glTF file stand in the world.

#include <vector>

#include <glm/mat4x4.hpp>

#include "scene/gltf/accessors.h"
#include "scene/gltf/file.h"
#include "scene/warnings.h"

namespace vkcppm {

struct PlacedNode {
    int index;
    glm::dmat4 to_world;
    bool is_visible = true;  // KHR_node_visibility, of itself and all above it: its mesh and its light count
};

/// The nodes of the default scene (else of the first, else all) and all below them, depth first, in the order of the
/// file. Throws Error(bad_input) where the nodes form no trees or a transform is not affine or not finite.
std::vector<PlacedNode> place_nodes(const GltfFile& file, const tinygltf::Model& model, Warnings& warnings);

/// How often a node shows its mesh: once, or as often as EXT_mesh_gpu_instancing says. Reads no accessor.
/// Throws Error(bad_input) where the extension's attributes disagree.
std::size_t instance_count(const GltfFile& file, const GltfAccessors& accessors, int node);

/// [instance_count] transforms to the world: the node's after each instance's translation * rotation * scale.
/// Throws Error(bad_input) where an instance's transform is not finite.
std::vector<glm::dmat4> instances(const GltfFile& file, GltfAccessors& accessors, const PlacedNode& node,
                                  Warnings& warnings);

}  // namespace vkcppm
