#pragma once
// The cameras of a glTF file.

#include <optional>

#include "scene/gltf/file.h"
#include "scene/gltf/nodes.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

/// The camera of a node; none where it has none or, with a warning, one that is flat. zfar and znear cut nothing.
/// Throws Error(bad_input) where its angle, its size or its aspect ratio is out of range.
std::optional<Camera> read_camera(const GltfFile& file, const tinygltf::Model& model, const PlacedNode& placed,
                                  Warnings& warnings);

/// From slightly above the front (+z), far enough to see the bounding sphere whole where the image is not upright.
Camera framing_camera(const Scene& scene);

}  // namespace vkcppm
