#include "support/statistics/statistics.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkcppm::test {

double sidak(double family, std::size_t tests) { return -std::expm1(std::log1p(-family) / double(tests)); }

ChiSquared chi_squared(std::span<const std::uint64_t> observed, std::span<const double> probabilities) {
    EXPECT_EQ(observed.size(), probabilities.size());
    EXPECT_NEAR(std::accumulate(probabilities.begin(), probabilities.end(), 0.0), 1.0, 1e-6) << "bins do not cover";
    const double total = double(std::accumulate(observed.begin(), observed.end(), std::uint64_t(0)));
    ChiSquared result;
    double largest = -1.0, pooled_observed = 0.0, pooled_expected = 0.0;
    std::size_t bins = 0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        pooled_observed += double(observed[i]);
        pooled_expected += total * probabilities[i];
        const bool last = i + 1 == observed.size();
        if (pooled_expected < 5.0 && !last) continue;
        if (pooled_expected > 0.0 || pooled_observed > 0.0) {
            const double term = std::pow(pooled_observed - pooled_expected, 2) / std::max(pooled_expected, 1e-9);
            result.statistic += term;
            ++bins;
            if (term > largest) {
                largest = term;
                result.worst = fmt::format("bin {}: {} observed, {:.1f} expected", i, pooled_observed, pooled_expected);
            }
        }
        pooled_observed = pooled_expected = 0.0;
    }
    result.freedom = double(bins) - 1.0;
    result.p_value = cdf(complement(boost::math::chi_squared(result.freedom), result.statistic));
    return result;
}

ChiSquared chi_squared_uniform(std::span<const std::uint64_t> observed) {
    return chi_squared(observed, std::vector<double>(observed.size(), 1.0 / double(observed.size())));
}

void expect_density(const std::string& what, const ChiSquared& test, double level) {
    EXPECT_GE(test.p_value, level) << what << ": chi-squared " << test.statistic << " with " << test.freedom
                                   << " degrees of freedom; " << test.worst;
}

}  // namespace vkcppm::test
