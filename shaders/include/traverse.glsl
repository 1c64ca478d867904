// Nearest hit of a ray with the 4-wide quantised BVH. Reads nodes and triangles; O(log triangles) steps a ray.
// The stack holds exactly what this tree can need. Fails only by running out of `steps`, and says so.

struct Hit {
    float t;         // distance along the direction, scene frame
    uint triangle;   // into the leaf-ordered triangles
    vec2 barycentric;
};

#define TRACE_MISS 0u
#define TRACE_HIT 1u
#define TRACE_UNFINISHED 2u  // out of steps: nothing is known of the ray

void intersect_triangle(uint index, vec3 origin, vec3 direction, inout Hit hit) {
    int texel = int(index) * 3;
    vec3 v0 = texelFetch(triangles, texel).xyz;
    vec4 e1 = texelFetch(triangles, texel + 1);
    vec3 e2 = texelFetch(triangles, texel + 2).xyz;
    vec3 p = cross(direction, e2);
    float inverse = 1.0 / dot(e1.xyz, p);
    vec3 s = origin - v0;
    // Both triangles of a shared edge accept a hit within rounding of it: closed meshes stay closed.
    float slack = e1.w * max(abs(s.x), max(abs(s.y), abs(s.z))) * abs(inverse);
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, e1.xyz);
    float v = dot(direction, q) * inverse;
    float t = dot(e2, q) * inverse;
    // A parallel ray divides by zero: u, v, t are then infinite or NaN and a comparison fails.
    if (u >= -slack && v >= -slack && u + v <= 1.0 + slack && t > 0.0 && t < hit.t) {
        hit = Hit(t, index, vec2(u, v));
    }
}

vec4 bytes(uint word) { return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u); }

const uint NO_NODE = 0xffffffffu;

// The next node of the stack that is nearer than the hit, else NO_NODE.
#define POP_NODE()                                                  \
    for (node = NO_NODE; node == NO_NODE && top > 0u; --steps) {    \
        --top;                                                      \
        if (stack_near[top] < hit.t) node = stack_node[top];        \
    }

// origin within the scene's bounds or at them, direction unit. Spends `steps`, one a loop trip; it may overdraw them
// by the height of the stack.
uint trace(vec3 origin, vec3 direction, inout int steps, out Hit hit) {
    hit = Hit(3.0e38, 0u, vec2(0.0));
    // Tiny components keep their sign and stay finite: 0 * infinity is no number.
    vec3 d = mix(direction, mix(vec3(1e-20), vec3(-1e-20), lessThan(direction, vec3(0.0))),
                 lessThan(abs(direction), vec3(1e-20)));
    vec3 inverse = 1.0 / d;
    bvec3 negative = lessThan(d, vec3(0.0));

    uint stack_node[STACK];
    float stack_near[STACK];
    uint top = 0u;
    uint node = 0u;
    uint leaf = NO_NODE;  // put off until every lane of the SIMD group has one

    while (node != NO_NODE) {
        while (node < BVH_LEAF) {
            if (steps <= 0) return TRACE_UNFINISHED;
            --steps;
            int texel = int(node) * 4;
            uvec4 a = texelFetch(nodes, texel);
            uvec4 b = texelFetch(nodes, texel + 1);
            uvec4 c = texelFetch(nodes, texel + 2);
            uvec4 e = texelFetch(nodes, texel + 3);
            vec3 cell = uintBitsToFloat(uvec3(a.w << 23u, a.w << 15u, a.w << 7u) & 0x7f800000u);
            vec3 scale = cell * inverse;
            vec3 offset = (uintBitsToFloat(a.xyz) - origin) * inverse;
            vec4 near = max(max(bytes(negative.x ? b.w : b.x) * scale.x + offset.x,
                                bytes(negative.y ? c.x : b.y) * scale.y + offset.y),
                            max(bytes(negative.z ? c.y : b.z) * scale.z + offset.z, vec4(0.0)));
            vec4 far = min(min(bytes(negative.x ? b.x : b.w) * scale.x + offset.x,
                               bytes(negative.y ? b.y : c.x) * scale.y + offset.y),
                           min(bytes(negative.z ? b.z : c.y) * scale.z + offset.z, vec4(hit.t)));
            uvec4 child = uvec4(c.zw, e.xy);
            const float FAR = 3.4e38;
            near = mix(near, vec4(FAR), bvec4(uvec4(greaterThan(near, far)) | uvec4(equal(child, uvec4(0u)))));
            // Nearest child next, the others on the stack with the farthest at the bottom (sorting network).
            bool s;
            s = near.y < near.x; near.xy = s ? near.yx : near.xy; child.xy = s ? child.yx : child.xy;
            s = near.w < near.z; near.zw = s ? near.wz : near.zw; child.zw = s ? child.wz : child.zw;
            s = near.z < near.x; near.xz = s ? near.zx : near.xz; child.xz = s ? child.zx : child.xz;
            s = near.w < near.y; near.yw = s ? near.wy : near.yw; child.yw = s ? child.wy : child.yw;
            s = near.z < near.y; near.yz = s ? near.zy : near.yz; child.yz = s ? child.zy : child.yz;
            if (near.w < FAR) { stack_node[top] = child.w; stack_near[top] = near.w; ++top; }
            if (near.z < FAR) { stack_node[top] = child.z; stack_near[top] = near.z; ++top; }
            if (near.y < FAR) { stack_node[top] = child.y; stack_near[top] = near.y; ++top; }
            node = near.x < FAR ? child.x : NO_NODE;
            if (node >= BVH_LEAF && leaf == NO_NODE) {
                leaf = node;
                node = NO_NODE;
            }
            if (node == NO_NODE) {
                POP_NODE()
            }
        }
        // Here the node is a leaf or none; so is what was put off.
        for (uint i = 0u; i < 2u; ++i) {
            if (leaf != NO_NODE) {
                uint first = (leaf & ~BVH_LEAF) >> 3u;
                uint last = first + (leaf & 7u);
                for (; first < last; ++first) {
                    --steps;
                    intersect_triangle(first, origin, direction, hit);
                }
            }
            leaf = node;
        }
        leaf = NO_NODE;
        POP_NODE()
        --steps;
    }
    return hit.t < 3.0e38 ? TRACE_HIT : TRACE_MISS;
}
