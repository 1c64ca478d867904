// Kernels folded to constants: valid by spirv-val, without a constant left to specialise, smaller, and as small as it
// gets; and what is not folded is left as it is. That they compute the same: kernels/fold_test.cpp.

#include "vk/fold.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shared/types.h"
#include "unit/modules.h"
#include "vk/spirv.h"

namespace vkcppm::test {
namespace {

/// Constants of a scene with those features.
Specialization constants_of(std::uint32_t features) {
    return {{SPEC_WORKGROUP, 64},      {SPEC_STACK, 11},    {SPEC_RINGS, 2},  {SPEC_SECTORS, 6},
            {SPEC_FEATURES, features}, {SPEC_NODE_BITS, 9}, {SPEC_LEVELS, 3}, {SPEC_DIGIT_BITS, 7},
            {SPEC_WAITS, 1},           {SPEC_DEALS, 1},     {SPEC_PLANES, 1}};
}

/// What constants can differ in: no feature, all, each alone, some of a kind together, and limits of all others.
std::vector<Specialization> spread() {
    std::vector<Specialization> all;
    for (int bit = 0; bit < 32; ++bit) all.push_back(constants_of(1u << bit));
    all.push_back(constants_of(0));
    all.push_back(constants_of(~0u));
    all.push_back(constants_of(FEATURE_REFLECTION | FEATURE_TRANSMISSION | FEATURE_AREA_LIGHTS | FEATURE_DIRECT));
    all.push_back(constants_of(FEATURE_REFLECTION | FEATURE_TEXTURES | FEATURE_NORMAL_MAPS | FEATURE_ROUGH |
                               FEATURE_GLOSS | FEATURE_ENVIRONMENT | FEATURE_DIRECTIONAL_LIGHTS | FEATURE_DIRECT));
    all.push_back({});  // as glslc has them
    all.push_back({{SPEC_WORKGROUP, 1}, {SPEC_STACK, 1}, {SPEC_RINGS, 1}, {SPEC_SECTORS, 2}, {SPEC_LEVELS, 1}});
    all.push_back({{SPEC_WORKGROUP, 256}, {SPEC_RINGS, MAX_RINGS}, {SPEC_SECTORS, MAX_SECTORS}, {SPEC_NODE_BITS, 22}});
    return all;
}

bool has(const Words& words, auto is) { return std::ranges::any_of(instructions_of(words), is); }

bool is_to_specialise(Instruction instruction) {
    const spv::Op op = opcode(instruction);
    return (op >= spv::OpSpecConstantTrue && op <= spv::OpSpecConstantOp) ||
           (op == spv::OpDecorate && instruction[2] == spv::DecorationSpecId);
}

void expect_folded(const Words& before, const Specialization& constants) {
    const Words after = folded(before, constants);
    EXPECT_FALSE(has(after, is_to_specialise));
    EXPECT_LT(after.size(), before.size());
    EXPECT_LT(after[spirv_bound], before[spirv_bound]);
    EXPECT_EQ(folded(after, {}), after) << "more could be folded";
}

TEST(FoldedModules, FoldsEveryKernelToAnyConstants) {
    const auto all = spread();
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        const Words before = words_of_kernel(row.id, estimator);
        ASSERT_TRUE(has(before, is_to_specialise));
        for (std::size_t i = 0; i < all.size(); ++i) {
            // Estimators differ in little that features decide.
            if (i < 32 && estimator != estimators().front().name) continue;
            SCOPED_TRACE(fmt::format("{} of {}, constants {}", row.name, estimator, i));
            expect_folded(before, all[i]);
        }
    });
}

// spirv-val takes up to 0.2 s for a module.
TEST(FoldedModules, LeavesValidModules) {
    const Specialization glass = constants_of(FEATURE_AREA_LIGHTS | FEATURE_TRANSMISSION);
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        EXPECT_EQ(faults(folded(words_of_kernel(row.id, estimator), glass)), "") << row.name << " of " << estimator;
    });
    const auto all = spread();
    for (const KernelId kernel : {KernelId::eye, KernelId::photon, KernelId::gather, KernelId::path}) {
        for (std::size_t i = std::size_t(kernel) % 2; i < all.size(); i += 2) {
            EXPECT_EQ(faults(folded(words_of_kernel(kernel), all[i])), "") << row_of(kernel).name << ", " << i;
        }
    }
}

TEST(FoldedModules, DropsWhatAFeatureIsFor) {
    const Words before = words_of_kernel(KernelId::eye);
    const auto fetches = [](const Words& words) {
        return std::ranges::count(instructions_of(words), spv::OpImageFetch, opcode);
    };
    const auto words_with = [&](std::uint32_t features) { return folded(before, constants_of(features)); };
    EXPECT_LT(words_with(0).size() * 5, before.size());
    EXPECT_GT(words_with(~0u).size() * 10, before.size() * 8);
    EXPECT_LT(fetches(words_with(0)), fetches(words_with(FEATURE_TEXTURES)));
    EXPECT_LT(fetches(words_with(FEATURE_TEXTURES)), fetches(before));
}

TEST(FoldedModules, KeepsTheSizeOfWorkGroups) {
    const Words after = folded(words_of_kernel(KernelId::eye), constants_of(0));
    std::uint32_t size = 0, first = 0;
    for (const Instruction words : instructions_of(after)) {
        if (opcode(words) == spv::OpDecorate && words[2] == spv::DecorationBuiltIn &&
            words[3] == spv::BuiltInWorkgroupSize) {
            size = words[1];
        }
        if (opcode(words) == spv::OpConstantComposite && words[2] == size) first = words[3];
    }
    ASSERT_NE(first, 0u);
    EXPECT_TRUE(has(after, [&](Instruction words) {
        return opcode(words) == spv::OpConstant && words[2] == first && words[3] == 64;
    }));
}

TEST(FoldedModules, LeavesAModuleWithAnUnknownInstructionAsItIs) {
    Words words = words_of_kernel(KernelId::eye);
    words.push_back(first_word(spv::OpNop, 1));
    EXPECT_EQ(folded(words, constants_of(0)), words);
}

}  // namespace
}  // namespace vkcppm::test
