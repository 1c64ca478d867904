// What is added to a module that asks for a promise of convergence, by a reader of modules of its own; spirv-val agrees
// (by hand: it knows the second of the two extensions alone).

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/kernels.h"
#include "vk/reconvergence.h"

namespace vkcppm {
namespace {

using Module = std::vector<std::uint32_t>;

/// An instruction: its code and its operands.
struct Instruction {
    std::uint32_t code;
    Module operands;
    bool operator==(const Instruction&) const = default;
};

std::vector<Instruction> instructions_of(const Module& words) {
    std::vector<Instruction> all;
    std::size_t at = 5;
    while (at < words.size()) {
        const std::size_t length = words[at] >> 16;
        if (length == 0 || at + length > words.size()) break;
        all.push_back({words[at] & 0xffff,
                       Module(words.begin() + std::ptrdiff_t(at + 1), words.begin() + std::ptrdiff_t(at + length))});
        at += length;
    }
    EXPECT_EQ(at, words.size()) << "the module does not end with an instruction";
    return all;
}

Module module_of(KernelId kernel) {
    const auto words = words_of(kernel, "cppm");
    return {words.begin(), words.end()};
}

constexpr std::uint32_t extension = 10, entry_point = 15, execution_mode = 16, capability = 17;

TEST(Convergence, IsAskedForByKernelsWithBallots) {
    const Module before = module_of(KernelId::photon);
    EXPECT_EQ(with_promise(before, Reconvergence::none), before);
    for (const Promise& promise : promises) {
        SCOPED_TRACE(promise.extension);
        const std::vector<Instruction> old = instructions_of(before);
        std::vector<Instruction> now = instructions_of(with_promise(before, promise.of));
        ASSERT_EQ(now.size(), old.size() + 2);
        std::size_t at = 0;
        while (now[at].code == capability) ++at;
        ASSERT_EQ(now[at].code, extension) << "behind the last capability";
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(now[at].operands.data())), promise.spirv_extension);
        now.erase(now.begin() + std::ptrdiff_t(at));
        while (now[at].code != entry_point) ++at;
        EXPECT_EQ(now[at + 1], (Instruction{execution_mode, {now[at].operands[1], promise.mode}}));
        now.erase(now.begin() + std::ptrdiff_t(at + 1));
        EXPECT_EQ(now, old) << "all else is as it was";
    }
}

TEST(Convergence, IsNothingToKernelsWithoutBallots) {
    const Module before = module_of(KernelId::update);
    EXPECT_EQ(with_promise(before, Reconvergence::maximal), before);
}

}  // namespace
}  // namespace vkcppm
