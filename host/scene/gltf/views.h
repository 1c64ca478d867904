#pragma once
// The bufferViews of a glTF file as bytes, decompressed where they have to be.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/file.h"

namespace vkcppm {

class GltfViews {
public:
    /// Throws Error(bad_input) where a view, or its compressed data, is outside of its buffer. Keeps `file`.
    explicit GltfViews(const GltfFile& file);

    std::size_t count() const { return views_.size(); }

    /// byteLength.
    std::size_t size(std::size_t view) const { return views_[view].size; }

    /// byteStride, 0 where the file states none.
    std::size_t stride(std::size_t view) const { return views_[view].stride; }

    /// [size] the bytes of a view, decompressed once (meshopt_extension). Throws Error(bad_input) where the
    /// buffer is absent or its data is broken.
    std::span<const std::uint8_t> bytes(std::size_t view);

private:
    struct View {
        std::size_t buffer, offset, size, stride;
    };
    View range(const nlohmann::json& source, const std::string& object) const;
    std::span<const std::uint8_t> stored(const View& view) const;

    const GltfFile& file_;
    std::vector<View> views_;
    std::map<std::size_t, View> compressed_;  // by view: where its compressed bytes are
    std::map<std::size_t, std::vector<std::uint8_t>> decoded_;
    std::size_t decoded_size_ = 0;
};

}  // namespace vkcppm
