// Nearest hit of a ray with the 4-wide quantised BVH. Reads nodes and triangles; O(log triangles) steps a ray.
// The stack holds exactly what this tree can need. Fails only by running out of `steps`, and says so.
// Written for software Vulkan, where a load of 16 bytes from texels is one call for eight lanes, every branch is run by
// every lane, and a store to an array is a branch for each lane.

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
    vec4 e2 = texelFetch(triangles, texel + 2);
    vec3 p = cross(direction, e2.xyz);
    float inverse = 1.0 / dot(e1.xyz, p);
    vec3 s = origin - v0;
    // Both triangles of a shared edge accept a hit within rounding of it: closed meshes stay closed.
    vec2 slack = vec2(e1.w, e2.w) * (max(abs(s.x), max(abs(s.y), abs(s.z))) * abs(inverse));
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, e1.xyz);
    float v = dot(direction, q) * inverse;
    float t = dot(e2.xyz, q) * inverse;
    // A parallel ray divides by zero: u, v, t are then infinite or NaN and a comparison fails.
    // At the tip of a needle the third edge alone would let pass what is far beyond it.
    if (u >= -slack.x && v >= -slack.y && u + v <= 1.0 + max(slack.x, slack.y) && u <= 1.0 + slack.x &&
        v <= 1.0 + slack.y && t > 0.0 && t < hit.t) {
        hit = Hit(t, index, vec2(u, v));
    }
}

vec4 bytes(uint word) { return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u); }

const uint NO_NODE = 0xffffffffu;

// The children of one node that wait, one word: from the low bits up the slots of the nearest, the second and the third,
// how many they are, the node, and in what is left the distance at which the ray enters the nearest, rounded down. A word
// a node, not a word a child: software Vulkan stores each lane of a stack by itself.
#define GROUP_COUNT_SHIFT 6u
#define GROUP_NODE_SHIFT 8u
#define GROUP_NEAR_SHIFT (GROUP_NODE_SHIFT + NODE_BITS)
#define NO_GROUP 0u
#define LARGEST_NEAR float((1u << (32u - GROUP_NEAR_SHIFT)) - 1u)

// The scene's radius is at most 1, so that no ray within it is longer than 2.
uint group_near(float t) { return uint(int(min(t, 2.0) * (0.5 * LARGEST_NEAR))); }

uint group_node(uint group) { return group >> GROUP_NODE_SHIFT & ((1u << NODE_BITS) - 1u); }

// Without its nearest child.
uint group_rest(uint group) {
    return (group & (3u << GROUP_COUNT_SHIFT)) == 1u << GROUP_COUNT_SHIFT
               ? NO_GROUP
               : (group & ~63u) - (1u << GROUP_COUNT_SHIFT) | (group & 63u) >> 2u;
}

// The child word of a slot of a node.
uint child_of(uint node, uint slot) {
    uvec4 child = texelFetch(nodes, int(node) * 4 + 3);
    uvec2 pair = (slot & 2u) != 0u ? child.zw : child.xy;
    return (slot & 1u) != 0u ? pair.y : pair.x;
}

// A traversal that can be left and gone on with, so that lanes whose ray is done can take another one.
struct Traversal {
    vec3 origin;
    vec3 direction;
    vec3 inverse;  // 1 / direction
    uint node;     // child word of what comes next; NO_NODE: the ray is done
    uint leaf;     // a leaf put off until the lanes of the SIMD group have one, node * 4 + slot, or NO_NODE
    uint group;    // children of the latest node that wait
    uint top;      // of the stack, which holds the groups before it, none of them empty
    uint limit;    // group_near of the hit
    Hit hit;       // nearest so far
};

// The latest group is not on it, so that there is room for a store of nothing when it is full.
uint stack[STACK];

Traversal begin_traversal(vec3 origin, vec3 direction) {
    // Tiny components keep their sign and stay finite: 0 * infinity is no number.
    vec3 d = mix(direction, mix(vec3(1e-20), vec3(-1e-20), lessThan(direction, vec3(0.0))),
                 lessThan(abs(direction), vec3(1e-20)));
    return Traversal(origin, direction, 1.0 / d, 0u, NO_NODE, NO_GROUP, 0u, 0xffffffffu, Hit(3.0e38, 0u, vec2(0.0)));
}

Traversal no_traversal() {
    Traversal t = begin_traversal(vec3(0.0), vec3(0.0));
    t.node = NO_NODE;
    return t;
}

// Where `wants`: takes the nearest waiting child that is not behind the hit into parent and slot, and wants no more.
#define TAKE_WAITING()                                                                        \
    for (; wants && (t.group != NO_GROUP || t.top > 0u); --steps) {                           \
        t.top -= uint(t.group == NO_GROUP);                                                   \
        t.group = t.group == NO_GROUP ? stack[t.top] : t.group;                               \
        if (t.group >> GROUP_NEAR_SHIFT <= t.limit) {                                         \
            parent = group_node(t.group);                                                     \
            slot = t.group & 3u;                                                              \
            t.group = group_rest(t.group);                                                    \
            wants = false;                                                                    \
        } else {                                                                              \
            t.group = NO_GROUP;                                                               \
        }                                                                                     \
    }

// How many lanes of the SIMD group say so. Software Vulkan makes a ballot in a third of the time of a sum or a vote.
uint lanes(bool condition) { return subgroupBallotBitCount(subgroupBallot(condition)); }

// Whether the SIMD group should leave what `busy` lanes of it do, for what the rest of `all` wait for: when none is busy,
// or at most `share` times as many as wait.
bool should_leave(uint busy, uint all, float share) { return float(busy) <= share * float(all - busy); }

// Shares of should_leave, measured on software Vulkan: of lanes within the tree, for those with a leaf; of lanes with a
// ray, for those that could take another one.
#define INNER_SHARE 0.5
#define RAY_SHARE 1.0

// Goes on with the lanes' rays until they are done or out of `steps`, or, where they are `independent`, until too few
// lanes are left for those that wait: `running` lanes, with a ray or without one. Spends `steps`, one a loop trip; it may overdraw
// them by the height of the stack.
// The loops go on while any lane of the SIMD group needs them, with every lane in them: what a lane does not need it does
// without effect. So a push is a store by all lanes, without a branch for each that guesses wrong.
void traverse(inout Traversal t, inout int steps, bool independent, bool running) {
    uint all = lanes(running);
    while (true) {
        bool goes_on = t.node != NO_NODE && steps > 0;
        uint going = lanes(goes_on);
        if (should_leave(going, all, independent ? RAY_SHARE : 0.0)) break;
        while (true) {
            bool inner = t.node < BVH_LEAF && steps > 0;
            if (should_leave(lanes(inner), going, independent ? INNER_SHARE : 0.0)) break;
            steps -= int(inner);
            int texel = inner ? int(t.node) * 4 : 0;
            uvec4 a = texelFetch(nodes, texel);
            uvec4 b = texelFetch(nodes, texel + 1);
            uvec4 c = texelFetch(nodes, texel + 2);
            bvec3 negative = lessThan(t.inverse, vec3(0.0));
            vec3 cell = uintBitsToFloat(uvec3(a.w << 23u, a.w << 15u, a.w << 7u) & 0x7f800000u);
            vec3 scale = cell * t.inverse;
            vec3 offset = (uintBitsToFloat(a.xyz) - t.origin) * t.inverse;
            vec4 near = max(max(bytes(negative.x ? b.w : b.x) * scale.x + offset.x,
                                bytes(negative.y ? c.x : b.y) * scale.y + offset.y),
                            max(bytes(negative.z ? c.y : b.z) * scale.z + offset.z, vec4(0.0)));
            vec4 far = min(min(bytes(negative.x ? b.x : b.w) * scale.x + offset.x,
                               bytes(negative.y ? b.y : c.x) * scale.y + offset.y),
                           min(bytes(negative.z ? b.z : c.y) * scale.z + offset.z, vec4(t.hit.t)));
            uint present = inner ? a.w : 0u;
            // Distances are not negative and compare as words do; the slot takes the place of their last bits.
            uvec4 r = floatBitsToUint(near) & 0x7ffffffcu | uvec4(0u, 1u, 2u, 3u);
            r = mix(uvec4(NO_NODE), r, bvec4(uvec4(lessThanEqual(near, far)) &
                                             (uvec4(present) >> uvec4(24u, 25u, 26u, 27u) & 1u)));
            // Nearest first (sorting network).
            r = uvec4(min(r.xz, r.yw), max(r.xz, r.yw)).xzyw;
            r = uvec4(min(r.xy, r.zw), max(r.xy, r.zw));
            r.yz = uvec2(min(r.y, r.z), max(r.y, r.z));
            uint waiting = uint(r.y != NO_NODE) + uint(r.z != NO_NODE) + uint(r.w != NO_NODE);
            stack[t.top] = t.group;
            t.top += uint(waiting > 0u && t.group != NO_GROUP);
            uint fresh = r.y & 3u | (r.z & 3u) << 2u | (r.w & 3u) << 4u | waiting << GROUP_COUNT_SHIFT |
                         t.node << GROUP_NODE_SHIFT | group_near(uintBitsToFloat(r.y & ~3u)) << GROUP_NEAR_SHIFT;
            t.group = waiting > 0u ? fresh : t.group;
            uint parent = t.node, slot = r.x & 3u;
            bool any = r.x != NO_NODE;
            bool put_off = any && (a.w >> slot & 1u << 28u) != 0u && t.leaf == NO_NODE;
            t.leaf = put_off ? t.node << 2u | slot : t.leaf;
            bool wants = inner && (put_off || !any);
            TAKE_WAITING()
            uint child = child_of(inner ? parent : 0u, slot);
            t.node = inner ? wants ? NO_NODE : child : t.node;
        }
        // Here the node is a leaf or none, unless the steps are spent; so is what was put off.
        bool wants = goes_on && t.node >= BVH_LEAF;
        uint word = wants && t.leaf != NO_NODE ? child_of(t.leaf >> 2u, t.leaf & 3u) : NO_NODE;
        for (uint i = 0u; i < 2u; ++i) {
            if (word != NO_NODE) {
                uint first = (word & ~BVH_LEAF) >> 3u;
                uint last = first + (word & 7u);
                for (; first < last; ++first) {
                    --steps;
                    intersect_triangle(first, t.origin, t.direction, t.hit);
                }
            }
            word = wants ? t.node : NO_NODE;
        }
        t.leaf = wants ? NO_NODE : t.leaf;
        t.limit = group_near(t.hit.t);
        bool asked = wants;
        steps -= int(wants);
        uint parent = 0u, slot = 0u;
        TAKE_WAITING()
        uint child = child_of(parent, slot);
        t.node = asked ? wants ? NO_NODE : child : t.node;
    }
}

uint found_by(Traversal t) {
    return t.node != NO_NODE ? TRACE_UNFINISHED : t.hit.t < 3.0e38 ? TRACE_HIT : TRACE_MISS;
}

// origin within the scene's bounds or at them, direction unit. Spends `steps` as traverse() does.
uint trace(vec3 origin, vec3 direction, inout int steps, out Hit hit) {
    Traversal t = begin_traversal(origin, direction);
    traverse(t, steps, false, true);
    hit = t.hit;
    return found_by(t);
}
