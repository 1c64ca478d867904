#pragma once
// What this process has used so far.

#include <cstdint>

namespace vkcppm {

/// s on a clock that never goes back, from an arbitrary start.
double wall_now();

/// s of user and system time of all threads.
double cpu_now();

/// Of the machine, bytes.
std::uint64_t total_memory();

/// What the system has left for this process without giving up anything else, bytes: all there is, where it does not
/// say.
std::uint64_t available_memory();

/// Largest resident set so far, bytes.
std::uint64_t peak_memory();

}  // namespace vkcppm
