#include "flat/textures.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/srgb.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t absent = 0xffffffffu;

std::uint32_t wrap_flag(Texture::Wrap wrap) {
    switch (wrap) {
        case Texture::Wrap::repeat: return WRAP_REPEAT;
        case Texture::Wrap::mirrored_repeat: return WRAP_MIRRORED;
        case Texture::Wrap::clamp_to_edge: return WRAP_CLAMP;
    }
    return WRAP_REPEAT;
}

/// As wrap_coordinate of shaders/include/texture.glsl.
float wrapped(float u, Texture::Wrap wrap) {
    switch (wrap) {
        case Texture::Wrap::repeat: return u - std::floor(u);
        case Texture::Wrap::mirrored_repeat: return 1.0f - std::abs(u - 2.0f * std::floor(0.5f * u) - 1.0f);
        case Texture::Wrap::clamp_to_edge: return std::clamp(u, 0.0f, 1.0f);
    }
    return u;
}

}  // namespace

TextureTable::TextureTable(const Scene& scene) : scene_(scene), first_(scene.images.size(), absent) {}

std::uint32_t TextureTable::add(const std::optional<Texture>& texture, bool srgb) {
    if (!texture) return 0;
    const TextureImage& image = scene_.images.at(texture->image);
    std::uint32_t& first = first_[texture->image];
    if (first == absent) {
        first = std::uint32_t(texels_.size());
        texels_.resize(texels_.size() + image.size.pixels());
        std::memcpy(texels_.data() + first, image.rgba.data(), image.size.pixels() * sizeof(std::uint32_t));
    }
    gpu::TextureLookup lookup{};
    lookup.first = first;
    lookup.width = image.size.width;
    lookup.height = image.size.height;
    lookup.flags = wrap_flag(texture->wrap_s) | wrap_flag(texture->wrap_t) << 2 |
                   (texture->nearest ? TEXTURE_NEAREST : 0u) | (texture->uv_set == 1 ? TEXTURE_SECOND_UV : 0u) |
                   (srgb ? TEXTURE_SRGB : 0u);
    const glm::mat2& m = texture->matrix;  // columns
    lookup.matrix = {m[0][0], m[1][0], m[0][1], m[1][1]};
    lookup.offset = texture->offset;
    lookups_.push_back(lookup);
    return std::uint32_t(lookups_.size());
}

glm::vec4 nearest_texel(const Scene& scene, const Texture& texture, const glm::vec2& uv, bool srgb) {
    const TextureImage& image = scene.images.at(texture.image);
    const glm::vec2 at = texture.matrix * uv + texture.offset;
    const auto index = [](float u, std::uint32_t size) { return std::min(std::uint32_t(u * float(size)), size - 1); };
    const std::uint32_t x = index(wrapped(at.x, texture.wrap_s), image.size.width);
    const std::uint32_t y = index(wrapped(at.y, texture.wrap_t), image.size.height);
    return texel_of(image, x, y, srgb);
}

glm::vec4 texel_of(const TextureImage& image, std::uint32_t x, std::uint32_t y, bool srgb) {
    const std::uint8_t* rgba = image.rgba.data() + 4 * (std::size_t(y) * image.size.width + x);
    glm::vec4 value;
    for (int c = 0; c < 4; ++c) {
        value[c] = float(rgba[c]) / 255.0f;
        if (srgb && c < 3) value[c] = srgb_to_linear(value[c]);
    }
    return value;
}

std::uint32_t wrapped_texel(std::int64_t i, std::uint32_t size, Texture::Wrap wrap) {
    const std::int64_t n = size;
    if (wrap == Texture::Wrap::clamp_to_edge) return std::uint32_t(std::clamp<std::int64_t>(i, 0, n - 1));
    const std::int64_t period = wrap == Texture::Wrap::repeat ? n : 2 * n;
    const std::int64_t place = (i % period + period) % period;
    return std::uint32_t(place < n ? place : period - 1 - place);
}

}  // namespace vkcppm
