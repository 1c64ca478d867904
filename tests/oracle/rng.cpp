#include "oracle/rng.h"

namespace vkcppm::oracle {

std::array<std::uint32_t, 4> pcg4d(std::array<std::uint32_t, 4> v) {
    const auto mix = [&x = v[0], &y = v[1], &z = v[2], &w = v[3]] {
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

}  // namespace vkcppm::oracle
