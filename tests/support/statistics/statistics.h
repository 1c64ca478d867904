#pragma once
// Tests of hypotheses for the tests: fixed seeds, a stated level, one number to explain a failure.

#include <cstdint>
#include <span>
#include <string>

namespace vkcppm::test {

/// Level of each of `tests` tests so that any of them fails by chance with probability `family` (Sidak 1967).
double sidak(double family, std::size_t tests);

/// Pearson's test that `observed` counts follow `probabilities` (sum 1 within 1e-6). Bins with fewer than 5 expected
/// counts are pooled with their neighbours.
struct ChiSquared {
    double statistic = 0.0;
    double freedom = 0.0;  // degrees of freedom
    double p_value = 1.0;  // of a larger statistic
    std::string worst;     // the bin that adds most: its index, observed and expected counts
};
ChiSquared chi_squared(std::span<const std::uint64_t> observed, std::span<const double> probabilities);

/// The same against equal probabilities.
ChiSquared chi_squared_uniform(std::span<const std::uint64_t> observed);

/// Fails the running test where p < level, with the numbers.
void expect_density(const std::string& what, const ChiSquared& test, double level);

}  // namespace vkcppm::test
