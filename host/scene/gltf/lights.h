#pragma once
// The punctual lights of a glTF file (KHR_lights_punctual).

#include <optional>

#include "scene/gltf/file.h"
#include "scene/gltf/nodes.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

/// The light of a node, in the world; none where it has none or, with a warning, points nowhere.
/// Throws Error(bad_scene) where its intensity or its cone is out of range.
std::optional<PunctualLight> read_light(const GltfFile& file, const tinygltf::Model& model, const PlacedNode& placed,
                                        Warnings& warnings);

}  // namespace vkcppm
