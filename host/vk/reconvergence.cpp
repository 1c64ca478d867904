#include "vk/reconvergence.h"

#include <algorithm>
#include <cstring>

namespace vkcppm {

std::vector<std::uint32_t> with_promise(std::span<const std::uint32_t> spirv, Reconvergence promise) {
    // A module is a header and instructions, whose first word holds their length and their code: capabilities,
    // extensions, then the rest, in which execution modes follow the entry point.
    constexpr std::size_t header = 5;
    constexpr std::uint32_t op_extension = 10, op_entry_point = 15, op_execution_mode = 16, op_capability = 17;
    constexpr std::uint32_t capability_ballot = 64;
    std::vector<std::uint32_t> words(spirv.begin(), spirv.end());
    const auto* asked = std::ranges::find(promises, promise, &Promise::of);
    if (asked == std::end(promises)) return words;

    std::size_t capabilities_end = header, entry_end = 0;
    std::uint32_t entry = 0;
    bool ballots = false;
    for (std::size_t at = header; at < words.size(); at += std::max(1u, words[at] >> 16)) {
        const std::uint32_t code = words[at] & 0xffff, length = words[at] >> 16;
        if (code == op_capability) {
            capabilities_end = at + length;
            ballots = ballots || words[at + 1] == capability_ballot;
        }
        if (code == op_entry_point) {
            entry = words[at + 2];
            entry_end = at + length;
        }
    }
    if (!ballots || entry_end == 0) return words;

    const std::uint32_t mode[] = {3u << 16 | op_execution_mode, entry, asked->mode};
    words.insert(words.begin() + std::ptrdiff_t(entry_end), std::begin(mode), std::end(mode));
    // The text and the zero behind it, in whole words.
    std::vector<std::uint32_t> extension(1 + std::strlen(asked->spirv_extension) / 4 + 1);
    extension[0] = std::uint32_t(extension.size()) << 16 | op_extension;
    std::memcpy(&extension[1], asked->spirv_extension, std::strlen(asked->spirv_extension));
    words.insert(words.begin() + std::ptrdiff_t(capabilities_end), extension.begin(), extension.end());
    return words;
}

}  // namespace vkcppm
