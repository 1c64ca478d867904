#pragma once
// SPIR-V as its instructions.

#include <cstdint>
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

}  // namespace vkcppm
