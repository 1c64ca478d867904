// What every kernel starts with: shared types, specialization constants, the launch block, buffers.
#ifndef KERNEL_GLSL
#define KERNEL_GLSL

#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shared/types.h"
#include "shared/kernels.h"
#include "shared/buffers.h"
#include "include/records.glsl"

layout(local_size_x_id = SPEC_WORKGROUP) in;
layout(constant_id = SPEC_STACK) const uint STACK = 32;
layout(constant_id = SPEC_RINGS) const uint RINGS = 2;
layout(constant_id = SPEC_SECTORS) const uint SECTORS = 6;
layout(constant_id = SPEC_FEATURES) const uint FEATURES = 0xffffffffu;
layout(constant_id = SPEC_DIGIT_BITS) const uint DIGIT_BITS = 7;
layout(constant_id = SPEC_NODE_BITS) const uint NODE_BITS = 20;
layout(constant_id = SPEC_LEVELS) const uint LEVELS = GRID_LEVELS;
layout(constant_id = SPEC_WAITS) const uint WAITS = 0u;
layout(constant_id = SPEC_DEALS) const uint DEALS = 1u;
layout(constant_id = SPEC_LIGHT_TREE) const uint LIGHT_TREES = 0u;
layout(constant_id = SPEC_PLANES) const uint PLANES = 2u;

#define HAS_FEATURE(bit, NAME, words) const bool HAS_##NAME = (FEATURES & FEATURE_##NAME) != 0u;
#define HAS_FEATURE_OF_MATERIAL(bit, NAME, words, trait) HAS_FEATURE(bit, NAME, words)
FEATURE_TABLE(HAS_FEATURE_OF_MATERIAL, HAS_FEATURE, HAS_FEATURE)
const bool HAS_LIGHT_TREE = LIGHT_TREES != 0u;
const bool HAS_PUNCTUAL_LIGHTS = (FEATURES & FEATURES_OF_PUNCTUAL_LIGHTS) != 0u;
const uint GROUPS = GROUPS_ASKED(FEATURES);
const bool EYE_PATHS_ASK = ASKS_FOR_LIGHTS(FEATURES);

layout(push_constant, scalar) uniform LaunchBlock { Launch launch; };
PARAMS(UNIFORM)
STATUS(VALUE)

// Index of this work group; the host folds dispatches beyond the device's limit of groups in x into y.
uint work_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint invocation() { return work_group() * gl_WorkGroupSize.x + gl_LocalInvocationIndex; }

#define RIFFLED_GROUPS 16u  // that stay together: memory is read best in order

// The pixel of this invocation. Software Vulkan gives every thread one run of consecutive work groups, and one half of
// a picture may cost twice as much as the other: the groups are riffled, so that every run has some of all. Each riffle
// deals the first half to the even places and the second to the odd ones; what does not fill a pack stays at the end.
uint invocation_pixel() {
    uint group = work_group();
    uint packs = gl_NumWorkGroups.x * gl_NumWorkGroups.y / RIFFLED_GROUPS;
    uint middle = (packs + 1u) / 2u;
    uint pack = group / RIFFLED_GROUPS;
    for (uint riffle = 0u; riffle < 3u && pack < packs; ++riffle) {
        pack = pack < middle ? 2u * pack : 2u * (pack - middle) + 1u;
    }
    return (pack * RIFFLED_GROUPS + group % RIFFLED_GROUPS) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
}

// True where this launch must leave everything as it is: another pass than `own` (PASS_* bits) waits for the host, or
// an iteration, or a band of the picture, before this one does.
bool blocked(uint own) {
    return (status.blocked & ~own) != 0u || status.completed != launch.iteration || status.band != launch.band;
}

// Unfinished work of pass `own` in its last round blocks the passes after it; lanes of the same pass go on.
void block_after(uint own) {
    if (launch.last_round != 0u) atomicOr(status.blocked, own);
}

void count_rays(uint rays) {
    uint before = atomicAdd(status.rays, rays);
    if (before + rays < before) atomicAdd(status.rays_high, 1u);
}

// A picture is gone through in bands of pixels, one where it is small. Buffers are indexed by the pixel's place in its
// band; what a pixel is in the picture, and draws its random numbers for, is its place there.
uint pixel_count() { return launch.pixels; }
uint picture_pixel(uint pixel) { return launch.first_pixel + pixel; }

#endif
