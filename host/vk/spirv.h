#pragma once
// SPIR-V as its instructions, and as those of kernels, of which it is known which words are ids.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp>

namespace vkcppm {

inline constexpr std::size_t spirv_header = 5;  // words before the first instruction
inline constexpr std::size_t spirv_bound = 3;   // the word of them that all ids are below

/// The words of an instruction in its module; the first has their number and the opcode.
using Instruction = std::span<const std::uint32_t>;

inline spv::Op opcode(Instruction instruction) { return spv::Op(instruction[0] & spv::OpCodeMask); }
inline std::uint32_t first_word(spv::Op op, std::size_t words) {
    return std::uint32_t(words) << spv::WordCountShift | std::uint32_t(op);
}

/// Those of a module, in its order.
inline std::vector<Instruction> instructions_of(std::span<const std::uint32_t> spirv) {
    std::vector<Instruction> all;
    all.reserve(spirv.size() / 3);
    for (std::size_t at = spirv_header; at < spirv.size(); at += all.back().size()) {
        const std::size_t length = spirv[at] >> spv::WordCountShift;
        if (length == 0 || length > spirv.size() - at) break;
        all.push_back(spirv.subspan(at, length));
    }
    return all;
}

/// An instruction of which it is known which operands are literals, all others being ids.
struct Code {
    Instruction words;
    spv::Op op = spv::OpNop;
    bool typed = false, named = false;  // has a result type, has a result
    std::uint32_t literals = 0;         // bit i: the i-th operand; from the 31st on the last two bits take turns

    std::uint32_t type() const { return typed ? words[1] : 0; }
    std::uint32_t result() const { return named ? words[1 + typed] : 0; }
    std::size_t first() const { return 1 + typed + named; }  // operand's word
    Instruction operands() const { return words.subspan(first()); }
    /// Whether a word is an id that is used.
    bool is_id(std::size_t word) const {
        if (word < first()) return typed && word == 1;
        const std::size_t i = word - first();
        return (literals >> (i < 32 ? i : 30 + i % 2) & 1) == 0;
    }
    /// Only says something of an id, its first operand.
    bool is_about() const {
        return op == spv::OpName || op == spv::OpMemberName || op == spv::OpDecorate || op == spv::OpMemberDecorate;
    }
    /// Does more than to give its result.
    bool acts() const {
        return !named || op == spv::OpLabel || op == spv::OpExtInstImport || op == spv::OpFunction ||
               op == spv::OpFunctionParameter || op == spv::OpFunctionCall ||
               (op >= spv::OpAtomicLoad && op <= spv::OpAtomicXor) ||
               (op == spv::OpLoad && words.size() > 4 && (words[4] & spv::MemoryAccessVolatileMask) != 0);
    }
};

/// None where the module holds an instruction of which nothing is known.
std::optional<std::vector<Code>> code_of(std::span<const std::uint32_t> spirv);

/// Numbers ids in the order of the words. Compilers leave gaps, and tables are as long as the largest: ours and
/// drivers'.
void number_ids(std::vector<std::uint32_t>& spirv, const std::vector<Code>& code);

}  // namespace vkcppm
