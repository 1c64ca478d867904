// Samples of the unit square mapped to the distributions that light needs. Pure functions.

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

// Cosine about the axis of a glTF spot light, density proportional to its angular attenuation
// clamp((c - outer) / (inner - outer), 0, 1)^2: cubic cumulative distribution between the cones, linear inside.
float sample_spot_cosine(float inner, float outer, float u) {
    float edge = (inner - outer) / 3.0;  // integral over the falloff
    float x = u * (edge + 1.0 - inner);
    return x < edge ? outer + (inner - outer) * pow(x / edge, 1.0 / 3.0) : inner + (x - edge);
}
