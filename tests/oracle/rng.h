#pragma once
// The counter-based random numbers on the host, from the definition in the paper.

#include <array>
#include <cstdint>

namespace vkcppm::oracle {

/// PCG4D, listing 5 of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
std::array<std::uint32_t, 4> pcg4d(std::array<std::uint32_t, 4> v);

}  // namespace vkcppm::oracle
