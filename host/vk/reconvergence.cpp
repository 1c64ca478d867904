#include "vk/reconvergence.h"

#include <algorithm>
#include <cstring>

#include "vk/spirv.h"

namespace vkcppm {

std::vector<std::uint32_t> with_promise(std::span<const std::uint32_t> spirv, Reconvergence promise) {
    // Capabilities come first, then extensions, then the rest, in which execution modes follow the entry point.
    std::vector<std::uint32_t> words(spirv.begin(), spirv.end());
    const auto* asked = std::ranges::find(promises, promise, &Promise::of);
    if (asked == std::end(promises)) return words;

    std::size_t capabilities_end = spirv_header, entry_end = 0;
    std::uint32_t entry = 0;
    bool ballots = false;
    for (const Instruction instruction : instructions_of(spirv)) {
        const auto end = std::size_t(instruction.data() + instruction.size() - spirv.data());
        if (opcode(instruction) == spv::OpCapability) {
            capabilities_end = end;
            ballots = ballots || instruction[1] == spv::CapabilityGroupNonUniformBallot;
        }
        if (opcode(instruction) == spv::OpEntryPoint) {
            entry = instruction[2];
            entry_end = end;
        }
    }
    if (!ballots || entry_end == 0) return words;

    const std::uint32_t mode[] = {first_word(spv::OpExecutionMode, 3), entry, asked->mode};
    words.insert(words.begin() + std::ptrdiff_t(entry_end), std::begin(mode), std::end(mode));
    // The text and the zero behind it, in whole words.
    std::vector<std::uint32_t> extension(1 + std::strlen(asked->spirv_extension) / 4 + 1);
    extension[0] = first_word(spv::OpExtension, extension.size());
    std::memcpy(&extension[1], asked->spirv_extension, std::strlen(asked->spirv_extension));
    words.insert(words.begin() + std::ptrdiff_t(capabilities_end), extension.begin(), extension.end());
    return words;
}

}  // namespace vkcppm
