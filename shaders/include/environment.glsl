// Light from infinitely far away, constant over each pixel of a map. Reads environment and its alias table, which is in
// proportion to the flux into the scene: see entry.glsl.
#ifndef ENVIRONMENT_GLSL
#define ENVIRONMENT_GLSL

#include "include/kernel.glsl"
#include "include/angle.glsl"
#include "include/sampling.glsl"

ENVIRONMENT(FLOAT_TEXELS)
ENVIRONMENT_ALIAS(TEXELS)

// The pixel that is seen in `direction`, a unit vector away from the scene.
uint environment_pixel(vec3 direction) {
    // The polar angle not by acos: devices know it to 1e-4 only.
    float azimuth = angle_of(direction.z, direction.x), polar = angle_of(length(direction.xz), direction.y);
    vec2 uv = vec2(0.5 + azimuth / (2.0 * PI), polar / PI);
    uvec2 pixel = min(uvec2(uv * vec2(params.environment)), params.environment - 1u);
    return pixel.y * params.environment.x + pixel.x;
}

// Radiance that arrives from `direction`, a unit vector away from the scene.
vec3 environment_radiance(vec3 direction) {
    return texelFetch(environment_texels, int(environment_pixel(direction))).rgb;
}

// About the mean of entry_area over the directions of a pixel.
float environment_area(uint pixel) {
    return uintBitsToFloat(texelFetch(environment_alias_texels, int(2u * pixel + 1u)).x);
}

// A direction away from the scene: a pixel in proportion to the mean channel of its flux into the scene, then uniform
// in its solid angle. Returns radiance over the density, for a flux of 1 of the whole map: the colour of the pixel
// (radiance over mean channel) over its environment_area. bits, keep: which pixel; u: where in it.
vec3 sample_environment(uint bits, float keep, vec2 u, out vec3 direction) {
    uint count = params.environment.x * params.environment.y;
    uint high, low;
    umulExtended(bits, count, high, low);
    uint pixel = high;
    vec4 entry = texelFetch(environment_texels, int(pixel));
    if (keep >= entry.w) {
        pixel = texelFetch(environment_alias_texels, int(2u * pixel)).x;
        entry = texelFetch(environment_texels, int(pixel));
    }
    uint row = pixel / params.environment.x;
    // Uniform in solid angle over the pixel: in azimuth and in the cosine of the polar angle.
    float top = cos(PI * float(row) / float(params.environment.y));
    float bottom = cos(PI * float(row + 1u) / float(params.environment.y));
    float y = mix(top, bottom, u.y);
    float azimuth = 2.0 * PI * ((float(pixel % params.environment.x) + u.x) / float(params.environment.x) - 0.5);
    float r = sqrt(max(0.0, 1.0 - y * y));
    direction = vec3(r * cos(azimuth), y, r * sin(azimuth));
    return entry.rgb * (3.0 / ((entry.r + entry.g + entry.b) * environment_area(pixel)));
}

#endif
