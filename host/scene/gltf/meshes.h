#pragma once
// The meshes of a glTF file as triangles of the world, or stored once where many nodes show them.

#include <vector>

#include "scene/gltf/accessors.h"
#include "scene/gltf/file.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/sharing.h"
#include "scene/gltf/skins.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

/// [materials of the file] whether a triangle below the nodes uses it.
std::vector<bool> used_materials(const GltfFile& file, const tinygltf::Model& model,
                                 const std::vector<PlacedNode>& nodes);

/// Adds the triangles of all nodes' meshes, instances included, to `scene`, or the meshes that are shared and their
/// instances. The scene's materials are read already; the material of those that name none comes after them. Vertex
/// attributes that no material reads are left out. Morph targets stand at their weights, skins where their joints are.
/// Throws Error(bad_input) where an accessor is out of range or not finite, or the totals are above limits.h.
void add_meshes(const GltfFile& file, const tinygltf::Model& model, GltfAccessors& accessors, GltfSkins& skins,
                const std::vector<PlacedNode>& nodes, Sharing sharing, Scene& scene, Warnings& warnings);

}  // namespace vkcppm
