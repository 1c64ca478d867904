#pragma once
// KHR_materials_variants: other materials for the same meshes, by the name of what they make.

#include <string>

#include "scene/gltf/file.h"

namespace tinygltf {
class Model;
}

namespace vkcppm {

/// Gives every primitive the material that it has in the variant of that name or index; one without keeps its own.
/// Throws Error(usage) where there is no such variant.
void use_variant(const GltfFile& file, tinygltf::Model& model, const std::string& variant);

}  // namespace vkcppm
