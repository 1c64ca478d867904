// How often each test rejects a field that its null hypothesis covers: one look, and repeated looks.

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>

#include "support/gpu.h"
#include "support/synthetic_field.h"

namespace vkcppm::test {
namespace {

class Size : public GpuTest {};

Settings settings_of(const std::string& estimator) {
    Settings settings;
    settings.estimator = estimator;
    return settings;
}

/// Standard error of a share of `trials`.
double binomial_error(double share, double trials) { return std::sqrt(share * (1.0 - share) / trials); }

/// Probability that Pearson's statistic of `count` photons in `cells` equally likely cells reaches its 95 % quantile:
/// a sum over the partitions of `count` into at most `cells` parts, each as often as it can be labelled.
double exact_size(std::uint32_t cells, std::uint32_t count) {
    const double critical = quantile(complement(boost::math::chi_squared(cells - 1.0), 0.05));
    const auto log_factorial = [](double n) { return std::lgamma(n + 1.0); };
    const double all = log_factorial(count) + log_factorial(cells) - count * std::log(double(cells));
    double size = 0.0;
    // Parts of at most `largest` for the cells and photons left; `squares` and `logarithm` of those taken so far.
    const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t, double, double)> add =
        [&](std::uint32_t largest, std::uint32_t cells_left, std::uint32_t left, double squares, double logarithm) {
            if (left == 0) {
                const double statistic = squares * cells / count - count;
                if (statistic >= critical) size += std::exp(all + logarithm - log_factorial(cells_left));
                return;
            }
            for (std::uint32_t part = std::min(largest, left); part > 0; --part) {
                for (std::uint32_t times = 1; times <= cells_left && times * part <= left; ++times) {
                    add(part - 1, cells_left - times, left - times * part, squares + double(times) * part * part,
                        logarithm - times * log_factorial(part) - log_factorial(times));
                }
            }
        };
    add(count, cells, count, 0.0, 0.0);
    return size;
}

// Photon counts beside the sizes that simulation gave, in percent (algorithm sheet: 12 cells 3.5, 5.5, 4.0, 4.3, 4.7;
// 6 cells 2.0, 4.0, 4.9): discreteness takes M = 10 below and M = 12 above the nominal 5 %.
TEST_F(Size, ChiSquaredHasItsExactSizeInOneLook) {
    constexpr std::uint32_t side = 128;
    const std::vector<std::pair<std::uint32_t, double>> twelve = {{10, 3.5}, {12, 5.5}, {20, 4.0}, {30, 4.3}, {60, 4.7}};
    const std::vector<std::pair<std::uint32_t, double>> six = {{5, 2.0}, {10, 4.0}, {30, 4.9}};
    for (const std::string estimator : {"cppm", "cppm-gof", "cppm-fold"}) {
        const bool folded = estimator == "cppm-fold";
        SyntheticField field(device(), settings_of(estimator), find_field("uniform"), side, 60.0, 1);
        for (const auto& [count, simulated] : folded ? six : twelve) {
            const double exact = exact_size(folded ? 6 : 12, count);
            EXPECT_NEAR(100.0 * exact, simulated, 0.3) << estimator << ", M = " << count;
            field.reset(1.0);
            field.run_exact(count);
            EXPECT_NEAR(field.rejected(), exact, 4.0 * binomial_error(exact, side * side)) << estimator << ", M = " << count;
        }
    }
}

TEST_F(Size, Probe) {
    for (const std::string estimator : {"cppm-lf", "ftest", "ftest-fold"}) {
        SyntheticField field(device(), settings_of(estimator), find_field("uniform"), 128, 60.0, 2);
        if (estimator == "cppm-lf") {
            for (int count : {10, 12, 20, 30, 60}) { field.reset(1.0); field.run_exact(count); printf("%s %d %.4f\n", estimator.c_str(), count, field.rejected()); }
        }
    }
    for (const std::string estimator : {"ftest", "ftest-fold", "cppm", "cppm-lf"}) {
        SyntheticField field(device(), settings_of(estimator), find_field("uniform"), 128, 10.0, 2);
        for (int n : {1, 3, 5, 10, 30}) { field.reset(1.0); field.look_once_after(n); printf("%s its %d %.4f\n", estimator.c_str(), n, field.rejected()); }
    }
}

TEST_F(Size, RepeatedLooksRejectAUniformFieldAsOftenAsSimulated) {
    constexpr std::uint32_t side = 64;
    SyntheticField field(device(), settings_of("cppm"), find_field("uniform"), side, 10.0, 3);
    std::uint32_t done = 0;
    for (const auto& [iterations, share] : {std::pair{10u, 0.18}, {100u, 0.39}, {1000u, 0.55}}) {
        field.run(iterations - done);
        done = iterations;
        EXPECT_NEAR(field.rejected(), share, 0.015 + binomial_error(share, side * side)) << iterations << " iterations";
        printf("%u %.4f\n", iterations, field.rejected());
    }
}

}  // namespace
}  // namespace vkcppm::test
