#pragma once
// The skins of a glTF file: where joints put the vertices of a mesh.

#include <map>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "scene/gltf/accessors.h"
#include "scene/gltf/file.h"
#include "scene/gltf/nodes.h"
#include "scene/warnings.h"

namespace vkcppm {

/// [joints] what places a vertex that follows one joint alone: joint to world * inverse bind.
using JointMatrices = std::vector<glm::dmat4>;

class GltfSkins {
public:
    /// `nodes` are all that are placed. Keeps what is given.
    GltfSkins(const GltfFile& file, GltfAccessors& accessors, const std::vector<PlacedNode>& nodes, Warnings& warnings);

    /// The joints of the skin of a node with a mesh (glTF 2.0, section 3.7.3); null where it has none or, with a
    /// warning, one with a joint outside of the scene. Throws Error(bad_input) where the matrices cannot be read.
    const JointMatrices* joints(int node);

private:
    std::optional<JointMatrices> read(std::size_t skin);

    const GltfFile& file_;
    GltfAccessors& accessors_;
    std::map<int, glm::dmat4> to_world_;  // of the placed nodes
    Warnings& warnings_;
    std::map<std::size_t, std::optional<JointMatrices>> skins_;
};

}  // namespace vkcppm
