// How often each test rejects a field that its null hypothesis covers: in one look, and in repeated looks.

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>

#include "support/device/gpu.h"
#include "support/device/synthetic_field.h"

namespace vkcppm::test {
namespace {

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

// Photon counts beside sizes from simulation, in percent: few photons make chi-squared discrete, and the size at M = 10
// is as far below the nominal 5 % as at M = 12 above.
TEST(Size, ChiSquaredHasItsExactSizeInOneLook) {
    constexpr std::uint32_t side = 96;
    using Row = std::pair<std::uint32_t, double>;
    const std::vector<Row> twelve = {{10, 3.5}, {12, 5.5}, {20, 4.0}, {30, 4.3}, {60, 4.7}};
    const std::vector<Row> six = {{5, 2.0}, {10, 4.0}, {30, 4.9}};
    for (const std::string estimator : {"cppm", "cppm-gof", "cppm-fold"}) {
        const bool folded = estimator == "cppm-fold";
        SyntheticField field(plain_device(), settings_of(estimator), find_field("uniform"), side, 60.0, 1);
        for (const auto& [count, simulated] : folded ? six : twelve) {
            const double exact = exact_size(folded ? 6 : 12, count);
            EXPECT_NEAR(100.0 * exact, simulated, 0.1) << estimator << ", M = " << count;
            field.reset(1.0);
            field.run_exact(count);
            EXPECT_NEAR(field.rejected(), exact, 4.0 * binomial_error(exact, side * side))
                << estimator << ", M = " << count;
        }
    }
}

/// The band in which the size of every test lies once there are some photons, with four standard errors at its ends.
void expect_size(double rejected, double pixels, const std::string& what) {
    EXPECT_GT(rejected, 0.035 - 4.0 * binomial_error(0.035, pixels)) << what;
    EXPECT_LT(rejected, 0.055 + 4.0 * binomial_error(0.055, pixels)) << what;
}

TEST(Size, TheLinearTestHasItsSizeInOneLook) {
    constexpr std::uint32_t side = 96;
    SyntheticField field(plain_device(), settings_of("cppm-lf"), find_field("uniform"), side, 60.0, 2);
    for (const std::uint32_t count : {10u, 12u, 20u, 30u, 60u}) {
        field.reset(1.0);
        field.run_exact(count);
        expect_size(field.rejected(), side * side, "M = " + std::to_string(count));
    }
}

TEST(Size, FTestsHaveTheirSizeInOneLook) {
    constexpr std::uint32_t side = 96;
    for (const std::string estimator : {"ftest", "ftest-fold"}) {
        SyntheticField field(plain_device(), settings_of(estimator), find_field("uniform"), side, 10.0, 3);
        for (const std::uint32_t samples : {3u, 5u, 10u, 30u}) {
            field.reset(1.0);
            field.look_once_after(samples);
            expect_size(field.rejected(), side * side, estimator + ", " + std::to_string(samples) + " samples");
        }
        field.reset(1.0);
        field.look_once_after(2);
        EXPECT_EQ(field.rejected(), 0.0) << "two samples say nothing";
    }
}

// beta = 1.2, ten photons an iteration: 18, 39 and 55 % of uniform pixels reject at least once.
TEST(Size, RepeatedLooksRejectAUniformFieldAsOftenAsSimulated) {
    constexpr std::uint32_t side = 48;
    SyntheticField field(plain_device(), settings_of("cppm"), find_field("uniform"), side, 10.0, 4);
    std::uint32_t done = 0;
    for (const auto& [iterations, share] : {std::pair{10u, 0.18}, {100u, 0.39}, {1000u, 0.55}}) {
        field.run(iterations - done);
        done = iterations;
        EXPECT_NEAR(field.rejected(), share, 0.015 + binomial_error(share, side * side)) << iterations << " iterations";
    }
}

}  // namespace
}  // namespace vkcppm::test
