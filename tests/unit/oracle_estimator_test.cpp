// The oracle's update rules against published figures, closed forms and simulation.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/minima.hpp>
#include <gtest/gtest.h>

#include "oracle/estimator.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;
using Tallies = std::vector<std::uint32_t>;

constexpr double alpha = 2.0 / 3.0;
const Cells twelve{2, 6};

/// Tallies of `total` photons with density proportional to the cell weights.
Tallies draw(const std::vector<double>& weights, int total, std::mt19937_64& random) {
    std::discrete_distribution<std::size_t> cell(weights.begin(), weights.end());
    Tallies tallies(weights.size(), 0);
    for (int i = 0; i < total; ++i) ++tallies[cell(random)];
    return tallies;
}

// -- radius schedules ---------------------------------------------------------------------------------------------

TEST(OracleSchedule, KnausZwickerMatchesPublishedRadii) {
    double area = 1.0;
    std::uint64_t iteration = 0;
    for (const auto& [after, expected, tolerance] : {std::tuple{1u, 0.8333, 5e-5},
                                                     {2u, 0.7407, 5e-5},
                                                     {3u, 0.6790, 5e-5},
                                                     {10u, 0.4931, 5e-5},
                                                     {100u, 0.2376, 5e-5},
                                                     {1000u, 0.11072, 5e-6}}) {
        while (iteration < after) area *= sppm_kz_area_factor(++iteration, alpha);
        EXPECT_NEAR(area, expected, tolerance) << "after " << after << " iterations";
        const double closed_form =
            std::exp(std::lgamma(after + 1 + alpha) - std::lgamma(1 + alpha) - std::lgamma(after + 2.0));
        EXPECT_NEAR(area / closed_form, 1.0, 1e-10) << "after " << after << " iterations";
    }
}

TEST(OracleSchedule, HachisukaJensenMatchesPublishedRadii) {
    double radius_squared = 1.0, count = 0.0;
    int iteration = 0;
    for (const auto& [after, expected, tolerance] : {std::tuple{1, 0.6667, 5e-5},
                                                     {2, 0.5556, 5e-5},
                                                     {3, 0.4938, 5e-5},
                                                     {10, 0.3390, 5e-5},
                                                     {100, 0.1589, 5e-5},
                                                     {1000, 0.07384, 5e-6}}) {
        for (; iteration < after; ++iteration) {
            const double found = 1000.0 * radius_squared;  // constant density
            const auto update = sppm_update(count, found, alpha);
            radius_squared *= update.area_factor;
            count = update.count;
        }
        EXPECT_NEAR(radius_squared, expected, tolerance) << "after " << after << " iterations";
    }
}

TEST(OracleSchedule, SppmLeavesAPixelWithoutPhotonsAlone) {
    const auto update = sppm_update(7.5, 0.0, alpha);
    EXPECT_EQ(update.area_factor, 1.0);
    EXPECT_EQ(update.count, 7.5);
}

TEST(OracleSchedule, SharedStatisticsEqualTheMeanOverIterations) {
    std::mt19937_64 random(1);
    std::poisson_distribution<int> photons(3.0);
    std::uniform_real_distribution<double> flux(0.0, 2.0);
    double radius_squared = 0.3, count = 0.0, tau = 0.0, sum = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const int found = i % 5 == 0 ? 0 : photons(random);
        const double phi = found * flux(random);
        sum += phi / (pi * radius_squared);
        const auto update = sppm_update(count, found, alpha);
        tau = (tau + phi) * update.area_factor;
        radius_squared *= update.area_factor;
        count = update.count;
    }
    EXPECT_NEAR(tau / (pi * radius_squared) / sum, 1.0, 1e-12);
}

// -- tests on tallies -----------------------------------------------------------------------------------------------

TEST(OracleConstantTest, EqualTalliesPassAndOneFullCellFails) {
    EXPECT_EQ(constant_p_value(Tallies(12, 1), twelve), 1.0);
    EXPECT_EQ(constant_p_value(Tallies(12, 0), twelve), 1.0);
    Tallies one(12, 0);
    one[0] = 12;  // V = 132
    EXPECT_LT(constant_p_value(one, twelve), 1e-20);
}

TEST(OracleConstantTest, PValuesAgreeWithTabulatedQuantiles) {
    std::mt19937_64 random(2);
    struct Case {
        Cells cells;
        double critical;
    };
    for (const Case& c :
         {Case{{2, 6}, 19.67514}, Case{{1, 6}, 11.0705}, Case{{1, 3}, 5.99146}, Case{{2, 3}, 11.0705}}) {
        const std::size_t n = std::size_t(c.cells.rings) * c.cells.sectors;
        int rejected = 0;
        for (int trial = 0; trial < 2000; ++trial) {
            const Tallies tallies = draw(std::vector<double>(n, 1.0), 40, random);
            double squares = 0.0;
            for (const double o : tallies) squares += o * o;
            const double statistic = n / 40.0 * squares - 40.0;
            const bool reject = statistic >= c.critical;
            EXPECT_EQ(constant_p_value(tallies, c.cells) <= 0.05, reject) << "V = " << statistic << ", cells " << n;
            rejected += reject;
        }
        EXPECT_GT(rejected, 40) << "both outcomes have to occur; cells " << n;
        EXPECT_LT(rejected, 180) << "cells " << n;
    }
}

TEST(OracleLinearTest, CellProbabilitiesMatchTheTable) {
    const auto p = linear_cell_probabilities(twelve, 0.37 / pi, -0.51 / pi);
    EXPECT_NEAR(p[0], 0.0857877982, 5e-11);   // ring 1, sector 1
    EXPECT_NEAR(p[2], 0.0617471468, 5e-11);   // ring 1, sector 3
    EXPECT_NEAR(p[8], 0.0438645643, 5e-11);   // ring 2, sector 3
    EXPECT_NEAR(p[11], 0.1228021023, 5e-11);  // ring 2, sector 6
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-14);
}

/// A_a of the supplement's equation (9) with n_a^(-3/2): the amplitude of ring a's cells.
double amplitude(const Cells& cells, int ring) {
    return 2.0 / 3.0 * (std::pow(ring + 1.0, 1.5) - std::pow(ring, 1.5)) * std::sin(pi / cells.sectors) *
           std::pow(cells.rings, -1.5);
}

TEST(OracleLinearTest, CellProbabilitiesMatchTheCorrectedClosedForm) {
    for (const std::uint32_t rings : {1u, 2u, 3u, 4u}) {
        for (const std::uint32_t sectors : {4u, 6u, 8u, 12u}) {
            const Cells cells{rings, sectors};
            const auto p = linear_cell_probabilities(cells, 0.1, -0.2);
            for (std::size_t i = 0; i < p.size(); ++i) {
                const double angle = (2.0 * (i % sectors) + 1.0) * pi / sectors;
                const double closed_form =
                    amplitude(cells, int(i / sectors)) * (0.1 * std::cos(angle) - 0.2 * std::sin(angle)) +
                    1.0 / p.size();
                EXPECT_NEAR(p[i], closed_form, 1e-15) << rings << " x " << sectors << ", cell " << i;
            }
        }
    }
}

TEST(OracleLinearTest, SlopesOfTheCells) {
    EXPECT_NEAR(amplitude(twelve, 0), 0.1178511, 5e-8);
    EXPECT_NEAR(amplitude(twelve, 1), 0.2154822, 5e-8);
    const auto slope = linear_cell_probabilities(twelve, 1.0, 0.0);  // less 1/12: D_1
    double squares = 0.0;
    for (const double p : slope) {
        squares += std::pow(p - 1.0 / 12.0, 2);
    }
    EXPECT_NEAR(squares, 3.0 * (std::pow(amplitude(twelve, 0), 2) + std::pow(amplitude(twelve, 1), 2)), 1e-14);
}

TEST(OracleLinearTest, PValuesAgreeWithClosedFormAndTabulatedQuantiles) {
    std::mt19937_64 random(3);
    struct Case {
        Cells cells;
        double critical;
    };
    int rejected = 0, trials = 0;
    for (const Case& c : {Case{{2, 6}, 16.91898}, Case{{1, 6}, 7.81473}}) {
        const std::size_t n = std::size_t(c.cells.rings) * c.cells.sectors;
        for (int trial = 0; trial < 2000; ++trial, ++trials) {
            // From uniform to so steep that the clamp has to work now and then.
            std::vector<double> weights(n, 1.0);
            for (std::size_t i = 0; i < n; ++i) {
                weights[i] += trial % 3 * 0.49 * std::cos((2.0 * (i % 6) + 1.0) * pi / 6.0);
            }
            const Tallies tallies = draw(weights, 10 + trial % 50, random);
            const double total = 10 + trial % 50;
            double k1 = 0.0, k2 = 0.0, norm = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                const double a = amplitude(c.cells, int(i / 6)), angle = (2.0 * (i % 6) + 1.0) * pi / 6.0;
                k1 += tallies[i] * a * std::cos(angle) / total;
                k2 += tallies[i] * a * std::sin(angle) / total;
                norm += a * a * std::cos(angle) * std::cos(angle);
            }
            const double limit = std::min(1.0, 1.0 / (pi * std::hypot(k1, k2) / norm));
            double statistic = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                const double angle = (2.0 * (i % 6) + 1.0) * pi / 6.0;
                const double p =
                    amplitude(c.cells, int(i / 6)) * limit / norm * (k1 * std::cos(angle) + k2 * std::sin(angle)) +
                    1.0 / n;
                statistic += std::pow(tallies[i] - total * p, 2) / (total * p);
            }
            const bool reject = statistic >= c.critical;
            EXPECT_EQ(linear_p_value(tallies, c.cells) <= 0.05, reject) << "V = " << statistic << ", cells " << n;
            rejected += reject;
        }
    }
    EXPECT_GT(rejected, trials / 50);
    EXPECT_LT(rejected, trials / 5);
}

TEST(OracleCppm, ShrinksToTheLargestInnerDiscThatPasses) {
    const TestParameters parameters;
    const Cells cells{3, 6};
    Tallies tallies(18, 10);
    EXPECT_EQ(cppm_update(tallies, cells, 180, 10, parameters), Decision{}) << "uniform: nothing changes";
    tallies[13] = 100;  // the outermost ring alone is uneven
    EXPECT_EQ(cppm_update(tallies, cells, 270, 271, parameters), Decision{}) << "the batch is not full";
    EXPECT_EQ(cppm_update(tallies, cells, 271, 271, parameters), (Decision{2.0 / 3.0, true, 1.2}));
    tallies[7] = 100;
    EXPECT_EQ(cppm_update(tallies, cells, 360, 10, parameters), (Decision{1.0 / 3.0, true, 1.2}));
    tallies[1] = 100;
    EXPECT_EQ(cppm_update(tallies, cells, 450, 10, parameters), (Decision{0.8, true, 1.2}));
    EXPECT_EQ(cppm_null_update(450, 10, parameters), (Decision{0.8, true, 1.2}));
    EXPECT_EQ(cppm_null_update(9, 10, parameters), Decision{});
}

TEST(OracleCppm, AnEmptyCentrePasses) {
    Tallies hole(12, 5);
    std::fill_n(hole.begin(), 6, 0);
    EXPECT_EQ(cppm_update(hole, twelve, 30, 10, {}), (Decision{0.5, true, 1.2}));
}

TEST(OracleCppm, WithOneRingARejectionTakesK) {
    EXPECT_EQ(cppm_update(Tallies{50, 1, 1, 1}, {1, 4}, 53, 10, {}), (Decision{0.8, true, 1.2}));
}

TEST(OracleCppm, FoldingAndTheLinearTestKeepALinearField) {
    const auto weights = linear_cell_probabilities(twelve, 0.9 / pi, 0.0);
    Tallies tallies;
    for (const double p : weights) tallies.push_back(std::uint32_t(std::lround(6000 * p)));
    EXPECT_TRUE(cppm_update(tallies, twelve, 6000, 10, {}).clear);
    EXPECT_EQ(cppm_fold_update(tallies, twelve, 6000, 10, {}), Decision{});
    EXPECT_EQ(cppm_lf_update(tallies, twelve, 6000, 10, {}), Decision{});
    EXPECT_EQ(fold(Tallies{1, 2, 3, 4, 5, 6, 10, 20, 30, 40, 50, 60}, twelve), (Tallies{5, 7, 9, 50, 70, 90}));
}

TEST(OracleCppm, FalseRejectionsOnAUniformFieldAreThePublishedOnes) {
    constexpr int pixels = 4000;
    std::mt19937_64 random(4);
    std::poisson_distribution<int> photons(10.0);
    std::uniform_int_distribution<int> cell(0, 11);
    int rejected_by_10 = 0, rejected_by_100 = 0, rejected_by_1000 = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
        Tallies tallies(12, 0);
        double total = 0.0;
        for (int iteration = 1; iteration <= 1000; ++iteration) {
            const int found = photons(random);
            for (int i = 0; i < found; ++i) ++tallies[cell(random)];
            total += found;
            if (cppm_update(tallies, twelve, total, 10.0, {}).clear) {
                rejected_by_10 += iteration <= 10;
                rejected_by_100 += iteration <= 100;
                ++rejected_by_1000;
                break;
            }
        }
    }
    EXPECT_NEAR(rejected_by_10 / double(pixels), 0.18, 0.015);
    EXPECT_NEAR(rejected_by_100 / double(pixels), 0.39, 0.015);
    EXPECT_NEAR(rejected_by_1000 / double(pixels), 0.55, 0.015);
}

// -- tests on contributions -----------------------------------------------------------------------------------------

TEST(OracleFTest, PValuesMatchTabulatedQuantiles) {
    // One cell in c stands out by d in every sample; each cell alternates by +-1 around its mean, so F is known.
    struct Case {
        Cells cells;
        std::uint32_t samples;
        double critical;
    };
    for (const Case& c :
         {Case{{2, 6}, 10, 1.878}, Case{{2, 6}, 20, 1.831}, Case{{1, 6}, 10, 2.386}, Case{{1, 6}, 20, 2.294}}) {
        const double n = c.cells.rings * c.cells.sectors, m = c.samples;
        const double within = n * m / (n * (m - 1.0));                     // mean square of the +-1
        const double stands_out = std::sqrt(c.critical * within * n / m);  // m d^2 (1 - 1/n) / (n - 1) = F within
        FTestState state;
        state.samples = c.samples;
        state.sums.assign(std::size_t(n), 5.0 * m);
        state.sums[0] += stands_out * m;
        state.squares.assign(c.cells.rings, c.cells.sectors * m * 26.0);
        state.squares[0] += m * (std::pow(5.0 + stands_out, 2) - 25.0);
        EXPECT_NEAR(f_test_p_value(state, c.cells), 0.05, 1e-4) << n << " cells, " << m << " samples";
    }
}

TEST(OracleFTest, SumsGiveTheVarianceAnalysisOfTheSamples) {
    std::mt19937_64 random(5);
    std::exponential_distribution<double> value(1.0);
    constexpr std::size_t samples = 3, groups = 12;
    int rejected = 0;
    for (int trial = 0; trial < 500; ++trial) {
        std::array<std::array<double, groups>, samples> x;
        FTestState state{std::vector<double>(groups, 0.0), std::vector<double>(2, 0.0), samples};
        for (auto& row : x) {
            for (std::size_t i = 0; i < groups; ++i) {
                row[i] = value(random) * (i < 2 ? 2.5 : 1.0);
                state.sums[i] += row[i];
                state.squares[i / 6] += row[i] * row[i];
            }
        }
        double grand = 0.0, between = 0.0, within = 0.0;
        for (const auto& row : x) {
            grand += std::accumulate(row.begin(), row.end(), 0.0) / (samples * groups);
        }
        for (std::size_t i = 0; i < groups; ++i) {
            const double mean = (x[0][i] + x[1][i] + x[2][i]) / samples;
            between += samples * std::pow(mean - grand, 2) / (groups - 1.0);
            for (const auto& row : x) {
                within += std::pow(row[i] - mean, 2) / (groups * (samples - 1.0));
            }
        }
        const bool reject = between / within >= 2.2163;  // F.95(11, 24)
        EXPECT_EQ(f_test_p_value(state, twelve) <= 0.05, reject) << "F = " << between / within;
        EXPECT_EQ(f_test_update(state, twelve, 10, 10, {}).clear, reject);
        EXPECT_EQ(f_test_update(state, twelve, 9, 10, {}), Decision{}) << "the batch is not full";
        rejected += reject;
    }
    EXPECT_GT(rejected, 50);
    EXPECT_LT(rejected, 450);
}

TEST(OracleFTest, DegenerateStatistics) {
    FTestState state{std::vector<double>(12, 0.0), {0.0, 0.0}, 5};
    EXPECT_EQ(f_test_p_value(state, twelve), 1.0) << "no photon at all";
    state = {std::vector<double>(12, 10.0), {6 * 20.0, 6 * 20.0}, 5};
    EXPECT_EQ(f_test_p_value(state, twelve), 1.0) << "all samples are 2";
    state.sums[3] = 15.0;
    state.squares[0] += 5 * (9.0 - 4.0);
    EXPECT_EQ(f_test_p_value(state, twelve), 0.0) << "one cell is always 3, the others always 2";
    EXPECT_EQ(f_test_update(state, twelve, 10, 10, {}), (Decision{0.8, true, 1.2}));
    state.samples = 2;
    EXPECT_EQ(f_test_p_value(state, twelve), 1.0) << "two samples say nothing";
}

TEST(OracleFTest, SizeIsTheSignificance) {
    std::mt19937_64 random(6);
    std::poisson_distribution<int> photons(4.0);
    constexpr int trials = 4000, samples = 40;
    int rejected = 0;
    for (int trial = 0; trial < trials; ++trial) {
        FTestState state{std::vector<double>(12, 0.0), {0.0, 0.0}, samples};
        for (int j = 0; j < samples; ++j) {
            for (std::size_t i = 0; i < 12; ++i) {
                const double x = photons(random);
                state.sums[i] += x;
                state.squares[i / 6] += x * x;
            }
        }
        rejected += f_test_p_value(state, twelve) <= 0.05;
    }
    // Four standard errors of a binomial share of 0.05.
    EXPECT_NEAR(rejected / double(trials), 0.05, 4.0 * std::sqrt(0.05 * 0.95 / trials));
}

// -- APPM -------------------------------------------------------------------------------------------------------------

double over_disc(const std::function<double(double, double)>& integrand) {
    using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
    return Rule::integrate(
        [&](double angle) {
            return Rule::integrate([&](double r) { return r * integrand(r * std::cos(angle), r * std::sin(angle)); },
                                   0.0, 1.0, 8, 1e-12);
        },
        0.0, 2.0 * pi, 8, 1e-12);
}

TEST(OracleAppm, KernelConstants) {
    for (const Kernel* kernel :
         {&box_kernel, &cone_kernel, &epanechnikov_kernel, &biweight_kernel, &smootherstep_kernel}) {
        const auto value = [&](double x, double y) { return kernel->value(std::hypot(x, y)); };
        EXPECT_NEAR(over_disc(value), 1.0, 1e-9);
        EXPECT_NEAR(over_disc([&](double x, double y) { return x * x * value(x, y); }), kernel->second_moment, 1e-9);
        EXPECT_NEAR(over_disc([&](double x, double y) { return value(x, y) * value(x, y); }), kernel->roughness, 1e-9);
    }
}

TEST(OracleAppm, OptimalRadiusIsTheMinimumOfTheError) {
    for (const Kernel* kernel : {&box_kernel, &smootherstep_kernel}) {
        const double second_moment = 3.7, laplacian = -2.1, paths = 5e4;
        const auto error = [&](double r) {
            return kernel->roughness * second_moment / (paths * r * r) +
                   std::pow(0.5 * kernel->second_moment * r * r * laplacian, 2);
        };
        const double minimum = boost::math::tools::brent_find_minima(error, 1e-3, 10.0, 40).first;
        EXPECT_NEAR(appm_optimal_radius(*kernel, second_moment, laplacian, paths) / minimum, 1.0, 1e-5);
    }
}

TEST(OracleAppm, StencilIsTheLaplacianOfAQuadratic) {
    // For f = x^2 the average of the stencil over a uniform field of photons weighted by f is the Laplacian, 2.
    const double r = 0.3;
    const double laplacian = over_disc([&](double u, double v) {
        const double x = 2.0 * r * u, y = 2.0 * r * v;
        return x * x * laplacian_stencil(x, y, r) * 4.0 * r * r;
    });
    EXPECT_NEAR(laplacian, 2.0, 1e-6);
}

TEST(OracleAppm, RadiusScalesWithTheSceneAndStaysInItsBounds) {
    // At equal radiance V (radiance^2 m^2) grows with the square of the scale and D (radiance / m^2) shrinks with it.
    const AppmState state{5.0 * 8, 3.0 * 8, 8, 100.0, 0.1};
    const double radius = appm_radius(state, smootherstep_kernel, 1e6, 1e-3, 10.0, 1e-12);
    const double s = 7.0;
    const AppmState scaled{5.0 * 8 * s * s, 3.0 * 8 / (s * s), 8, 100.0, 0.1 * s};
    EXPECT_NEAR(appm_radius(scaled, smootherstep_kernel, 1e6, 1e-3, 10.0, 1e-12) / (s * radius), 1.0, 1e-12);
    const double shrink = std::pow(8.0, -1.0 / 6.0);
    EXPECT_NEAR(appm_radius(state, smootherstep_kernel, 1e6, 50.0, 60.0, 1e-12), 5.0 * shrink, 1e-12);
    EXPECT_NEAR(appm_radius(state, smootherstep_kernel, 1e6, 1e-6, 1e-5, 1e-12), 1e-6 * shrink, 1e-12);
    EXPECT_EQ(appm_radius({40.0, 24.0, 8, 9.0, 0.1}, smootherstep_kernel, 1e6, 1e-3, 10.0, 1e-12), 0.1);
    EXPECT_NEAR(appm_pilot_radius(0.1, 256, 0.5), 0.025, 1e-15);
}

}  // namespace
}  // namespace vkcppm::oracle
