// Nearest hit of a ray with the 4-wide quantised BVH, or whether there is any up to some distance. SIMD group: the
// subgroup, the lanes that run together. Reads nodes and triangles; O(log triangles) steps a ray. The stack holds
// exactly what this tree can need. Fails only by running out of `steps`, and says so. Where a child of the scene's tree
// is an instance of a mesh the ray goes on in the mesh's space and through the mesh's own tree, and then back in the
// scene's. Written for software Vulkan, where a load of 16 bytes from texels is one call for eight lanes, every branch
// is run by every lane, and a store to an array is a branch for each lane.
#ifndef TRAVERSE_GLSL
#define TRAVERSE_GLSL

#include "include/kernel.glsl"
#include "include/scene.glsl"

struct Hit {
    float t;         // distance along the direction, scene frame
    uint triangle;   // into the leaf-ordered triangles
    vec2 barycentric;
    uint instance;   // that it is a triangle of; NO_INSTANCE: of none
};

// What a ray looks for.
struct Sought {
    float within;  // distance beyond which nothing counts
    uint but;      // a triangle that does not count either; NO_TRIANGLE: all do
    bool any;      // whatever is there ends the ray: not the nearest alone
};

const Sought NEAREST = Sought(FAR, NO_TRIANGLE, false);

#define TRACE_MISS 0u
#define TRACE_HIT 1u
#define TRACE_UNFINISHED 2u  // out of steps: nothing is known of the ray

// A traversal that can be left and gone on with, so that lanes whose ray is done can take another one.
struct Traversal {
    vec3 origin;      // in an instance: in the mesh's space, beginning where the mesh does
    vec3 direction;   //   and not a unit vector, so that distances are the scene's
    vec3 inverse;     // 1 / direction
    uint node;        // child_of what comes next; NO_NODE: the ray is done
    uint leaf;        // a leaf put off until the lanes of the SIMD group have one, or NO_NODE
    uint group;       // children of the latest node that wait
    uint below;       // stack[top], kept here because a load from the stack takes long
    uint top;         // groups on the stack, those before `group`, none of them empty
    uint limit;       // group_near of the hit
    Hit hit;          // nearest so far; before there is one, of NO_TRIANGLE at the distance that is sought within
    uint but;         // of Sought
    bool any;
    // Only where the scene has instances.
    vec3 outer_origin;     // the ray in the scene
    vec3 outer_direction;
    float begin;           // distance from there to `origin`
    float stretch;         // length of `direction`
    uint instance;         // that it is in, or NO_INSTANCE
    uint bottom;           // groups on the stack when it went in
};

// From `origin` to the nearest hit so far.
float distance_left(Traversal t) { return HAS_INSTANCES ? t.hit.t - t.begin : t.hit.t; }

#define PARALLEL 1e-37  // of a determinant: 1 / x is still a number, also where tiny numbers are taken to be 0

void intersect_triangle(uint index, inout Traversal t) {
    int texel = int(index) * 3;
    vec3 v0 = texelFetch(triangles_texels, texel).xyz;
    vec4 e1 = texelFetch(triangles_texels, texel + 1);
    vec4 e2 = texelFetch(triangles_texels, texel + 2);
    vec3 p = cross(t.direction, e2.xyz);
    float determinant = dot(e1.xyz, p);
    float inverse = 1.0 / determinant;
    vec3 s = t.origin - v0;
    // Both triangles of a shared edge accept a hit within rounding of it: closed meshes stay closed.
    vec2 slack = vec2(e1.w, e2.w) * (max(abs(s.x), max(abs(s.y), abs(s.z))) * abs(inverse));
    if (HAS_INSTANCES) slack *= t.stretch;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, e1.xyz);
    float v = dot(t.direction, q) * inverse;
    float distance = dot(e2.xyz, q) * inverse;
    // A parallel ray divides by zero. Comparisons with NaN fail, but a compiler may take it that there is none.
    // At the tip of a needle the third edge alone would let pass what is far beyond it.
    if (u >= -slack.x && v >= -slack.y && u + v <= 1.0 + max(slack.x, slack.y) && u <= 1.0 + slack.x &&
        v <= 1.0 + slack.y && distance > 0.0 && distance < distance_left(t) && abs(determinant) > PARALLEL &&
        index != t.but) {
        t.hit = Hit(HAS_INSTANCES ? t.begin + distance : distance, index, vec2(u, v), t.instance);
    }
}

vec4 bytes(uint word) { return vec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 255u); }

// Distances to a plane of each child, as integers: floats that are not negative compare as such, and negative ones stay
// negative. The least of two floats takes software Vulkan three instructions, because of NaN, that of integers one.
ivec4 plane(uint word, float scale, float offset) { return floatBitsToInt(bytes(word) * scale + offset); }

const uint NO_NODE = 0xffffffffu;

// The children of one node that wait, one word: from the low bits up the slots of the nearest, the second and the
// third, the last of them again where there are fewer; where the node's children are (BvhNode::children); and in what
// is left the distance at which the ray enters the nearest, rounded down. A word a node, not a word a child: software
// Vulkan stores each lane of a stack by itself.
#define GROUP_CHILDREN_SHIFT 6u
#define GROUP_NEAR_SHIFT (GROUP_CHILDREN_SHIFT + BVH_CHILDREN_SHIFT + NODE_BITS)
#define LARGEST_NEAR float((1u << (32u - GROUP_NEAR_SHIFT)) - 1u)
const uint NO_GROUP = 0xffffffffu;  // no node has so many children

// The scene's radius is at most 1, so that no ray within it is longer than 2.
uint group_near(float t) { return uint(int(min(t, 2.0) * (0.5 * LARGEST_NEAR))); }

uint group_children(uint group) { return group >> GROUP_CHILDREN_SHIFT & (1u << BVH_CHILDREN_SHIFT + NODE_BITS) - 1u; }

// Without its nearest child.
uint group_rest(uint group) {
    return ((group >> 2u ^ group) & 3u) == 0u ? NO_GROUP : group & ~15u | group >> 2u & 15u;
}

// What comes next after the child in a slot was chosen: a node, or with BVH_LEAF where to find a leaf. Takes no load.
uint child_of(uint children, uint slot) {
    return slot < (children & BVH_CHILDREN_MASK) ? (children >> BVH_CHILDREN_SHIFT) + slot
                                                 : BVH_LEAF | children << 2u | slot;
}

// First triangle of a leaf and the one past its last.
uvec2 leaf_triangles(uint leaf) {
    uint children = (leaf & ~BVH_LEAF) >> 2u;
    uvec4 words = texelFetch(nodes_texels, int(children >> BVH_CHILDREN_SHIFT) * 4 + 3);
    uvec2 leaves = (children & BVH_CHILDREN_MASK) == 0u ? words.xy : words.zw;
    uint place = leaves.y >> 8u * (leaf & 3u);
    uint first = leaves.x + (place & 15u);
    return uvec2(first, first + (place >> 4u & 15u));
}

// The groups before the latest, from stack[1] on. stack[0] is NO_GROUP, and there is room for a store of nothing when
// the stack is full.
uint stack[STACK + 1u];

// Tiny components keep their sign and stay finite: 0 * infinity is no number.
vec3 inverse_of(vec3 direction) {
    return 1.0 / mix(direction, mix(vec3(1e-20), vec3(-1e-20), lessThan(direction, vec3(0.0))),
                     lessThan(abs(direction), vec3(1e-20)));
}

Traversal begin_traversal(vec3 origin, vec3 direction, Sought sought) {
    stack[0] = NO_GROUP;
    Hit nothing = Hit(sought.within, NO_TRIANGLE, vec2(0.0), NO_INSTANCE);
    return Traversal(origin, direction, inverse_of(direction), 0u, NO_NODE, NO_GROUP, NO_GROUP, 0u, 0xffffffffu,
                     nothing, sought.but, sought.any, origin, direction, 0.0, 1.0, NO_INSTANCE, 0u);
}

Traversal no_traversal() {
    Traversal t = begin_traversal(vec3(0.0), vec3(0.0), NEAREST);
    t.node = NO_NODE;
    return t;
}

// Groups on the stack that are not to be taken: in an instance those of the scene's tree.
#define BOTTOM(t) (HAS_INSTANCES ? (t).bottom : 0u)

// How many lanes of the SIMD group say so. Software Vulkan makes a ballot in a third of the time of a sum or a vote.
uint lanes(bool condition) { return subgroupBallotBitCount(subgroupBallot(condition)); }

// Where `wants`: takes the nearest waiting child that is not behind the hit into children and slot, and wants no more.
// Software Vulkan runs a loop once whatever its condition: this one is left at its end and most often runs just once.
// It is left by all lanes together: left by each on a trip of its own, SwiftShader gives them values of others' last
// trip. A lane that wants no more changes nothing.
// A macro, because it stands in the innermost loop, where copies of the traversal in and out of a function cost time.
// It uses the names t, steps, stack, wants, children and slot of traverse().
#define TAKE_WAITING()                                                                        \
    do {                                                                                      \
        bool pops = wants && t.group == NO_GROUP && t.top > BOTTOM(t);                        \
        t.group = pops ? t.below : t.group;                                                   \
        t.top -= uint(pops);                                                                  \
        t.below = stack[t.top];                                                               \
        bool looks = wants && t.group != NO_GROUP;                                            \
        bool takes = looks && t.group >> GROUP_NEAR_SHIFT <= t.limit;                         \
        children = takes ? group_children(t.group) : children;                                \
        slot = takes ? t.group & 3u : slot;                                                   \
        t.group = takes ? group_rest(t.group) : looks ? NO_GROUP : t.group;                   \
        steps -= int(looks);                                                                  \
        wants = wants && !takes;                                                              \
    } while (lanes(wants && t.top != BOTTOM(t)) > 0u);

bool is_instance(uint node) { return HAS_INSTANCES && node != NO_NODE && (node & BVH_ENTER) != 0u; }

// A bound of the rounding of what is a point of the scene frame, where it is taken to the mesh's space.
#define ENTER_ERROR 2e-6

// Where the node is an instance: goes on in its mesh; false where the ray misses that, or has met something before.
// The ray goes on from where it enters the box [-1, 1]^3 of the mesh's space, so that coordinates there are as small as
// its boxes' padding is meant for, however small the mesh is in the scene. The box is larger by the rounding of what
// enters it: nothing of the mesh is passed over.
bool enter_instance(inout Traversal t) {
    int texel = int(t.node & ~(BVH_LEAF | BVH_ENTER)) * 4;
    uvec4 a = texelFetch(nodes_texels, texel);
    vec4 b = uintBitsToFloat(texelFetch(nodes_texels, texel + 1));
    vec4 c = uintBitsToFloat(texelFetch(nodes_texels, texel + 2));
    uvec4 last = texelFetch(nodes_texels, texel + 3);
    vec3 x = b.xyz, y = vec3(b.w, c.xy), z = vec3(c.zw, uintBitsToFloat(last.x));
    // The difference is all but exact near the instance, where it matters.
    vec3 from_centre = t.outer_origin - uintBitsToFloat(a.xyz);
    vec3 origin = vec3(dot(x, from_centre), dot(y, from_centre), dot(z, from_centre));
    vec3 direction = vec3(dot(x, t.outer_direction), dot(y, t.outer_direction), dot(z, t.outer_direction));
    vec3 inverse = inverse_of(direction);
    vec3 half_box = 1.0 + ENTER_ERROR * vec3(dot(abs(x), vec3(1.0)), dot(abs(y), vec3(1.0)), dot(abs(z), vec3(1.0)));
    vec3 middle = -origin * inverse;
    vec3 half_length = half_box * abs(inverse);
    vec3 near = middle - half_length, far = middle + half_length;
    float begin = max(max(near.x, near.y), max(near.z, 0.0));
    if (begin > min(min(far.x, far.y), min(far.z, t.hit.t))) return false;
    t.origin = origin + begin * direction;
    t.direction = direction;
    t.inverse = inverse;
    t.begin = begin;
    t.stretch = length(direction);
    t.instance = a.w & ~BVH_INSTANCE;
    t.node = last.y;
    bool pushes = t.group != NO_GROUP;
    stack[t.top + 1u] = t.group;
    t.below = pushes ? t.group : t.below;
    t.top += uint(pushes);
    t.bottom = t.top;
    t.group = NO_GROUP;
    return true;
}

void leave_instance(inout Traversal t) {
    t.origin = t.outer_origin;
    t.direction = t.outer_direction;
    t.inverse = inverse_of(t.outer_direction);
    t.begin = 0.0;
    t.stretch = 1.0;
    t.instance = NO_INSTANCE;
    t.bottom = 0u;
}

// Whether the SIMD group should leave what `busy` lanes of it do, for what the rest of `all` wait for: when none is
// busy, or at most `share` times as many as wait.
bool should_leave(uint busy, uint all, float share) { return float(busy) <= share * float(all - busy); }

// Shares of should_leave, measured on software Vulkan: of lanes within the tree, for those with a leaf; of lanes with a
// ray, for those that could take another one.
#define INNER_SHARE 0.25
#define RAY_SHARE 1.0

// Goes on with the lanes' rays until they are done or out of `steps`, or, where they are `independent`, until too few
// lanes are left for those that wait: `running` lanes, with a ray or without one. Spends `steps`, one a loop trip; it
// may overdraw them by the height of the stack.
// The loops go on while any lane of the SIMD group needs them, with every lane in them: what a lane does not need it
// does without effect. So a push is a store by all lanes, without a branch for each that guesses wrong. They are left
// at their ends: left at its start, a loop's body runs once more for no lane.
void traverse(inout Traversal t, inout int steps, bool independent, bool running) {
    uint all = lanes(running);
    uint going = lanes(t.node != NO_NODE && steps > 0);
    do {
        bool goes_on = t.node != NO_NODE && steps > 0;
        do {
            bool inner = t.node < BVH_LEAF && steps > 0;
            steps -= int(inner);
            int texel = inner ? int(t.node) * 4 : 0;
            uvec4 a = texelFetch(nodes_texels, texel);
            uvec4 b = texelFetch(nodes_texels, texel + 1);
            uvec4 c = texelFetch(nodes_texels, texel + 2);
            // An instance waits as a leaf does.
            bool enters = HAS_INSTANCES && inner && (a.w & BVH_INSTANCE) != 0u;
            if (HAS_INSTANCES) inner = inner && !enters;
            bvec3 negative = lessThan(t.inverse, vec3(0.0));
            vec3 cell = uintBitsToFloat(uvec3(a.w << 23u, a.w << 15u, a.w << 7u) & 0x7f800000u);
            vec3 scale = cell * t.inverse;
            vec3 offset = (uintBitsToFloat(a.xyz) - t.origin) * t.inverse;
            ivec4 near = max(max(plane(negative.x ? b.w : b.x, scale.x, offset.x),
                                 plane(negative.y ? c.x : b.y, scale.y, offset.y)),
                             max(plane(negative.z ? c.y : b.z, scale.z, offset.z), ivec4(0)));
            float left = distance_left(t);
            ivec4 far = min(min(plane(negative.x ? b.x : b.w, scale.x, offset.x),
                                plane(negative.y ? b.y : c.x, scale.y, offset.y)),
                            min(plane(negative.z ? b.z : c.y, scale.z, offset.z), ivec4(floatBitsToInt(left))));
            uint present = inner ? a.w : 0u;
            // Distances are not negative and compare as words do; the slot takes the place of their last bits.
            uvec4 r = uvec4(near) & 0x7ffffffcu | uvec4(0u, 1u, 2u, 3u);
            r = mix(uvec4(NO_NODE), r, bvec4(uvec4(lessThanEqual(near, far)) &
                                             (uvec4(present) >> uvec4(24u, 25u, 26u, 27u) & 1u)));
            // Nearest first (sorting network).
            r = uvec4(min(r.xz, r.yw), max(r.xz, r.yw)).xzyw;
            r = uvec4(min(r.xy, r.zw), max(r.xy, r.zw));
            r.yz = uvec2(min(r.y, r.z), max(r.y, r.z));
            stack[t.top + 1u] = t.group;
            bool waits = r.y != NO_NODE;
            bool pushes = waits && t.group != NO_GROUP;
            t.top += uint(pushes);
            t.below = pushes ? t.group : t.below;
            uint second = r.z != NO_NODE ? r.z : r.y;
            uint third = r.w != NO_NODE ? r.w : second;
            uint fresh = r.y & 3u | (second & 3u) << 2u | (third & 3u) << 4u | c.z << GROUP_CHILDREN_SHIFT |
                         group_near(uintBitsToFloat(r.y & ~3u)) << GROUP_NEAR_SHIFT;
            t.group = waits ? fresh : t.group;
            uint children = c.z, slot = r.x & 3u;
            bool any = r.x != NO_NODE;
            uint nearest = child_of(children, slot);
            bool put_off = any && nearest >= BVH_LEAF && t.leaf == NO_NODE;
            t.leaf = put_off ? nearest : t.leaf;
            bool wants = inner && (put_off || !any);
            TAKE_WAITING()
            t.node = inner ? wants ? NO_NODE : child_of(children, slot) : t.node;
            if (HAS_INSTANCES) t.node |= enters ? BVH_LEAF | BVH_ENTER : 0u;
        } while (!should_leave(lanes(t.node < BVH_LEAF && steps > 0), going, independent ? INNER_SHARE : 0.0));
        // Here the node is a leaf or none, unless the steps are spent; so is what was put off.
        bool wants = goes_on && t.node >= BVH_LEAF;
        bool enters = wants && is_instance(t.node);
        uint leaf = wants ? t.leaf : NO_NODE;
        for (uint i = 0u; i < 2u; ++i) {
            if (leaf != NO_NODE) {
                uvec2 range = leaf_triangles(leaf);
                do {
                    --steps;
                    intersect_triangle(range.x, t);
                } while (++range.x < range.y);
            }
            leaf = wants && !enters ? t.node : NO_NODE;
        }
        t.leaf = wants ? NO_NODE : t.leaf;
        steps -= int(wants);
        if (t.any) {
            // Nothing that waits is taken any more.
            bool found = t.hit.triangle != NO_TRIANGLE;
            enters = enters && !found;
            t.group = found ? NO_GROUP : t.group;
            t.top = found ? 0u : t.top;
            if (HAS_INSTANCES) t.bottom = found ? 0u : t.bottom;
        }
        if (enters && enter_instance(t)) wants = false;
        t.limit = group_near(distance_left(t));
        bool asked = wants;
        uint children = 0u, slot = 0u;
        TAKE_WAITING()
        if (HAS_INSTANCES) {
            // Where nothing waits in the mesh's tree: what does in the scene's.
            bool leaves = wants && t.instance != NO_INSTANCE, done = wants && !leaves;
            if (leaves) leave_instance(t);
            t.limit = group_near(distance_left(t));
            wants = leaves;
            TAKE_WAITING()
            wants = wants || done;
        }
        t.node = asked ? wants ? NO_NODE : child_of(children, slot) : t.node;
        going = lanes(t.node != NO_NODE && steps > 0);
    } while (!should_leave(going, all, independent ? RAY_SHARE : 0.0));
}

uint found_by(Traversal t) {
    return t.node != NO_NODE ? TRACE_UNFINISHED : t.hit.triangle != NO_TRIANGLE ? TRACE_HIT : TRACE_MISS;
}

// origin within the scene's bounds or at them, direction unit. Spends `steps` as traverse() does.
uint trace(vec3 origin, vec3 direction, Sought sought, inout int steps, out Hit hit) {
    Traversal t = begin_traversal(origin, direction, sought);
    traverse(t, steps, false, true);
    hit = t.hit;
    return found_by(t);
}

#endif
