// Light from infinitely far away, constant over each pixel of a map. Reads environment and its alias table.
#include "include/angle.glsl"

layout(binding = BIND_ENVIRONMENT) uniform samplerBuffer environment;
layout(binding = BIND_ENVIRONMENT_ALIAS) uniform usamplerBuffer environment_alias;

// Radiance that arrives from `direction`, a unit vector away from the scene.
vec3 environment_radiance(vec3 direction) {
    // The polar angle not by acos: devices know it to 1e-4 only.
    vec2 uv = vec2(0.5 + angle_of(direction.z, direction.x) / (2.0 * PI), angle_of(length(direction.xz), direction.y) / PI);
    uvec2 pixel = min(uvec2(uv * vec2(params.environment)), params.environment - 1u);
    return texelFetch(environment, int(pixel.y * params.environment.x + pixel.x)).rgb;
}

// A direction away from the scene, in proportion to the mean channel of the radiance, and the colour of its radiance:
// radiance over mean channel. bits, keep: which pixel; u: where in it.
vec3 sample_environment(uint bits, float keep, vec2 u, out vec3 direction) {
    uint count = params.environment.x * params.environment.y;
    uint high, low;
    umulExtended(bits, count, high, low);
    uint pixel = high;
    vec4 entry = texelFetch(environment, int(pixel));
    if (keep >= entry.w) {
        pixel = texelFetch(environment_alias, int(pixel)).x;
        entry = texelFetch(environment, int(pixel));
    }
    uint row = pixel / params.environment.x;
    // Uniform in solid angle over the pixel: in azimuth and in the cosine of the polar angle.
    float top = cos(PI * float(row) / float(params.environment.y));
    float bottom = cos(PI * float(row + 1u) / float(params.environment.y));
    float y = mix(top, bottom, u.y);
    float azimuth = 2.0 * PI * ((float(pixel % params.environment.x) + u.x) / float(params.environment.x) - 0.5);
    float r = sqrt(max(0.0, 1.0 - y * y));
    direction = vec3(r * cos(azimuth), y, r * sin(azimuth));
    return entry.rgb * (3.0 / (entry.r + entry.g + entry.b));
}
