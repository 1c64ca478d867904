#include "flat/alias_table.h"

namespace vkcppm {

AliasTable::AliasTable(const std::vector<double>& weights) {
    for (const double weight : weights) total += weight;
    std::vector<double> share;
    std::vector<std::uint32_t> small, large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        share.push_back(weights[i] / total * double(weights.size()));
        keep.push_back(1.0f);
        alias.push_back(i);
        (share[i] < 1.0 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        keep[poor] = float(share[poor]);
        alias[poor] = rich;
        share[rich] -= 1.0 - share[poor];
        if (share[rich] < 1.0) {
            large.pop_back();
            small.push_back(rich);
        }
    }
}

}  // namespace vkcppm
