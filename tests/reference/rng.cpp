#include "reference/rng.h"

namespace vkcppm::reference {

std::array<std::uint32_t, 4> pcg4d(std::array<std::uint32_t, 4> v) {
    auto& [x, y, z, w] = v;
    const auto mix = [&] {
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
    };
    for (std::uint32_t& word : v) word = word * 1664525u + 1013904223u;  // Numerical Recipes' generator
    mix();
    for (std::uint32_t& word : v) word ^= word >> 16;
    mix();
    return v;
}

}  // namespace vkcppm::reference
