// Loops that hand on what they compute by phis: valid by spirv-val, and nothing leaves a loop another way. That they
// compute the same: kernels.few_texels.

#include "vk/loops.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "unit/modules.h"
#include "vk/fold.h"
#include "vk/spirv.h"

namespace vkcppm::test {
namespace {

TEST(ClosedLoops, LeaveValidModules) {
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        const Words whole = words_of_kernel(row.id, estimator);
        for (const Words& before : {whole, folded(whole, {})}) {
            SCOPED_TRACE(std::string(row.name) + " of " + std::string(estimator));
            const Words after = with_loops_closed(before);
            const auto loops = [](const Words& words) {
                return std::ranges::count(instructions_of(words), spv::OpLoopMerge, opcode);
            };
            EXPECT_EQ(loops(after), loops(before));
            EXPECT_EQ(after == before, loops(before) == 0);
            EXPECT_EQ(faults(after), "");
        }
    });
}

}  // namespace
}  // namespace vkcppm::test
