// Samples of the unit square mapped to the distributions that light needs (warps). Pure functions.
#ifndef SAMPLING_GLSL
#define SAMPLING_GLSL

const float PI = 3.14159265358979;

// Uniform on the unit disc (polar map).
vec2 sample_disc(vec2 u) {
    float r = sqrt(u.x);
    float phi = 2.0 * PI * u.y;
    return r * vec2(cos(phi), sin(phi));
}

// Cosine-weighted about +z: pdf = cos(theta) / pi (Malley).
vec3 sample_cosine(vec2 u) {
    vec2 d = sample_disc(u);
    return vec3(d, sqrt(max(0.0, 1.0 - u.x)));
}

// About +z with the given cosine, uniform in azimuth.
vec3 sample_azimuth(float cos_theta, float u) {
    float sin_theta = sqrt(max(0.0, 1.0 - cos_theta * cos_theta));
    float phi = 2.0 * PI * u;
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta);
}

// Barycentrics (of v1, v2) uniform on a triangle.
vec2 sample_triangle(vec2 u) {
    float s = sqrt(u.x);
    return vec2(s * (1.0 - u.y), s * u.y);
}

// 1 - cos of the angle between unit vectors: no cancellation where it is small.
float versine(vec3 a, vec3 b) { return 0.5 * dot(a - b, a - b); }

// About +z with the given versine of the polar angle, uniform in azimuth.
vec3 sample_cone(float v, float u) {
    float sin_theta = sqrt(max(0.0, v * (2.0 - v)));
    float phi = 2.0 * PI * u;
    return vec3(sin_theta * cos(phi), sin_theta * sin(phi), 1.0 - v);
}

// The angular attenuation of a glTF spot light: inner, outer: versines of its cones. Cosines of cones below 1e-3 rad
// are 1 but for their last bits.
float spot_attenuation(float inner, float outer, float v) {
    float fall = clamp((outer - v) / (outer - inner), 0.0, 1.0);
    return fall * fall;
}

// Versine of the angle to the axis of a glTF spot light, density proportional to its attenuation: cubic cumulative
// distribution between the cones, linear inside.
float sample_spot_versine(float inner, float outer, float u) {
    float edge = (outer - inner) / 3.0;  // integral over the falloff
    float x = u * (edge + inner);
    return max(0.0, x < edge ? outer - (outer - inner) * pow(x / edge, 1.0 / 3.0) : inner - (x - edge));
}

#endif
