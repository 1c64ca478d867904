#pragma once
// KHR_draco_mesh_compression: accessors of primitives out of compressed meshes.

#include "scene/gltf/file.h"
#include "scene/warnings.h"

namespace vkcppm {

/// Decodes the primitives of all meshes that a node names and makes of what they hold accessors, bufferViews and
/// buffers behind those of the file, which the primitives then name: nothing after this has to know of Draco. Where
/// its data is broken, is not what the file says of it, or would become too large, what the file keeps beside it for
/// other programs takes its place, with a warning; Error(bad_input) is thrown where there is none.
void decode_draco(GltfFile& file, Warnings& warnings);

}  // namespace vkcppm
