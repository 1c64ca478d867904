#pragma once
// The materials of a glTF file.

#include <array>
#include <vector>

#include "scene/gltf/file.h"
#include "scene/gltf/images.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

/// All materials of the file, in its order. Textures are read where is_used[i], and only those that change something:
/// what multiplies a factor of zero is left out. Images that they need are decoded by `images`.
/// Throws Error(bad_input) with object, value, limit and file where a number cannot be rendered; a factor that is
/// merely outside of its range is clamped with a warning.
std::vector<Material> read_materials(const GltfFile& file, const std::vector<bool>& is_used, GltfImages& images,
                                     Warnings& warnings);

/// Has textures name images by where they are once they are decoded, GltfImages::Taken::at; those of broken images are
/// gone.
void place_images(std::vector<Material>& materials, const std::vector<std::optional<std::uint32_t>>& at);

/// What a material reads of a vertex beside position, normal and colour.
struct VertexNeeds {
    std::array<bool, 2> uv{};
    bool tangents = false;  // for a normal texture or anisotropy
    bool frame = false;     // tangents, else TEXCOORD_0, from which they follow: of anisotropy without a texture
};
VertexNeeds vertex_needs(const Material& material);

}  // namespace vkcppm
