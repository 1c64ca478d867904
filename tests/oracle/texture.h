#pragma once
// Texture lookup by the letter of glTF: no mipmaps.

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "oracle/intersect.h"
#include "scene/scene.h"

namespace vkcppm::oracle {

enum class Encoding { linear, srgb };  // of the colours; alpha is always linear

/// The texture at (u, v) before its transform, v downwards, each channel in [0, 1]: bilinear between texel centres (at
/// half integers) or the nearest texel, wrapped; sRGB is decoded (IEC 61966-2-1) before interpolation.
glm::dvec4 lookup(const Texture& texture, const TextureImage& image, const glm::dvec2& uv, Encoding encoding);

/// Texture coordinates of `set` at a hit; (0, 0) where the scene has none.
glm::dvec2 uv_at(const Scene& scene, const Hit& hit, std::uint32_t set);

/// The texture at a hit; white where there is none.
glm::dvec4 lookup(const Scene& scene, const Hit& hit, const std::optional<Texture>& texture, Encoding encoding);

}  // namespace vkcppm::oracle
