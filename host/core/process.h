#pragma once
// What this process has used so far, and what the machine that it runs on has.

#include <cstdint>
#include <string>

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

/// The processor by its own name, its threads, and whether it has FMA and AVX2, by which software Vulkan chooses its
/// code and with that the last bits of a picture. "unknown" where the system does not say.
std::string processor();

/// Largest resident set so far, bytes.
std::uint64_t peak_memory();

}  // namespace vkcppm
