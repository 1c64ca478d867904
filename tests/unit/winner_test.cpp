#include "study/winner.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

TEST(Winner, HasTheLeastErrorAlone) {
    const std::vector<std::vector<double>> errors = {
        {1.0, 2.0, 3.0, 0.0, 1.0, NAN, 2.0, INFINITY},
        {2.0, 1.0, 2.0, 0.0, 1.0, 1.0, 2.0, INFINITY},
        {3.0, 3.0, 1.0, 1.0, 0.5, 2.0, NAN, 3.0},
    };
    const std::vector<int> result = winners(errors);
    EXPECT_EQ(result, (std::vector<int>{0, 1, 2, no_winner, 2, no_winner, no_winner, 2}));
    EXPECT_EQ(winner_shares(result, 3), (std::vector<double>{0.125, 0.125, 0.375}));
}

TEST(Winner, NeighbourhoodMeanIsThatOfTheWindow) {
    const Extent extent{5, 4};
    std::vector<double> values;
    for (std::size_t i = 0; i < extent.pixels(); ++i) values.push_back(double(i * i % 7));
    const std::vector<double> means = neighbourhood_mean(extent, values, 1);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            double sum = 0.0;
            int count = 0;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, 3); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, 4); ++u) {
                    sum += values[std::size_t(5 * v + u)];
                    ++count;
                }
            }
            EXPECT_NEAR(means[std::size_t(5 * y + x)], sum / count, 1e-14) << "column " << x << ", row " << y;
        }
    }
    EXPECT_EQ(neighbourhood_mean(extent, values, 0), values);
}

}  // namespace
}  // namespace vkcppm
