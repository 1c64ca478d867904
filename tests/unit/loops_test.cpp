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
            EXPECT_EQ(faults(after), "");
        }
    });
}

}  // namespace
}  // namespace vkcppm::test
