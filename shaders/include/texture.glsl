// Texture lookups: images as words in one texel buffer. Reads textures and texels.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#include "include/kernel.glsl"

TEXTURES(RECORDS)
IMAGES(TEXELS)

vec3 srgb_to_linear(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// A coordinate within the image for any number: one period of the wrapping.
float wrap_coordinate(float u, uint mode) {
    if (mode == WRAP_REPEAT) return u - floor(u);
    if (mode == WRAP_MIRRORED) return 1.0 - abs(u - 2.0 * floor(0.5 * u) - 1.0);
    return clamp(u, 0.0, 1.0);
}

// Index of a texel that may lie one beyond either end.
int wrap_index(int i, int size, uint mode) {
    if (mode == WRAP_REPEAT) return i < 0 ? i + size : i >= size ? i - size : i;
    return clamp(i, 0, size - 1);  // beyond a mirrored edge comes the edge itself
}

// plane: 1 for what 16 bits have beyond 8, else 0.
vec4 texel_at(TextureLookup lookup, uint plane, int x, int y) {
    x = wrap_index(x, int(lookup.width), lookup.flags & TEXTURE_WRAP_S);
    y = wrap_index(y, int(lookup.height), (lookup.flags & TEXTURE_WRAP_T) >> 2u);
    uint at = (plane == 0u ? lookup.first : lookup.fine) + uint(y) * lookup.width + uint(x);
    uint word = texelFetch(images_texels, int(at >> 2u))[at & 3u];
    vec4 c = plane == 0u ? unpackUnorm4x8(word) : unpackSnorm4x8(word) * FINE_SCALE;
    if ((lookup.flags & TEXTURE_SRGB) != 0u) c.rgb = srgb_to_linear(c.rgb);
    return c;
}

// At uv in texels, bilinear between texel centres or the nearest one.
vec4 plane_at(TextureLookup lookup, uint plane, vec2 uv) {
    if ((lookup.flags & TEXTURE_NEAREST) != 0u) {
        ivec2 i = ivec2(min(uv, vec2(lookup.width, lookup.height) - 1.0));
        return texel_at(lookup, plane, i.x, i.y);
    }
    uv -= 0.5;
    vec2 low = floor(uv);
    vec2 f = uv - low;
    ivec2 i = ivec2(low);
    return mix(mix(texel_at(lookup, plane, i.x, i.y), texel_at(lookup, plane, i.x + 1, i.y), f.x),
               mix(texel_at(lookup, plane, i.x, i.y + 1), texel_at(lookup, plane, i.x + 1, i.y + 1), f.x), f.y);
}

// A texture at the coordinates of both sets; linear. texture_number: 1 + index of its TextureLookup; 0: none, white.
// No mipmaps: pixels are averaged over many samples.
vec4 texture_at(uint texture_number, vec4 coordinates) {
    if (texture_number == 0u) return vec4(1.0);
    TextureLookup lookup = textures_at(texture_number - 1u);
    vec2 uv = (lookup.flags & TEXTURE_SECOND_UV) != 0u ? coordinates.zw : coordinates.xy;
    uv = vec2(dot(lookup.matrix.xy, uv), dot(lookup.matrix.zw, uv)) + lookup.offset;
    uv = vec2(wrap_coordinate(uv.x, lookup.flags & TEXTURE_WRAP_S),
              wrap_coordinate(uv.y, (lookup.flags & TEXTURE_WRAP_T) >> 2u));
    uv *= vec2(lookup.width, lookup.height);
    // A loop: an `if` would run on lavapipe, and take four texels more of every texture. Where no image has a second
    // plane it is none.
    vec4 sum = vec4(0.0);
    uint planes = PLANES == 1u || lookup.fine == 0u ? 1u : 2u;
    for (uint plane = 0u; plane < planes; ++plane) sum += plane_at(lookup, plane, uv);
    return sum;
}

#endif
