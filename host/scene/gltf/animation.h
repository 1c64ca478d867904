#pragma once
// The animations of a glTF file: at a time they are other transforms of nodes and other weights of morph targets.

#include <string>

#include "scene/gltf/accessors.h"
#include "scene/gltf/file.h"
#include "scene/warnings.h"

namespace tinygltf {
class Model;
}

namespace vkcppm {

/// Puts the nodes where the animation of that name or index has them after so many seconds, with "all" where all have
/// them one after the other: a pose that is read like a file at rest. Before its first key frame and after its last a
/// channel stands still (glTF 2.0, section 3.11). `file` and `model` are changed alike.
/// Throws Error: usage where there is no such animation, bad_input where a channel of it cannot be read.
void pose_nodes(GltfFile& file, tinygltf::Model& model, GltfAccessors& accessors, const std::string& animation,
                double seconds, Warnings& warnings);

}  // namespace vkcppm
