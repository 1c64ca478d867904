#include "flat/textures.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/sixteen_bits.h"
#include "core/srgb.h"

namespace vkcppm {
namespace {

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

/// Of an image of 16 bits whose colours are sRGB-encoded: those of linear light, to 1 / 65535, which is finer than 8
/// bits of sRGB throughout.
std::pair<std::vector<std::uint8_t>, std::vector<std::int8_t>> linear_planes(const TextureImage& image) {
    static const auto table = [] {
        std::vector<SixteenBits> linear(65536);
        for (std::uint32_t i = 0; i < linear.size(); ++i) {
            linear[i] = split_16_bits(std::uint32_t(std::lround(65535.0f * srgb_to_linear(float(i) / 65535.0f))));
        }
        return linear;
    }();
    std::vector<std::uint8_t> rgba = image.rgba;
    std::vector<std::int8_t> rest = image.rest;
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        if (i % 4 == 3) continue;  // alpha
        const auto [byte, beyond] = table[257u * rgba[i] + rest[i]];
        rgba[i] = byte;
        rest[i] = beyond;
    }
    return {std::move(rgba), std::move(rest)};
}

}  // namespace

std::size_t texels_of(const TextureImage& image) { return image.size.pixels() * (image.rest.empty() ? 1 : 2); }

TextureTable::TextureTable(const Scene& scene)
    : scene_(scene), data_(scene.images.size()), colors_(scene.images.size()) {
    std::size_t texels = 0;
    for (const TextureImage& image : scene.images) texels += texels_of(image);
    texels_.reserve(texels);
}

std::uint32_t TextureTable::append(const void* plane, std::size_t bytes) {
    const auto first = std::uint32_t(texels_.size());
    texels_.resize(texels_.size() + bytes / sizeof(std::uint32_t));
    std::memcpy(texels_.data() + first, plane, bytes);
    return first;
}

TextureTable::Planes TextureTable::planes_of(std::uint32_t index, bool srgb) {
    const TextureImage& image = scene_.images.at(index);
    const bool is_fine = !image.rest.empty();
    std::optional<Planes>& planes = srgb && is_fine ? colors_[index] : data_[index];
    if (planes) return *planes;
    if (srgb && is_fine) {
        const auto [rgba, rest] = linear_planes(image);
        planes = {append(rgba.data(), rgba.size()), append(rest.data(), rest.size())};
    } else {
        planes = {append(image.rgba.data(), image.rgba.size()), 0u};
        if (is_fine) planes->fine = append(image.rest.data(), image.rest.size());
    }
    return *planes;
}

std::uint32_t TextureTable::add(const std::optional<Texture>& texture, bool srgb) {
    if (!texture) return 0;
    const TextureImage& image = scene_.images.at(texture->image);
    gpu::TextureLookup lookup{};
    const auto [first, fine] = planes_of(texture->image, srgb);
    lookup.first = first;
    lookup.fine = fine;
    lookup.width = image.size.width;
    lookup.height = image.size.height;
    lookup.flags = wrap_flag(texture->wrap_s) | wrap_flag(texture->wrap_t) << 2 |
                   (texture->nearest ? TEXTURE_NEAREST : 0u) | (texture->uv_set == 1 ? TEXTURE_SECOND_UV : 0u) |
                   (srgb && fine == 0 ? TEXTURE_SRGB : 0u);
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
    const std::size_t first = 4 * (std::size_t(y) * image.size.width + x);
    glm::vec4 value;
    for (int c = 0; c < 4; ++c) {
        value[c] = float(image.rgba[first + c]) / 255.0f;
        if (!image.rest.empty()) value[c] += float(image.rest[first + c]) / 65535.0f;
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
