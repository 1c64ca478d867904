// Kernels that read texels as storage: valid by spirv-val, without a texel left, each buffer at one binding. And what
// any kernel needs of a device is what the policy says. That they compute the same: cli/faults_test.cpp and
// kernels.few_texels.

#include "vk/texels.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "unit/modules.h"
#include "vk/binding.h"
#include "vk/fold.h"
#include "vk/policy.h"
#include "vk/spirv.h"

namespace vkcppm::test {
namespace {

bool is_texels(std::uint32_t binding) { return binding >= TEXELS_BINDING; }

std::uint32_t texels_in(const Words& bindings) { return std::uint32_t(std::ranges::count_if(bindings, is_texels)); }

std::uint32_t uniforms_in(const Words& bindings) {
    return std::uint32_t(std::ranges::count_if(bindings, [](std::uint32_t binding) {
        return !is_texels(binding) && bound_buffer(Binding(binding)).access == Access::uniform;
    }));
}

TEST(TexelsAsStorage, TheNeedsOfKernelsAreThoseOfThePolicy) {
    KernelNeeds most{.uniform = 0, .storage = 0, .texels = 0, .as_storage = 0};
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        const Words words = words_of_kernel(row.id, estimator);
        const Words bindings = bindings_of(words), changed = bindings_of(with_storage_for_texels(words));
        most.uniform = std::max(most.uniform, uniforms_in(bindings));
        most.texels = std::max(most.texels, texels_in(bindings));
        most.storage =
            std::max(most.storage, std::uint32_t(bindings.size()) - texels_in(bindings) - uniforms_in(bindings));
        most.as_storage = std::max(most.as_storage, std::uint32_t(changed.size()) - uniforms_in(changed));
    });
    EXPECT_EQ(most.uniform, kernel_needs.uniform);
    EXPECT_EQ(most.storage, kernel_needs.storage);
    EXPECT_EQ(most.texels, kernel_needs.texels);
    EXPECT_EQ(most.as_storage, kernel_needs.as_storage);
}

// Whole, and folded to the constants that glslc has.
TEST(TexelsAsStorage, LeavesValidModulesWithoutTexels) {
    for_each_module([&](const KernelRow& row, std::string_view estimator) {
        const Words whole = words_of_kernel(row.id, estimator);
        for (const Words& before : {whole, folded(whole, {})}) {
            SCOPED_TRACE(std::string(row.name) + " of " + std::string(estimator));
            const Words after = with_storage_for_texels(before);
            EXPECT_EQ(texels_in(bindings_of(after)), 0u);
            EXPECT_EQ(std::ranges::count(instructions_of(after), spv::OpImageFetch, opcode), 0);
            EXPECT_EQ(after == before, texels_in(bindings_of(before)) == 0);
            EXPECT_EQ(with_storage_for_texels(after), after);
            EXPECT_EQ(faults(after), "");
        }
    });
}

}  // namespace
}  // namespace vkcppm::test
