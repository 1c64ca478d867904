// Directions: octahedral packing and tangent frames. Pure functions.
#ifndef FRAME_GLSL
#define FRAME_GLSL

// Unit vector <-> snorm16x2 on the octahedron (Cigolle et al., JCGT 3(2), 2014). Error at most 6.5e-5 rad.
uint pack_direction(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) {
        p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    }
    ivec2 q = ivec2(floor(clamp(p, -1.0, 1.0) * 32767.0 + 0.5));
    return (uint(q.x) & 0xffffu) | (uint(q.y) << 16u);
}

// On the octahedron |x| + |y| + |z| = 1: not normalised.
vec3 unpack_octahedron(uint packed) {
    ivec2 q = ivec2(int(packed << 16u) >> 16, int(packed) >> 16);
    vec2 p = vec2(q) * (1.0 / 32767.0);
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return n;
}

vec3 unpack_direction(uint packed) { return normalize(unpack_octahedron(packed)); }

// Tangents of the unit vector n, continuous but at n.z = 0 (Duff et al., JCGT 6(1), 2017).
void tangents(vec3 n, out vec3 t, out vec3 b) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float c = n.x * n.y * a;
    t = vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x);
    b = vec3(c, s + n.y * n.y * a, -n.y);
}

// Unit normal of the triangle with these edges. Scaled by a power of two first: the squared length of the product of
// edges below 1e-10 leaves the range of floats.
vec3 face_normal(vec3 e1, vec3 e2) {
    vec3 m = max(abs(e1), abs(e2));
    float longest = max(m.x, max(m.y, m.z));
    float scale = uintBitsToFloat((254u << 23) - (floatBitsToUint(longest) & 0x7f800000u));
    return normalize(cross(e1 * scale, e2 * scale));
}

vec3 from_frame(vec3 n, vec3 local) {
    vec3 t, b;
    tangents(n, t, b);
    return local.x * t + local.y * b + local.z * n;
}

#endif
