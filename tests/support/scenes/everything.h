#pragma once
// One small scene that has all that the loader reads.

#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

/// Quantised and sparse accessors, strips, both sets of texture coordinates, colours, tangents, morph targets,
/// compressed views, instances, every kind of light, a camera, and materials with every extension and texture.
GltfBuilder everything();

}  // namespace vkcppm::test
