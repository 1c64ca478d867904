// Loops that hand on what they compute by phis: modules stay valid by spirv-val, with as many loops. That they compute
// the same: kernels.few_texels.

#include "vk/loops.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "shared/types.h"
#include "unit/modules.h"
#include "vk/fold.h"
#include "vk/spirv.h"
#include "vk/texels.h"

namespace vkcppm::test {
namespace {

std::ptrdiff_t loops_of(const Words& words) {
    return std::ranges::count(instructions_of(words), spv::OpLoopMerge, opcode);
}

/// It has the number of the invocation, from which is made what is never true.
bool numbers_invocations(const Words& words) {
    return std::ranges::any_of(instructions_of(words), [](Instruction each) {
        return opcode(each) == spv::OpDecorate && each[2] == spv::DecorationBuiltIn &&
               each[3] == spv::BuiltInLocalInvocationIndex;
    });
}

// Whole, and folded as glslc has its constants, to those of plain glass, and of an open scene with textures.
TEST(ClosedLoops, LeaveValidModules) {
    const Specialization none;
    const Specialization glass{{SPEC_FEATURES, FEATURE_AREA_LIGHTS | FEATURE_TRANSMISSION | FEATURE_DIRECT}};
    const Specialization open{
        {SPEC_FEATURES, FEATURE_REFLECTION | FEATURE_TEXTURES | FEATURE_NORMAL_MAPS | FEATURE_ROUGH | FEATURE_GLOSS |
                            FEATURE_ENVIRONMENT | FEATURE_DIRECTIONAL_LIGHTS | FEATURE_DIRECT},
        {SPEC_LEVELS, 3}};
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        const Words whole = words_of_kernel(row.id, estimator);
        for (const Words& words : {whole, folded(whole, none), folded(whole, glass), folded(whole, open)}) {
            SCOPED_TRACE(std::string(row.name) + " of " + std::string(estimator));
            const Words before = with_storage_for_texels(words), after = with_loops_closed(before);
            EXPECT_EQ(loops_of(after), loops_of(before));
            EXPECT_EQ(after == before, loops_of(before) == 0);
            EXPECT_TRUE(loops_of(before) == 0 || numbers_invocations(before));
            EXPECT_EQ(faults(after), "");
        }
    });
}

}  // namespace
}  // namespace vkcppm::test
