#pragma once
// Meshes compressed by Draco, made by the library's own encoder.

#include <cstddef>

#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

struct DracoFormat {
    bool sequential = false;  // else by edgebreaker, which puts triangles and vertices into another order
    int position_bits = 0;    // 0: as they are
};

/// Compresses meshes[mesh].primitives[0], a list of triangles with indices of two bytes and packed attributes, by
/// KHR_draco_mesh_compression. Its accessors lose their data.
void compress_by_draco(GltfBuilder& builder, std::size_t mesh, const DracoFormat& format = {});

}  // namespace vkcppm::test
