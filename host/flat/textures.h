#pragma once
// The images of a scene as the kernels read them: words in one buffer, and a record for each way of looking one up.

#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec4.hpp>

#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// Words that the kernels read of an image: one a texel for each of its planes.
std::size_t texels_of(const TextureImage& image);

class TextureTable {
public:
    explicit TextureTable(const Scene& scene);

    /// 1 + index of the lookup of this texture, 0 where there is none. srgb: its colours are sRGB-encoded.
    std::uint32_t add(const std::optional<Texture>& texture, bool srgb);

    const std::vector<gpu::TextureLookup>& lookups() const { return lookups_; }
    /// Planes that are looked up, one after the other, a word a texel (red in the lowest byte): of an image of 8 bits
    /// one, of 16 bits two, the second with what they have beyond 8. Colours of 16 bits are linear there.
    std::vector<std::uint32_t> take_texels() { return std::move(texels_); }

private:
    const Scene& scene_;
    /// First texels.
    struct Planes {
        std::uint32_t first, fine;
    };
    Planes planes_of(std::uint32_t image, bool srgb);
    std::uint32_t append(const void* plane, std::size_t bytes);

    std::vector<std::optional<Planes>> data_, colors_;  // of each image as it is, and of 16 bits made linear
    std::vector<gpu::TextureLookup> lookups_;
    std::vector<std::uint32_t> texels_;
};

/// The texel of `texture` that is nearest to uv, linear: good enough to weigh lights, which the kernels then look up
/// exactly.
glm::vec4 nearest_texel(const Scene& scene, const Texture& texture, const glm::vec2& uv, bool srgb);

/// Texel (x, y) of an image, linear. srgb: its colours are sRGB-encoded.
glm::vec4 texel_of(const TextureImage& image, std::uint32_t x, std::uint32_t y, bool srgb);

/// The texel of an image of `size` texels along an axis that stands at index i, which may be anywhere.
std::uint32_t wrapped_texel(std::int64_t i, std::uint32_t size, Texture::Wrap wrap);

}  // namespace vkcppm
