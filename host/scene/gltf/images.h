#pragma once
// The images of a glTF file that its materials need, decoded.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/file.h"
#include "scene/gltf/views.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

class GltfImages {
public:
    /// Keeps all three.
    GltfImages(const GltfFile& file, GltfViews& views, Warnings& warnings);

    /// The place of images[i] among those decoded, which it is on its first use; images with one source share it. None,
    /// with a warning, where its file is not there or in a format that only an extension allows (KTX2, WebP, DDS):
    /// the factor alone is a picture that still says something.
    /// Throws Error(bad_scene) where the image has no source or two, lies outside of the scene's folder, is broken, or
    /// is too large, alone or with the others.
    std::optional<std::uint32_t> index(std::size_t image);

    /// Hands over what was decoded, in the order of index().
    std::vector<TextureImage> take_images() { return std::move(images_); }

    /// FNV-1a of the file's hash and of each external image's bytes.
    std::uint64_t hash() const { return hash_; }

private:
    std::optional<std::uint32_t> decode(std::span<const std::uint8_t> bytes, const std::string& name,
                                        const std::string& object);

    const GltfFile& file_;
    GltfViews& views_;
    Warnings& warnings_;
    std::vector<TextureImage> images_;
    std::map<std::string, std::optional<std::uint32_t>> by_source_;
    std::size_t texels_ = 0;
    std::uint64_t hash_;
};

}  // namespace vkcppm
