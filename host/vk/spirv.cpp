#include "vk/spirv.h"

#include <algorithm>
#include <utility>

namespace vkcppm {
namespace {

/// Code::literals; none: nothing is known of it.
std::optional<std::uint32_t> literals_of(spv::Op op) {
    using namespace spv;
    struct Row {
        std::uint32_t literals;
        std::vector<Op> ops;
    };
    // clang-format off
    static const std::vector<Row> rows = {
        {~0u, {OpCapability, OpExtension, OpExtInstImport, OpMemoryModel, OpTypeInt, OpTypeFloat, OpConstant,
               OpSpecConstant}},
        {~1u, {OpExecutionMode, OpName, OpMemberName, OpDecorate, OpMemberDecorate, OpTypeVector, OpTypeMatrix,
               OpTypeImage, OpLoad, OpCompositeExtract, OpArrayLength, OpSelectionMerge}},
        {~3u, {OpStore, OpVectorShuffle, OpCompositeInsert, OpLoopMerge}},
        {~7u, {OpBranchConditional}},
        {0x55555554u, {OpSwitch}},  // selector, default, and a literal and a label for each case
        // Of an entry point: model, function, and a name before further ids; of an operation on constants: its opcode
        // and operands. code_of() adds to both.
        {1u, {OpEntryPoint, OpTypePointer, OpVariable, OpFunction, OpSpecConstantOp}},
        {2u, {OpExtInst, OpExecutionModeId, OpGroupNonUniformBallotBitCount}},
        {4u, {OpImageFetch}},
        {0u, {OpUndef, OpTypeVoid, OpTypeBool, OpTypeSampledImage, OpTypeArray, OpTypeRuntimeArray, OpTypeStruct,
              OpTypeFunction, OpConstantTrue, OpConstantFalse, OpConstantComposite, OpConstantNull,
              OpSpecConstantComposite, OpFunctionParameter, OpFunctionCall, OpFunctionEnd, OpAccessChain,
              OpVectorExtractDynamic, OpCompositeConstruct, OpCopyObject, OpCopyLogical, OpTranspose, OpImage, OpAny,
              OpAll, OpIsNan, OpIsInf, OpSelect, OpControlBarrier, OpMemoryBarrier, OpGroupNonUniformElect,
              OpGroupNonUniformAll, OpGroupNonUniformAny, OpGroupNonUniformBallot, OpBitcast, OpPhi, OpLabel,
              OpBranch, OpReturn, OpReturnValue, OpUnreachable}},
    };
    // clang-format on
    constexpr std::pair<Op, Op> of_ids[] = {{OpConvertFToU, OpFConvert},
                                            {OpSNegate, OpSMulExtended},
                                            {OpLogicalEqual, OpFUnordGreaterThanEqual},
                                            {OpShiftRightLogical, OpBitCount},
                                            {OpAtomicLoad, OpAtomicXor}};
    static const std::vector<std::optional<std::uint32_t>> known = [&] {
        std::vector<std::optional<std::uint32_t>> all(512);
        for (const auto& [first, last] : of_ids) std::fill(all.begin() + first, all.begin() + last + 1, 0u);
        for (const Row& row : rows) {
            for (const Op each : row.ops) all[each] = row.literals;
        }
        return all;
    }();
    return op < known.size() ? known[op] : std::nullopt;
}

}  // namespace

std::optional<std::vector<Code>> code_of(std::span<const std::uint32_t> spirv) {
    std::vector<Code> all;
    all.reserve(spirv.size() / 3);
    for (const Instruction words : instructions_of(spirv)) {
        Code code{words, opcode(words)};
        const auto literals = literals_of(code.op);
        const auto of_operation = code.op == spv::OpSpecConstantOp ? literals_of(spv::Op(words[3])) : 0u;
        if (!literals || !of_operation) return std::nullopt;
        code.literals = *literals | *of_operation << 1;
        for (std::size_t i = 3; code.op == spv::OpEntryPoint; ++i) {  // to the zero that ends the name
            if (i > 24 || i == words.size()) return std::nullopt;
            code.literals |= 1u << (i - 1);
            if (words[i] >> 24 == 0) break;
        }
        spv::HasResultAndType(code.op, &code.named, &code.typed);
        if (code.op == spv::OpTypeInt && words[2] != 32) return std::nullopt;  // one of two words a case of a switch
        // Scopes behind the flags of an access are ids, of which kernels have none.
        const std::size_t flags = code.op == spv::OpLoad ? 4 : code.op == spv::OpStore ? 3 : words.size();
        constexpr std::uint32_t plain = std::uint32_t(spv::MemoryAccessVolatileMask) | spv::MemoryAccessAlignedMask;
        if (flags < words.size() && (words[flags] & ~plain) != 0) return std::nullopt;
        all.push_back(code);
    }
    return all;
}

void number_ids(std::vector<std::uint32_t>& spirv, const std::vector<Code>& code) {
    std::vector<std::uint32_t> numbers(spirv[spirv_bound]);
    std::uint32_t count = 1;
    for (const Code& each : code) {
        for (std::size_t i = 1; i < each.words.size(); ++i) {
            if (!each.is_id(i) && !(each.named && i + 1 == each.first())) continue;
            std::uint32_t& word = spirv[std::size_t(&each.words[i] - spirv.data())];
            std::uint32_t& number = numbers[word];
            if (number == 0) number = count++;
            word = number;
        }
    }
    spirv[spirv_bound] = count;
}

}  // namespace vkcppm
