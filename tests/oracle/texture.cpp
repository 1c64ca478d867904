#include "oracle/texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/mat2x2.hpp>

namespace vkcppm::oracle {
namespace {

/// Index of a texel anywhere on the plane to one of the image.
std::int64_t wrapped(std::int64_t i, std::int64_t size, Texture::Wrap wrap) {
    const auto modulo = [&](std::int64_t period) { return (i % period + period) % period; };
    switch (wrap) {
        case Texture::Wrap::repeat: return modulo(size);
        case Texture::Wrap::mirrored_repeat: {
            const std::int64_t place = modulo(2 * size);
            return place < size ? place : 2 * size - 1 - place;
        }
        case Texture::Wrap::clamp_to_edge: return std::clamp<std::int64_t>(i, 0, size - 1);
    }
    return 0;
}

double decode_srgb(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

}  // namespace

glm::dvec4 lookup(const Texture& texture, const TextureImage& image, const glm::dvec2& uv, Encoding encoding) {
    const glm::dvec2 place = (glm::dmat2(texture.matrix) * uv + glm::dvec2(texture.offset)) *
                             glm::dvec2(image.size.width, image.size.height);
    const auto texel = [&](double x, double y) {
        const auto column = wrapped(std::int64_t(x), image.size.width, texture.wrap_s);
        const auto row = wrapped(std::int64_t(y), image.size.height, texture.wrap_t);
        const std::size_t first = 4 * (std::size_t(row) * image.size.width + column);
        const std::uint8_t* rgba = &image.rgba[first];
        glm::dvec4 value = glm::dvec4(rgba[0], rgba[1], rgba[2], rgba[3]) / 255.0;
        for (int c = 0; c < 4 && !image.rest.empty(); ++c) value[c] += image.rest[first + c] / 65535.0;
        if (encoding == Encoding::srgb) {
            value = {decode_srgb(value.r), decode_srgb(value.g), decode_srgb(value.b), value.a};
        }
        return value;
    };
    if (texture.nearest) return texel(std::floor(place.x), std::floor(place.y));
    const glm::dvec2 corner = glm::floor(place - 0.5), part = place - 0.5 - corner;
    return glm::mix(glm::mix(texel(corner.x, corner.y), texel(corner.x + 1.0, corner.y), part.x),
                    glm::mix(texel(corner.x, corner.y + 1.0), texel(corner.x + 1.0, corner.y + 1.0), part.x), part.y);
}

glm::dvec2 uv_at(const Scene& scene, const Hit& hit, std::uint32_t set) {
    const auto& uv = scene.uv[set];
    const auto& v = scene.triangles[hit.triangle].vertex;
    return uv.empty() ? glm::dvec2(0.0)
                      : hit.barycentric.x * glm::dvec2(uv[v[0]]) + hit.barycentric.y * glm::dvec2(uv[v[1]]) +
                            hit.barycentric.z * glm::dvec2(uv[v[2]]);
}

glm::dvec4 lookup(const Scene& scene, const Hit& hit, const std::optional<Texture>& texture, Encoding encoding) {
    return texture ? lookup(*texture, scene.images[texture->image], uv_at(scene, hit, texture->uv_set), encoding)
                   : glm::dvec4(1.0);
}

}  // namespace vkcppm::oracle
