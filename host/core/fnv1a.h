#pragma once
// A hash that tells files apart; no defence against those who forge them.

#include <cstdint>
#include <span>

namespace vkcppm {

inline constexpr std::uint64_t fnv1a_start = 0xcbf29ce484222325u;

/// FNV-1a, 64 bits, continued from `hash` (Fowler, Noll, Vo; draft-eastlake-fnv).
inline std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t hash = fnv1a_start) {
    for (const std::uint8_t byte : bytes) {
        hash = (hash ^ byte) * 0x100000001b3u;
    }
    return hash;
}

}  // namespace vkcppm
