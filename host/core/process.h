#pragma once
// What this process has used so far.

#include <cstdint>

namespace vkcppm {

/// s on a clock that never goes back, from an arbitrary start.
double wall_now();

/// s of user and system time of all threads.
double cpu_now();

/// Largest resident set so far, bytes.
std::uint64_t peak_memory();

}  // namespace vkcppm
