// The light tree, by which local lights are asked for in proportion to what they may bring to a point (Conty Estevez
// and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). Its leaves are lamps: a point or
// spot light, a triangle, or the two of a flat quadrilateral. How often a lamp is asked for is a function of the point
// alone, not of the surface there. Reads light_tree, lamps.
#ifndef LIGHT_TREE_GLSL
#define LIGHT_TREE_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/rng.glsl"

LIGHT_TREE(RECORDS)
LAMPS(TEXELS)

// Of the squared radius about lights: no point is taken to be nearer to them. The mean of lamps spread over a disc is
// half of it; measured, 0.4 has the least variance.
const float LEAST_DISTANCE2 = 0.4;

// What a child of a branch may bring to a point, but for its intensity: about the largest cosine at its lights, over
// the squared distance. 0 only where none of its lights shines.
float importance(LightBranch branch, int child, vec3 position) {
    vec4 sphere = branch.sphere[child];
    uint cones = branch.cones[child];
    vec3 away = position - sphere.xyz;
    float distance2 = dot(away, away), radius2 = sphere.w * sphere.w;
    float nearest2 = max(max(distance2, LEAST_DISTANCE2 * radius2), 1e-12);  // no nearer than positions are known
    float inverse = inversesqrt(max(distance2, 1e-30));
    float cosine = dot(away, unpack_direction(branch.axis[child])) * inverse;
    if ((cones & LIGHT_BOTH_SIDES) != 0u) cosine = abs(cosine);
    float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
    // Less the cone of the normals.
    float cos_cone = float(int(cones << 16u) >> 16) / 32767.0;
    float sin_cone = sqrt(max(0.0, 1.0 - cos_cone * cos_cone));
    bool within = cosine >= cos_cone;
    float cos_left = within ? 1.0 : cosine * cos_cone + sine * sin_cone;
    float sin_left = within ? 0.0 : sine * cos_cone - cosine * sin_cone;
    // Less the sphere, as it is seen from there.
    float sin_sphere = sphere.w * inverse, cos_sphere = sqrt(max(0.0, 1.0 - sin_sphere * sin_sphere));
    float largest = cos_left >= cos_sphere ? 1.0 : cos_left * cos_sphere + sin_left * sin_sphere;
    bool inside = distance2 <= radius2;
    bool shines = largest > float(cones >> 16u & 0x7fffu) / 32767.0 &&
                  distance2 * inverse - sphere.w <= branch.reach[child];
    return inside ? 1.0 / nearest2 : shines ? largest / nearest2 : 0.0;
}

// The probabilities of its two children; 0: neither brings light.
vec2 probabilities(LightBranch branch, vec3 position) {
    vec2 brings = vec2(importance(branch, 0, position), branch.ratio * importance(branch, 1, position));
    float both = brings.x + brings.y;
    return both > 0.0 ? brings / both : vec2(0.0);
}

struct Lamp {
    uint first;         // of asked_lights
    uint count;         // 0: none sheds light there
    float probability;
};

const float ULP_OF_WORDS = 2.3283064365386963e-10;  // 2^-32
const float COARSE = 9.5367431640625e-7;            // 2^-20

// Goes down the tree, where the group has one, to a lamp. word: as a fraction it chooses, and keeps what it has not
// used: equidistributed words stay so. v: two numbers in [0, 1), for what is beyond the bits of the word.
Lamp choose_lamp(AskedGroup group, vec3 position, inout uint word, vec2 v) {
    bool has_tree = HAS_LIGHT_TREE && group.depth > 0u;
    Lamp lamp = Lamp(has_tree ? 0u : group.first, has_tree ? 0u : group.count, 1.0);
    float share = min(float(word) * ULP_OF_WORDS, LARGEST_UNIT);
    float step = ULP_OF_WORDS;  // between shares that there are
    while (HAS_LIGHT_TREE && lamp.count == 0u) {
        LightBranch branch = light_tree_at(lamp.first);
        vec2 of = probabilities(branch, position);
        // The less likely child is that of small shares, which floats know more exactly.
        bool first_is_small = of.x < of.y;
        float small = min(of.x, of.y), large = max(of.x, of.y);
        bool takes_small = share < small;
        int child = takes_small == first_is_small ? 0 : 1;
        float probability = takes_small ? small : large;
        if (probability == 0.0) break;
        share = takes_small ? share / small : (share - small) / large;
        step /= probability;
        if (step > COARSE) {
            share += v.x * step;
            step = ULP_OF_WORDS;
            v = v.yx;
        }
        share = min(share, LARGEST_UNIT);
        lamp = Lamp(branch.first[child], branch.count[child], lamp.probability * probability);
    }
    if (has_tree) word = uint(share * 4294967296.0);
    return lamp;
}

// The lamp that a triangle is a part of; NO_LAMP: it sheds no light.
uint lamp_of(uint triangle) { return texelFetch(lamps_texels, int(triangle)).x; }

// The first of its asked_lights.
uint first_of(uint lamp) { return light_tree_at(lamp >> 1u).first[lamp & 1u]; }

// The probability with which choose_lamp() comes to the lamp at that point; NO_LAMP: to that of a group without a tree.
float lamp_probability(uint lamp, vec3 position) {
    float probability = 1.0;
    while (HAS_LIGHT_TREE && lamp != NO_LAMP) {
        LightBranch branch = light_tree_at(lamp >> 1u);
        probability *= probabilities(branch, position)[lamp & 1u];
        lamp = branch.parent;
    }
    return probability;
}

#endif
