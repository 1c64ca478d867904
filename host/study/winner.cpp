#include "study/winner.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vkcppm {
namespace {

/// Mean of the `count` values that are `stride` apart, at most `reach` of them away, into `means`.
void mean_along(const double* values, double* means, int count, std::size_t stride, int reach) {
    for (int i = 0; i < count; ++i) {
        const int first = std::max(i - reach, 0), last = std::min(i + reach, count - 1);
        double sum = 0.0;
        for (int k = first; k <= last; ++k) sum += values[std::size_t(k) * stride];
        means[std::size_t(i) * stride] = sum / (last - first + 1);
    }
}

}  // namespace

std::vector<int> winners(std::span<const std::vector<double>> errors) {
    std::vector<int> winners(errors.front().size(), no_winner);
    for (std::size_t i = 0; i < winners.size(); ++i) {
        double least = INFINITY;
        for (std::size_t e = 0; e < errors.size(); ++e) {
            const double error = errors[e][i];
            if (std::isnan(error) || error == least) winners[i] = no_winner;
            if (std::isnan(error)) break;
            if (error < least) {
                least = error;
                winners[i] = int(e);
            }
        }
    }
    return winners;
}

std::vector<double> winner_shares(std::span<const int> winners, std::size_t entrants) {
    std::vector<double> shares(entrants, 0.0);
    for (const int winner : winners) {
        if (winner != no_winner) shares.at(std::size_t(winner)) += 1.0;
    }
    for (double& share : shares) share /= double(winners.size());
    return shares;
}

std::vector<double> neighbourhood_mean(Extent extent, std::span<const double> values, int reach) {
    assert(values.size() == extent.pixels());
    std::vector<double> rows(values.size()), means(values.size());
    for (std::size_t y = 0; y < extent.height; ++y) {
        mean_along(&values[y * extent.width], &rows[y * extent.width], int(extent.width), 1, reach);
    }
    for (std::size_t x = 0; x < extent.width; ++x) {
        mean_along(&rows[x], &means[x], int(extent.height), extent.width, reach);
    }
    return means;
}

}  // namespace vkcppm
