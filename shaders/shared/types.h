// Every struct and constant that host and kernels share. Compiled by g++ and by glslc; scalar block layout.
// Lengths are in the scene frame: centred on the scene and scaled by a power of two to a radius in (1/2, 1].
#ifdef __cplusplus
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
namespace vkcppm::gpu {
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
#define VKCPPM_CONST inline constexpr
#define VKCPPM_ZERO = 0
#else
#extension GL_EXT_scalar_block_layout : require
#define VKCPPM_CONST const
#define VKCPPM_ZERO
#endif

#define LARGEST_FLOAT 3.402823466e38f
#define FAR 3.0e38f  // stands for infinity, where a comparison or a ratio is to stay a number

// A struct whose members are the rows of FIELDS_<struct>, so that kernels that read it from texels decode it by them
// (include/records.glsl):
//   FIELD(type, name)
//   ARRAY(features, type, name, count)      where the scene has none of the features it is not read
//   OPTIONAL(features, absent, type, name)  likewise, and is `absent`
#define MEMBER_FIELD(type, name) type name;
#define MEMBER_ARRAY(features, type, name, count) type name[count];
#define MEMBER_OPTIONAL(features, absent, type, name) type name;
#define RECORD(Struct) struct Struct { FIELDS_##Struct(MEMBER_FIELD, MEMBER_ARRAY, MEMBER_OPTIONAL) };
#define ANY_FEATURE 0xffffffffu

// Specialization constants.
#define SPEC_WORKGROUP 0  // invocations a work group
#define SPEC_STACK 1      // entries of the traversal stack: the exact need of this scene's BVH
#define SPEC_RINGS 2      // n_a
#define SPEC_SECTORS 3    // n_s, even
#define SPEC_FEATURES 4   // FEATURE_* of this scene
#define SPEC_DIGIT_BITS 5 // of one radix sort pass
#define SPEC_NODE_BITS 6  // of the largest index of a node of this scene's BVH
#define SPEC_LEVELS 7     // of the grid that there is room for
#define SPEC_WAITS 8      // 1: lanes of the photon pass wait for the longest ray of their SIMD group
#define SPEC_DEALS 9      // 1: lanes of the photon pass share the light paths of their SIMD group
#define SPEC_LIGHT_TREE 10 // 1: local lights are asked for down a light tree
#define SPEC_PLANES 11    // 2 where an image of this scene has two: TextureLookup::fine

// Features of a scene or of its settings: a pipeline holds only what its scene needs, and buffers that only a feature
// reads are empty without it. FEATURE_<NAME> is its bit, HAS_<NAME> (include/kernel.glsl) whether a kernel has it.
//   MATERIAL(bit, NAME, words, trait)  a material on a triangle has the trait, an expression on the members of
//                                      MaterialTraits (host/flat/material.h)
//   SCENE(bit, NAME, words)            host/flat/features.cpp asks the scene
//   SETTING(bit, NAME, words)          the settings ask for it
// words: its name for people. In the order of bits, all of which are in use: what params say at no cost, as that there
// is no lens by its radius of 0, is no feature.
// clang-format off
#define FEATURE_TABLE(MATERIAL, SCENE, SETTING)                                                                \
    MATERIAL(0, REFLECTION, reflection, reflects())           /* a lobe of reflection: metal, coat or glass */ \
    MATERIAL(1, TRANSMISSION, transmission, has(Lobe::transmission))  /* light passes a surface */             \
    SCENE(2, SMOOTH, shading normals)            /* photons land where the shading normal is not the geometric one */ \
    SETTING(3, AOVS, further channels)                        /* depth, albedo and normal */                   \
    MATERIAL(4, GLOSS, directional gathering, glossy())       /* gathering weighs every photon by its direction */ \
    MATERIAL(5, ROUGH, rough lobes, is_rough())               /* a lobe of roughness above 0 */                \
    MATERIAL(6, COAT, coats, coat)                            /* a dielectric coat over a diffuse base */      \
    MATERIAL(7, CLEARCOAT, clearcoats, has(Lobe::clearcoat))                                                   \
    MATERIAL(8, THIN, thin walls, thin)                       /* thin-walled transmission */                   \
    MATERIAL(9, VOLUME, absorption, absorbs)                  /* inside solids */                              \
    MATERIAL(10, DISPERSION, dispersion, disperses)                                                            \
    MATERIAL(11, TEXTURES, textures, textured)                                                                 \
    MATERIAL(12, NORMAL_MAPS, normal maps, normal_map)                                                         \
    SCENE(13, TANGENTS, tangents)                             /* of the file, for normal maps */               \
    SCENE(14, VERTEX_COLORS, vertex colours)                                                                   \
    MATERIAL(15, ALPHA, alpha, alpha)                         /* surfaces that are partly not there */         \
    MATERIAL(16, UNLIT, unlit surfaces, unlit)                                                                 \
    MATERIAL(17, SHEEN, sheen, has(Lobe::sheen))              /* of fibres: include/sheen.glsl */              \
    MATERIAL(18, AREA_LIGHTS, area lights, is_lamp())                                                          \
    SCENE(19, TEXTURED_LIGHTS, textured lights)                                                                \
    SCENE(20, POINT_LIGHTS, point lights)                                                                      \
    SCENE(21, SPOT_LIGHTS, spot lights)                                                                        \
    SCENE(22, DIRECTIONAL_LIGHTS, directional lights)                                                          \
    SCENE(23, ENVIRONMENT, environment)                                                                        \
    /* light is split in two: photons bring caustics and what is lit at less than near_lights from its lamp, as  \
       fixtures are, paths the rest: include/split.glsl, host/study/reference.h */                             \
    SETTING(24, SPLIT, caustics alone)                                                                         \
    /* eye paths ask for direct light, photons bring the rest: include/direct.glsl */                          \
    SETTING(25, DIRECT, direct light asked for)                                                                \
    SCENE(26, INSTANCES, instances)              /* of meshes that are stored once */                          \
    MATERIAL(27, SPECULAR_GLASS, specular factors of glass, specular_glass)                                    \
    SCENE(28, NESTED, solids in one another)     /* or that touch or overlap: include/media.glsl */            \
    MATERIAL(29, ANISOTROPY, anisotropy, anisotropic)         /* facets wider along a tangent than across it */ \
    MATERIAL(30, IRIDESCENCE, iridescence, iridescent)        /* a thin film: include/thin_film.glsl */             \
    SETTING(31, ERRORS, errors of pixels)        /* what they are estimated from: render/error_estimate.h */
// clang-format on
#define FEATURE_BIT(bit, NAME, words) VKCPPM_CONST uint FEATURE_##NAME = 1u << bit;
#define FEATURE_BIT_OF_MATERIAL(bit, NAME, words, trait) FEATURE_BIT(bit, NAME, words)
FEATURE_TABLE(FEATURE_BIT_OF_MATERIAL, FEATURE_BIT, FEATURE_BIT)

// The lobes of a surface. Kernels go over them by include/bsdf.glsl, which says what a lobe is made of there, and the
// host by flat/material.h, which says where a material has them.
//   ROW(number, NAME, name, present)  present: the constant of a kernel by which scenes without it do not have its code
// Sums go over the rows in this order.
#define LOBES(ROW)                                        \
    ROW(0u, DIFFUSE, diffuse, true)                       \
    ROW(1u, REFLECTION, reflection, HAS_REFLECTION)       \
    ROW(2u, TRANSMISSION, transmission, HAS_TRANSMISSION) \
    ROW(3u, CLEARCOAT, clearcoat, HAS_CLEARCOAT)          \
    ROW(4u, SHEEN, sheen, HAS_SHEEN)

// Eye paths ask for lights where direct light is theirs, and where they may follow a rough lobe. Where light is split
// photons bring caustics alone, and of those an eye path finds what it meets by delta lobes after it has followed a
// rough one. One comparison, as glslc has no && of specialization constants: SPLIT, never with DIRECT, is above ROUGH.
#define ASKS_FOR_LIGHTS(features) \
    (((features) & (FEATURE_ROUGH | FEATURE_DIRECT)) > ((features) & FEATURE_SPLIT))
// Those that ask for parts of a SurfaceMaterial.
#define FEATURES_OF_SCATTERING (FEATURE_REFLECTION | FEATURE_TRANSMISSION)
#define FEATURES_OF_COATS (FEATURE_COAT | FEATURE_ALPHA | FEATURE_SPECULAR_GLASS)
#define FEATURES_OF_LAYERS (FEATURE_CLEARCOAT | FEATURE_ALPHA | FEATURE_NORMAL_MAPS)
#define FEATURES_OF_PUNCTUAL_LIGHTS (FEATURE_POINT_LIGHTS | FEATURE_SPOT_LIGHTS | FEATURE_DIRECTIONAL_LIGHTS)

#define FEATURES_OF_LOCAL_LIGHTS (FEATURE_AREA_LIGHTS | FEATURE_POINT_LIGHTS | FEATURE_SPOT_LIGHTS)
// Groups of lights that are asked for apart: AskedGroup.
#define GROUPS_ASKED(features)                                     \
    ((((features) & FEATURES_OF_LOCAL_LIGHTS) != 0u ? 1u : 0u) +   \
     (((features) & FEATURE_DIRECTIONAL_LIGHTS) != 0u ? 1u : 0u) + \
     (((features) & FEATURE_ENVIRONMENT) != 0u ? 1u : 0u))

#define MAX_RINGS 4
#define MAX_SECTORS 12

// Flags of a SurfaceMaterial.
#define SURFACE_DOUBLE_SIDED 0x1u  // emits from both sides
#define SURFACE_THIN 0x2u          // transmits without a volume
#define SURFACE_MASK 0x4u          // there where the alpha reaches the cutoff
#define SURFACE_BLEND 0x8u         // there with probability alpha
#define SURFACE_UNLIT 0x10u
#define SURFACE_TEXTURED 0x20u
#define SURFACE_CULLED 0x40u       // its back is not there for the camera

// Textures of a SurfaceMaterial.
#define TEXTURE_BASE_COLOR 0
#define TEXTURE_METALLIC_ROUGHNESS 1
#define TEXTURE_NORMAL 2
#define TEXTURE_EMISSIVE 3
#define TEXTURE_TRANSMISSION 4
#define TEXTURE_SPECULAR 5
#define TEXTURE_SPECULAR_COLOR 6
#define TEXTURE_CLEARCOAT 7
#define TEXTURE_CLEARCOAT_ROUGHNESS 8
#define TEXTURE_CLEARCOAT_NORMAL 9
#define TEXTURE_ANISOTROPY 10
#define TEXTURE_IRIDESCENCE 11
#define TEXTURE_IRIDESCENCE_THICKNESS 12
#define TEXTURE_SHEEN_COLOR 13
#define TEXTURE_SHEEN_ROUGHNESS 14
#define TEXTURE_COUNT 15

// Flags of a TextureLookup.
#define TEXTURE_WRAP_S 0x3u      // WRAP_*
#define TEXTURE_WRAP_T 0xcu      // WRAP_* << 2
#define TEXTURE_NEAREST 0x10u
#define TEXTURE_SECOND_UV 0x20u
#define TEXTURE_SRGB 0x40u       // its red, green and blue are sRGB-encoded
// Of a texel's second plane, whose bytes of -127 to 127 are in units of 1 / 65535.
#define FINE_SCALE (127.0f / 65535.0f)
#define WRAP_REPEAT 0u
#define WRAP_MIRRORED 1u
#define WRAP_CLAMP 2u

// Light kinds.
#define LIGHT_TRIANGLE 0u
#define LIGHT_POINT 1u
#define LIGHT_SPOT 2u
#define LIGHT_DIRECTIONAL 3u
#define LIGHT_ENVIRONMENT 4u

#define BVH_LEAF 0x80000000u  // set where a word may name a node or a leaf
#define BVH_MAX_LEAF 4
#define BVH_MAX_NODE_BITS 22  // of an index of a node, so that a word of the traversal stack holds it
// BvhNode::children: index << BVH_CHILDREN_SHIFT | how many of the children are nodes.
#define BVH_CHILDREN_SHIFT 3
#define BVH_CHILDREN_MASK 7u

// Top bit of the fourth word of a node: it is an InstanceNode.
#define BVH_INSTANCE 0x80000000u
#define BVH_ENTER 0x40000000u // with BVH_LEAF, where a word may name a node or a leaf: a node that is an instance
#define NO_INSTANCE 0xffffffffu

// Top bit of TriangleShading::material: the three normals are the geometric normal.
#define SHADING_FLAT 0x80000000u

// Last word of a triangle's tangents, the first three of which are octahedral tangents of its corners.
#define TANGENTS_GIVEN 7u    // bit c: corner c has one
#define TANGENTS_TURNED 8u   // << c: the bitangent of corner c points the other way

// 4-wide node, 64 bytes, read as 4 uvec4 texels. Box of child c on axis a:
// origin[a] + 2^(exponent[a] - 127) * byte c of q[a].
struct BvhNode {
    vec3 origin;
    uint exponents;    // biased exponents of the cell size, x | y << 8 | z << 16; bit 24 + c: there is a child c
    uint low_x;        // byte c: child c
    uint low_y;
    uint low_z;
    uint high_x;
    uint high_y;
    uint high_z;
    uint children;     // those that are nodes come first, and stand side by side: the index of the first of them, or
                       // of this node itself where all are leaves
    uint unused;
    uint leaves[2];         // where all children are leaves: their first triangle; byte c: what comes before child c
                            // | its triangles << 4
    uint parent_leaves[2];  // where this is the first node of its siblings: the same of the parent's leaves
};

// What stands in the place of a BvhNode where a child is an instance of a mesh: the way into the mesh's space and the
// root of its own tree. 64 bytes. That space is centred on the mesh and scaled by a power of two to a radius in
// (1/2, 1], as the scene's frame is on the scene.
struct InstanceNode {
    vec3 centre;       // where the origin of the mesh's space is, scene frame
    uint index;        // into the instances | BVH_INSTANCE
    vec3 to_mesh[3];   // rows: mesh's space = rows * (scene frame - centre)
    uint root;
    uint parent_leaves[2];  // as of a BvhNode
};

// The way back, for what is met: 64 bytes, read as 4 uvec4 texels.
#define FIELDS_Instance(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec4, row_x)      /* scene frame = row.xyz * mesh's space + row.w */ \
    FIELD(vec4, row_y) \
    FIELD(vec4, row_z) \
    FIELD(float, error)     /* rays start so far off its planes, */ \
    FIELD(float, stretch)   /*   and so many times the error of the triangle in its space more */ \
    FIELD(float, hand)      /* -1: it is mirrored, and the front of a triangle is on its other side */ \
    FIELD(float, size)      /* largest length of a row's xyz */
RECORD(Instance)

// Moeller-Trumbore form, 48 bytes, read as 3 vec4 texels.
struct TriangleGeometry {
    vec3 v0;
    float error;       // bound of the rounding error of a point on it: rays start this far off its plane
    vec3 e1;           // v1 - v0
    float slack_u;     // bounds of the rounding of barycentrics, for a ray origin at distance 1 and a determinant of 1
    vec3 e2;           // v2 - v0
    float slack_v;
};

// 16 bytes, read as 1 uvec4 texel.
struct TriangleShading {
    uint normal[3];    // octahedral snorm16x2
    uint material;     // index | SHADING_FLAT
};

// 208 bytes, read as 13 uvec4 texels, and of those only what the scene's features need. Factors as in glTF; a texture
// multiplies them.
#define FIELDS_SurfaceMaterial(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, color)      /* base colour */ \
    FIELD(uint, flags)      /* SURFACE_* */ \
    FIELD(vec3, emission)   /* radiance, W m^-2 sr^-1 */ \
    FIELD(float, specular) \
    OPTIONAL(FEATURES_OF_SCATTERING, 0.0f, float, metallic) \
    OPTIONAL(FEATURES_OF_SCATTERING, 0.0f, float, roughness)  /* alpha = roughness^2 */ \
    OPTIONAL(FEATURES_OF_SCATTERING, 0.0f, float, transmission) \
    OPTIONAL(FEATURES_OF_SCATTERING, 1.0f, float, ior)  /* at 587.6 nm; very large for an index of infinity */ \
    OPTIONAL(FEATURES_OF_COATS, vec3(1.0f), vec3, specular_color) \
    OPTIONAL(FEATURES_OF_COATS, 1.0f, float, opacity) \
    OPTIONAL(FEATURE_VOLUME, vec3(0.0f), vec3, absorption)  /* of the volume, 1 / frame unit */ \
    OPTIONAL(FEATURE_DISPERSION, 0.0f, float, cauchy)  /* B of n(l) = A + B / l^2, micrometres squared */ \
    OPTIONAL(FEATURES_OF_LAYERS, 0.0f, float, clearcoat) \
    OPTIONAL(FEATURES_OF_LAYERS, 0.0f, float, clearcoat_roughness) \
    OPTIONAL(FEATURES_OF_LAYERS, 0.0f, float, alpha_cutoff) \
    OPTIONAL(FEATURES_OF_LAYERS, 1.0f, float, normal_scale) \
    ARRAY(FEATURE_TEXTURES, uint, texture, TEXTURE_COUNT)  /* 1 + index of a TextureLookup; 0: none */ \
    OPTIONAL(FEATURE_TEXTURES, 1.0f, float, clearcoat_normal_scale) \
    OPTIONAL(FEATURE_NESTED, 0u, uint, priority)  /* of the solid; where several are, the largest counts */ \
    OPTIONAL(FEATURE_IRIDESCENCE, 0.0f, float, iridescence)  /* share of the surface with a film */ \
    /* cosine and sine of the angle from the tangent to where the facets are wider; strength */ \
    OPTIONAL(FEATURE_ANISOTROPY, vec3(1.0f, 0.0f, 0.0f), vec3, anisotropy) \
    OPTIONAL(FEATURE_IRIDESCENCE, 1.0f, float, film_index) \
    OPTIONAL(FEATURE_IRIDESCENCE, vec2(0.0f), vec2, film_thickness)  /* least and most, micrometres */ \
    OPTIONAL(FEATURE_SHEEN, vec3(0.0f), vec3, sheen_color) \
    OPTIONAL(FEATURE_SHEEN, 0.0f, float, sheen_roughness)  /* width = roughness^2 */
RECORD(SurfaceMaterial)

// 48 bytes, read as 3 uvec4 texels. uv' = (matrix.xy . uv, matrix.zw . uv) + offset.
#define FIELDS_TextureLookup(FIELD, ARRAY, OPTIONAL) \
    FIELD(uint, first)                   /* texel of its image */ \
    FIELD(uint, width) \
    FIELD(uint, height) \
    FIELD(uint, flags)                   /* TEXTURE_* */ \
    FIELD(vec4, matrix)                  /* rows */ \
    FIELD(vec2, offset) \
    FIELD(uint, fine)                    /* texel of its second plane, what 16 bits have beyond 8; 0: none */ \
    FIELD(uint, unused)
RECORD(TextureLookup)

// One entry of the alias table of lights; 96 bytes, read as 6 uvec4 texels, of which photons read two for textured
// lights only. A path that starts here carries `power`: flux of the light / its probability.
#define FIELDS_Light(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, position)      /* triangle: v0; point, spot: position */ \
    FIELD(uint, kind)          /* LIGHT_* */ \
    FIELD(vec3, e1)            /* triangle: edge; others: axis_of (include/light.glsl) */ \
    FIELD(float, keep)         /* alias table: probability to keep this entry */ \
    FIELD(vec3, e2)            /* triangle: edge; point, spot: range_of; spot: cones_of, 1 - cos of both angles */ \
    FIELD(uint, alias_entry)   /* alias table: the other entry */ \
    /* W (frame-scaled); directional, environment: into the scene; environment: the mean channel alone, times \
       the colour of the pixel drawn and entry_area over its mean in the pixel */ \
    FIELD(vec3, power) \
    FIELD(uint, double_sided)  /* triangle */ \
    /* textured: barycentrics of its corners in the triangle that it is a part of */ \
    ARRAY(FEATURE_TEXTURED_LIGHTS, vec2, corner, 3) \
    /* triangle: into the leaf-ordered ones; textured: that which it is a part of */ \
    OPTIONAL(FEATURE_AREA_LIGHTS, 0u, uint, triangle) \
    OPTIONAL(FEATURE_TEXTURED_LIGHTS, 0u, uint, textured)  /* of its radiance a share gets out, by place or direction */
RECORD(Light)

// Lights are asked for in groups: local ones (triangles, points, spots), directional ones, the environment. Each has
// candidates and a ray of its own, for power compares lights within a group alone: that of a sun, all that enters the
// scene's bounds, tells little of what arrives indoors.
#define ASKED_GROUPS 3u  // at most
struct AskedGroup {
    uint first;       // of asked_lights, and how many: of a lamp, where there is no tree
    uint count;
    uint candidates;  // of which an eye path takes one
    uint depth;       // of the light tree, branches; 0: there is none
};

// An entry of the alias table of a lamp: lights that are drawn in proportion to their power. The numbers are of lights.
#define FIELDS_AskedLight(FIELD, ARRAY, OPTIONAL) \
    FIELD(uint, light) \
    FIELD(float, keep)        /* probability to keep this light */ \
    FIELD(uint, alias_light)  /* the other */ \
    FIELD(float, power)       /* of the lamp, mean channel, W (frame-scaled) */
RECORD(AskedLight)

// A branch of the light tree, of two children, each a branch or a lamp (include/light_tree.glsl): 80 bytes, read as 5
// texels. The first is the root.
#define FIELDS_LightBranch(FIELD, ARRAY, OPTIONAL) \
    ARRAY(ANY_FEATURE, vec4, sphere, 2)  /* about its lights: centre, radius */ \
    ARRAY(ANY_FEATURE, uint, axis, 2)    /* of the cone of their normals, octahedral snorm16x2 */ \
    /* cosine of that cone, snorm16 | cosine of how far from a normal they shine, 15 bits << 16 | LIGHT_BOTH_SIDES */ \
    ARRAY(ANY_FEATURE, uint, cones, 2) \
    ARRAY(ANY_FEATURE, float, reach, 2)  /* beyond which they shed no light, frame units */ \
    ARRAY(ANY_FEATURE, uint, first, 2)   /* of asked_lights, or the branch */ \
    ARRAY(ANY_FEATURE, uint, count, 2)   /* of these; 0: it is a branch */ \
    FIELD(float, ratio)                  /* intensity of the second over that of the first */ \
    FIELD(uint, parent)                  /* its branch << 1 | which child this is */
RECORD(LightBranch)
#define LIGHT_BOTH_SIDES 0x80000000u
#define NO_LAMP 0xffffffffu  // in place of a branch << 1 | which child

// A stored photon: what the distance test reads (16 bytes) and what an accepted photon adds (16 bytes).
#define FIELDS_Photon(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, position) \
    FIELD(uint, normal)    /* geometric, on the side it arrived at, octahedral snorm16x2 */
RECORD(Photon)
#define FIELDS_PhotonFlux(FIELD, ARRAY, OPTIONAL) \
    /* W (frame-scaled), not yet divided by the number of emitted paths; its sign bits: include/photon_flux.glsl */ \
    FIELD(vec3, power) \
    FIELD(uint, direction)  /* unit, towards where it came from, octahedral snorm16x2 */
RECORD(PhotonFlux)

// Where an eye path ended. 3 records of 16 bytes, one array each, and a fourth in glossy scenes.
#define FIELDS_HitPosition(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, position)  /* scene frame */ \
    /* HIT_* | diffuse albedo, 10 bits a channel, << HIT_BITS: what the F-tests weigh photons by; hit_kind, hit_albedo \
       and hit_state of include/hits.glsl */ \
    FIELD(uint, state)
RECORD(HitPosition)
#define FIELDS_HitWeight(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, weight)  /* path throughput * albedo / pi (glossy scenes: / pi alone) */ \
    FIELD(uint, normal)  /* shading normal on the eye's side, octahedral */
RECORD(HitWeight)
#define FIELDS_HitEmission(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, emission)    /* throughput * radiance of emitters met on the way */ \
    FIELD(float, footprint)  /* radius of the pixel's footprint at the hit, scene frame */
RECORD(HitEmission)
#define FIELDS_HitSurface(FIELD, ARRAY, OPTIONAL) \
    FIELD(uint, triangle)     /* what the BSDF is made from again */ \
    FIELD(vec2, barycentric) \
    FIELD(uint, outgoing)     /* unit, towards the eye, octahedral snorm16x2 */
RECORD(HitSurface)
#define HIT_NONE 0u        // nothing to gather: the path left the scene or was absorbed
#define HIT_DIFFUSE 1u     // gathers photons that arrive on the side it is seen from
#define HIT_UNFINISHED 2u  // the step budget ran out: the next round goes on with the EyeState
#define HIT_BOTH_SIDES 3u  // gathers on a rough surface that transmits
#define HIT_MASK 3u
#define HIT_BITS 2u

// The flags of a path in flight, one word: bounces | PATH_* | material of the solid it is in << PATH_MEDIUM_SHIFT.
#define PATH_BOUNCES 0x7ffu     // surfaces that have sent it elsewhere, up to the largest --max-depth, 1024
#define PATH_STRAIGHT 0x800u    // it has met nothing but delta lobes since it left the eye or a punctual light; where
                                // light is split, a photon also since a surface near its lamp
#define PATH_DISPERSED 0x1000u  // its wavelength is drawn
#define PATH_DIRECT 0x2000u     // a photon that has met nothing yet since it left its light
// Not of eye paths. Where light is split or in layers: a photon since it met another lobe than a delta, but for the
// surface near its lamp; a path of the path tracer whose last lobe was no delta, and one before it neither.
#define PATH_SCATTERED 0x4000u
// Of eye paths alone, which have no use for PATH_SCATTERED: no bit of the word is left. It has met a surface that is
// there.
#define PATH_SEEN PATH_SCATTERED
// Of eye paths alone, which have no use for PATH_DIRECT: it has followed more than one rough lobe.
#define PATH_ROUGH_TWICE PATH_DIRECT
#define PATH_CAUSTIC 0x8000u    // a photon that left its light by way of a delta lobe, or of a surface near a lamp; an
                                // eye path whose last lobe was a delta and one before was not
#define PATH_MEDIUM_SHIFT 16u
#define PATH_NO_MEDIUM 0xffffu  // so a scene has fewer materials

#define MOST_MET 0x100000u      // surfaces that a path meets, those that it passes straight included; there it ends

// What light has met between its source and the surface that is seen: the first that is not perfectly smooth. What is
// seen to emit is direct light too. LAYER_DIRECT and LAYER_CAUSTIC index Aovs::layer.
#define LAYER_DIRECT 0u   // nothing
#define LAYER_CAUSTIC 1u  // mirrors and smooth glass alone
#define LAYER_REST 2u     // other surfaces
#define LAYERS 2u         // that are summed: the picture less these is the rest

// A ray that asks whether a light is seen (next-event estimation).
struct LightRay {
    vec3 origin;
    float distance;    // left to the light; 0: there is no ray
    vec3 direction;
    uint triangle;     // of the light, which the ray may meet; NO_TRIANGLE: a light of no area
    vec3 light;        // what it adds to the picture where nothing is in between
    uint layer;        // LAYER_*: of which that is
};
#define NO_TRIANGLE 0xffffffffu

// One of each group of lights; the first of them is traced next.
struct LightRays {
    LightRay of[ASKED_GROUPS];
};

// An eye path between two rays: while it is in flight, and where it runs out of steps until the next round.
struct EyeState {
    vec3 origin;           // of the next ray
    uint flags;            // bounces | PATH_*
    vec3 direction;
    float followed;        // density with which rough lobes gave the direction, 1/sr; 0: none did
    vec3 throughput;
    float leg;             // length since the last vertex
    vec3 emission;         // throughput * radiance of what it has met so far
    float distance;        // length since the eye
    uint end;              // state of the hit that it has ended in; HIT_UNFINISHED: it goes on
    vec3 layer[LAYERS];    // of the emission, where there are further channels
    vec3 direct;           // what the throughput is for direct light that the next ray meets: include/direct.glsl
    uint met;              // surfaces
    uvec2 media;           // include/media.glsl
    float bias;            // of the gather that follows: where errors are estimated
};

// Sum of one pass of the gather over a pixel's disc, read as 2 texels.
#define FIELDS_Gathered(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, flux)    /* sum of photon power * correction, without the hit's weight */ \
    FIELD(uint, count)   /* accepted photons */ \
    FIELD(vec3, excess)  /* what rounding has left too much in flux (Kahan 1965) */ \
    /* photons in the cells that were walked; at the end those in a disc of their density, or more in this one */ \
    FIELD(uint, tested)
RECORD(Gathered)

// A search for the k nearest photons of a pixel at the end of a round.
struct SearchState {
    float largest;         // kept squared distance, once there are k; -1: none
    uint largest_index;    // its row of nearest
    float radius;          // within which it looks
    uint kept;             // squared distances
};

// What a pixel remembers between iterations, read as 3 texels.
#define FIELDS_PixelState(FIELD, ARRAY, OPTIONAL) \
    FIELD(float, radius2)      /* R^2 in force, 0 before the pixel first saw a diffuse surface */ \
    FIELD(uint, seeded)        /* 1 once the k-th nearest photon gave the radius; 0: radius2 is the cap */ \
    FIELD(float, count)        /* what the estimator's rule counts: its file in shaders/estimators says what */ \
    FIELD(uint, total)         /* photons accepted since the last reset of the tally; stays at its largest value */ \
    FIELD(float, batch)        /* B, photons to see before a test */ \
    FIELD(uint, rejections) \
    FIELD(uint, photons)       /* accepted in all; stays at its largest value */ \
    FIELD(uint, seen)          /* iterations in which the pixel saw a diffuse surface */ \
    FIELD(float, statistic)    /* of the last test of the whole disc, over its threshold */ \
    /* radius2 + radius2_low: R^2 where a schedule shrinks it by little in every iteration */ \
    FIELD(float, radius2_low) \
    FIELD(float, count_low)    /* count + count_low: the count, beyond what a float holds */ \
    /* about pi R^2 over the area of the surface in this iteration's disc, less 1; 0: it is not measured */ \
    FIELD(float, excess)
RECORD(PixelState)

// What a picture's first surfaces are like: sums over the iterations in which the pixel met one.
// Each in two floats, as Film.
struct Aovs {
    vec3 albedo;       // base colour
    vec3 normal;       // shading, world axes
    float depth;       // along the camera's axis, scene frame
    uint hits;
    vec3 albedo_low;
    vec3 normal_low;
    float depth_low;
    vec3 layer[LAYERS];      // of radiance, sums over all iterations
    vec3 layer_low[LAYERS];
};

// Groups of iterations from whose spread errors of pixels are estimated: render/error_estimate.h.
#define ERROR_GROUPS 8

// Sum of radiance in two floats: sum + low is the estimate times the iterations.
#define FIELDS_Film(FIELD, ARRAY, OPTIONAL) \
    FIELD(vec3, sum) \
    FIELD(vec3, low)
RECORD(Film)

// A light path in flight at the end of a round, one a lane.
struct PathState {
    vec3 origin;
    uint path;         // NO_PATH: none in flight
    vec3 direction;
    uint flags;        // bounces | PATH_*
    vec3 power;
    uint stored;       // photons this lane has stored
    float power0;      // largest channel of the power at emission, for Russian roulette
    uint begin;        // stored before this path
    uint next;         // path that the SIMD group takes next
    // Less what it has gone: > 0: the length from its light within which photons bring direct light; < 0: the negative
    // of what its light reaches, while it goes straight on; 0: neither.
    float near;
    uint met;          // surfaces
    uvec2 media;       // include/media.glsl
};
#define NO_PATH 0xffffffffu

// A path of the path tracer in flight at the end of a round, one a pixel: the next ray of the path, and before it the
// rays to lights, where some are asked for.
struct TraceState {
    vec3 origin;
    uint flags;            // bounces | PATH_*
    vec3 direction;
    float density;         // pdf of the direction, 1/sr; DELTA after the camera and delta lobes
    vec3 throughput;
    float distance;        // since the last vertex
    vec3 radiance;         // of this path so far
    uint done;             // paths of this launch
    vec3 sum;              //   and their radiance
    uint ended;            // 1: the path ends with the rays to lights
    LightRays light_rays;
    uint met;              // surfaces
    uvec2 media;           // include/media.glsl
};

// Where a resumable walk over the grid goes on.
struct Cursor {
    uvec3 cell;        // first cell of the segment; x: CURSOR_START or CURSOR_DONE
    uint photon;       // photons of the segment that were seen
};
#define CURSOR_START 0xffffffffu
#define CURSOR_DONE 0xfffffffeu

#define GRID_LEVELS 4      // at most

// The grid in force. Every level has cells of its own size and holds all photons: discs look at those of the level
// whose cells suit them.
struct Grid {
    vec3 origin;
    uint levels;                      // in use, from the finest on
    uvec4 dims[GRID_LEVELS];          // cells an axis; w: 0 dense rows, else mask of the hash table
    float cell[GRID_LEVELS];          // side
    float inverse_cell[GRID_LEVELS];
    float reach[GRID_LEVELS];         // largest radius that looks here; LARGEST_FLOAT from the last in use on
    uint first[GRID_LEVELS];          // its first entry of the table of cell starts
    uint entries;                     // of that table, in use: at most params.cells
};

#define RADIUS_BINS 64     // histogram of log2 R: include/radius_bins.glsl

struct Status {
    uint blocked;      // PASS_* bits: passes after these do nothing until the host has seen to them
    uint completed;    // iterations whose update has run
    uint capacity;     // largest number of photons that one lane wanted to store
    uint stuck;        // rays that need more than a whole budget: the scene cannot be traced
    uint invalid;      // contributions dropped because they were not finite
    uint rays;         // traced since the host last cleared it, low word
    uint stored;       // photons stored since the host last cleared it
    uint rays_high;
    uint levels;       // that the grid is to have
    uint band;         // of the picture, that is next in this iteration: from the eye pass on
    uint searches;     // its pixels that gather in this iteration without a seeded radius
    uvec3 search_groups;  // work groups for them
    // From here on what the next plan of the grid is made from, and so what a checkpoint holds.
    uint photons;      // stored in the last iteration
    uint radius_histogram[RADIUS_BINS];     // pixels that gather
    uint photon_histogram[RADIUS_BINS];     // photons in discs like theirs (Gathered::tested), low word
    uint photon_histogram_high[RADIUS_BINS];
};

// Per render.
struct Params {
    vec3 eye;              // where the lens is, plus `start` along the axis
    uint width;
    vec3 right;            // half of the image plane; of a perspective camera at distance 1
    uint height;
    vec3 up;
    uint seed;
    vec3 forward;          // unit
    float pixel_radius;    // radius of a pixel's footprint; of a perspective camera at distance 1
    vec3 bounds_low;       // of the triangles, padded
    uint photons;          // paths an iteration
    vec3 bounds_high;
    uint photons_per_lane; // paths
    uint photon_lanes;
    uint photon_capacity;  // slots a lane
    float bounds_radius;   // of a sphere about the origin, padded alike
    uint max_depth;
    uvec2 eye_media;       // the solids that the eye is in, as of a path: include/media.glsl
    uint eye_medium;
    uint light_count;
    float near_lights;     // frame units; 0 where light is not split
    float light_power;     // of all lights, mean channel, W (frame-scaled): what the alias table is in proportion to
    AskedGroup asked[ASKED_GROUPS];  // GROUPS_ASKED of them, at the end some of no lights
    float local_power;     // of the group of local lights
    float environment_power;
    uvec2 environment;     // its columns and rows
    float lens_radius;     // frame units, 0: a pinhole; at focus_distance along the axis a point is sharp
    float focus_distance;
    float start;           // depth at which eye rays begin, frame units: 0 but for an eye far from the scene
    uint orthographic;     // 1: eye rays are parallel, 0: they meet in the eye
    uint step_budget;      // loop trips of one invocation of a resumable kernel
    uint knn;
    float radius_cap;      // largest starting radius
    float radius_floor;    // the cap by footprint never goes below this: a disc of k photons at mean density
    float footprint_cap;   // starting radius in footprints of the pixel
    float inverse_paths;   // 1 / photons; 0 where nothing emits
    float flux_unit;       // power of two, times light_power in [1, 2): with it squares of fluxes are within floats
    float alpha;
    float k;
    float beta;
    uint keeps_radii;      // 1: estimators leave a radius as it is, which the host has set: host/render/slices.h
    uint cells;            // capacity of the cell table, a power of two
    uint grid_levels;      // that there is room for now
    uint most_levels;      //   and can be
    uint sort_lanes;       // columns of the radix histogram
    uint scan_blocks;      // a multiple of the work group
    float threshold[MAX_RINGS];          // chi-squared quantile for the disc of the first i + 1 rings
    vec2 sector_edge[MAX_SECTORS / 2];   // unit vectors at 2 pi s / n_s, s < n_s / 2
    vec2 sector_centre[MAX_SECTORS];     // unit vectors at pi (2 s + 1) / n_s
};

// Regions of the counter buffer, in words. The table of cell starts comes first: the searches index it directly.
// cell starts [cells + 1] | photons of each path, then their offsets [photons + 1] | slot of the first of each
// [photons] | radix histogram [digits x columns] | sums of scan blocks [scan_blocks]. p: Params; bits: SPEC_DIGIT_BITS.
#define COUNTERS_OF_CELLS 0u
#define COUNTERS_OF_PATHS(p) ((p).cells + 1u)
#define COUNTER_OF_PHOTONS(p) (COUNTERS_OF_PATHS(p) + (p).photons)
#define COUNTERS_OF_SLOTS(p) (COUNTER_OF_PHOTONS(p) + 1u)
#define COUNTERS_OF_RADIX(p) (COUNTERS_OF_SLOTS(p) + (p).photons)
#define COUNTERS_OF_SCAN(p, bits) (COUNTERS_OF_RADIX(p) + ((p).sort_lanes << (bits)))
#define COUNTERS_IN_ALL(p, bits) (COUNTERS_OF_SCAN(p, bits) + (p).scan_blocks)

// Per launch: push constants. Each word is of the kernels named, and 0 for the others.
struct Launch {
    uint iteration VKCPPM_ZERO;
    uint round VKCPPM_ZERO;        // of a resumable pass
    uint last_round VKCPPM_ZERO;   // 1: unfinished work blocks the passes that follow
    uint paths VKCPPM_ZERO;        // path: paths a pixel
    uint search_group VKCPPM_ZERO; // searches: invocations a work group of knn
    uint level VKCPPM_ZERO;        // grid_key: of the grid
    uint scan_first VKCPPM_ZERO;   // scans: the first counter
    uint scan_count VKCPPM_ZERO;   //   and how many
    uint digit_shift VKCPPM_ZERO;  // radix: bits below the digit
    uint reads_b VKCPPM_ZERO;      // radix: 1: from pairs_b to pairs_a, 0: from pairs_a to pairs_b
    uint plans_next VKCPPM_ZERO;   // update: 1: the next grid is planned, the radii are counted for it
    uint error_group VKCPPM_ZERO;  // update: of the iteration: include/error_groups.glsl
    // Of the band of the picture that the buffers of pixels hold, or are bound to: include/kernel.glsl.
    uint band VKCPPM_ZERO;         // its number; 0 in the passes of photons
    uint last_band VKCPPM_ZERO;    // advance: 1: no other comes after it
    uint first_pixel VKCPPM_ZERO;  // of the picture's
    uint pixels VKCPPM_ZERO;       // in it
    uint argument VKCPPM_ZERO;     // kernels of tests and benchmarks: their file says what
    uint items VKCPPM_ZERO;        //   and how many they go over
};

#ifdef __cplusplus
static_assert(sizeof(BvhNode) == 64 && sizeof(InstanceNode) == 64 && sizeof(Instance) == 64);
static_assert(sizeof(TriangleGeometry) == 48);
static_assert(sizeof(TriangleShading) == 16);
static_assert(sizeof(SurfaceMaterial) == 208 && sizeof(TextureLookup) == 48 && sizeof(Light) == 96);
static_assert(sizeof(AskedLight) == 16 && sizeof(LightBranch) == 80);
static_assert(sizeof(Photon) == 16 && sizeof(PhotonFlux) == 16);
static_assert(sizeof(HitPosition) == 16 && sizeof(HitWeight) == 16 && sizeof(HitEmission) == 16 &&
              sizeof(HitSurface) == 16);
static_assert(sizeof(Gathered) == 32 && sizeof(PixelState) == 48 && sizeof(Film) == 24 && sizeof(LightRay) == 48);
static_assert(sizeof(Launch) <= 128);
}  // namespace vkcppm::gpu
namespace vkcppm {
#define USE_FEATURE(bit, NAME, words) using gpu::FEATURE_##NAME;
#define USE_FEATURE_OF_MATERIAL(bit, NAME, words, trait) USE_FEATURE(bit, NAME, words)
FEATURE_TABLE(USE_FEATURE_OF_MATERIAL, USE_FEATURE, USE_FEATURE)
}  // namespace vkcppm
#endif
