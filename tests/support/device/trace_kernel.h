#pragma once
// The kernel trace.comp, by which tests trace rays of their own.

#include <cstdint>

namespace vkcppm::test {

inline constexpr std::uint32_t trace_words[] = {
#include "trace.spv.inc"
};

inline constexpr std::uint32_t found_miss = 0, found_hit = 1,
                               found_unfinished = 2;  // TRACE_* of shaders/include/traverse.glsl
inline constexpr std::uint32_t step_budget = 7000;    // below the loop limit of every driver, for eight lanes

}  // namespace vkcppm::test
