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

    /// The place of images[i] among those to decode, the next one on its first use; images with one source share it.
    /// None, with a warning, where its file is not there, lies outside of the file's root, is in a format that only an
    /// extension allows (KTX2, DDS) or is unreadable: the factor alone is a picture that still says something.
    /// glossiness: the factor of that in alpha, of which the image is to hold the roughness, 1 less it, in green.
    /// Throws Error(bad_input) where the image has no source or two or is too large, alone or with the others.
    std::optional<std::uint32_t> index(std::size_t image, std::optional<double> glossiness = {});

    /// Names images[i], which is looked at where that at `place`, of index(), turns out to be broken.
    void set_beside(std::uint32_t place, std::size_t image) { sources_[place].beside = image; }

    struct Taken {
        std::vector<TextureImage> images;
        // [places of index()] into `images`; none, with a warning, where it is broken.
        std::vector<std::optional<std::uint32_t>> at;
    };

    /// Decodes all, each once, on all cores. Throws Error(bad_input) where memory is too little for them.
    Taken take_images();

    /// FNV-1a of the file's hash and of each external image's bytes.
    std::uint64_t hash() const { return hash_; }

private:
    /// A picture that is not decoded yet.
    struct Source {
        std::string name;
        std::string object;  // what it is in the file, for messages
        std::vector<std::uint8_t> own_bytes;
        std::span<const std::uint8_t> bytes;  // those, or of a bufferView
        std::optional<double> glossiness{};
        std::optional<std::size_t> beside{};  // of the file's images, see set_beside
    };
    std::optional<std::uint32_t> add(Source source);
    std::vector<std::string> decode_from(std::size_t first);

    const GltfFile& file_;
    GltfViews& views_;
    Warnings& warnings_;
    std::vector<TextureImage> images_;  // without texels until they are taken
    std::vector<Source> sources_;       // of each
    std::map<std::string, std::optional<std::uint32_t>> by_source_;
    std::size_t bytes_ = 0, texels_ = 0;  // of all so far
    std::uint64_t hash_;
};

}  // namespace vkcppm
