#pragma once
// A hash that tells files apart; no defence against those who forge them.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

namespace vkcppm {

inline constexpr std::uint64_t fnv1a_start = 0xcbf29ce484222325u;

/// FNV-1a, 64 bits, continued from `hash` (Fowler, Noll, Vo; draft-eastlake-fnv).
inline std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t hash = fnv1a_start) {
    for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    return hash;
}

/// Of the bytes of values that have no padding.
template <typename T> std::uint64_t fnv1a_of(std::span<const T> values, std::uint64_t hash = fnv1a_start) {
    static_assert(std::is_trivially_copyable_v<T>);
    return fnv1a({reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()}, hash);
}

inline std::uint64_t fnv1a_of(std::string_view bytes, std::uint64_t hash = fnv1a_start) {
    return fnv1a_of(std::span<const char>(bytes), hash);
}

/// 16 hexadecimal digits.
inline std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace vkcppm
