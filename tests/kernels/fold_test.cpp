// Kernels folded to constants before the device sees them: the same bits as where the driver specialises them.

#include "vk/fold.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "support/device/gpu.h"
#include "vk/spirv.h"

namespace vkcppm::test {
namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t fold_words[] = {
#include "fold.spv.inc"
};
constexpr std::uint32_t items = 192, results = 11;  // of fold.comp
constexpr std::uint32_t node_bits = 20;

class FoldedKernels : public GpuTest {
protected:
    static Words results_of(std::span<const std::uint32_t> words, std::uint32_t stack, std::uint32_t features) {
        Probe probe("fold", words, stack, features, node_bits);
        Words input(items);
        for (std::uint32_t i = 0; i < items; ++i) input[i] = i;
        probe.input(PROBE_INPUT, input);
        probe.output<std::uint32_t>(PROBE_OUTPUT, items * results);
        probe.run(items, {.iteration = 0, .last_round = 0, .argument = 0, .items = items});
        return probe.result<std::uint32_t>(PROBE_OUTPUT, items * results);
    }
};

/// The same module with an instruction that the fold does not know and that means nothing: an extension of the source.
Words unfolded() {
    Words words(std::begin(fold_words), std::end(fold_words));
    const auto all = instructions_of(fold_words);
    const auto first = std::ranges::find(all, spv::OpDecorate, opcode);
    const std::uint32_t said[] = {first_word(spv::OpSourceExtension, 2), 'x'};
    words.insert(words.begin() + (first->data() - std::begin(fold_words)), std::begin(said), std::end(said));
    return words;
}

TEST_F(FoldedKernels, GivesTheBitsOfTheDriver) {
    for (const std::uint32_t stack : {0u, 1u, 5u}) {
        for (const std::uint32_t features : {0u, 1u, 2u, 3u}) {
            SCOPED_TRACE(fmt::format("{} turns, features {}", stack, features));
            const Specialization constants = {
                {SPEC_WORKGROUP, 64}, {SPEC_STACK, stack}, {SPEC_FEATURES, features}, {SPEC_NODE_BITS, node_bits}};
            ASSERT_EQ(folded(unfolded(), constants), unfolded());
            ASSERT_LT(folded(fold_words, constants).size(), std::size(fold_words));
            EXPECT_EQ(results_of(fold_words, stack, features), results_of(unfolded(), stack, features));
        }
    }
}

TEST_F(FoldedKernels, DropsAnArrayThatNobodyReads) {
    const auto arrays = [](std::uint32_t features) {
        return std::ranges::count_if(
            instructions_of(folded(fold_words, {{SPEC_FEATURES, features}})), [](Instruction words) {
                return opcode(words) == spv::OpVariable && words[3] == spv::StorageClassFunction;
            });
    };
    EXPECT_EQ(arrays(0), 0);
    EXPECT_EQ(arrays(1), 1);
    EXPECT_EQ(arrays(2), 1);
}

}  // namespace
}  // namespace vkcppm::test
