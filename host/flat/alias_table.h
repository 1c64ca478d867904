#pragma once
// How one of many is drawn by its weight in constant time.

#include <cstdint>
#include <vector>

namespace vkcppm {

/// Alias table (Walker 1974, Vose 1991): entry i is kept with probability keep[i], else alias[i] stands for it; then
/// each is drawn in proportion to its weight.
struct AliasTable {
    std::vector<float> keep;
    std::vector<std::uint32_t> alias;
    double total = 0.0;  // of the weights

    explicit AliasTable(const std::vector<double>& weights);
};

}  // namespace vkcppm
