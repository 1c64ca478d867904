#pragma once
// KHR_draco_mesh_compression: accessors of primitives out of compressed meshes.

#include "scene/gltf/file.h"

namespace vkcppm {

/// Decodes the primitives of all meshes that a node names and makes of what they hold accessors, bufferViews and
/// buffers behind those of the file, which the primitives then name: nothing after this has to know of Draco. Data that
/// a file keeps beside it for other programs is not read. Throws Error(bad_scene) where the data is broken, is not what
/// the file says of it, or would become too large.
void decode_draco(GltfFile& file);

}  // namespace vkcppm
