// How radii shrink: the schedules of SPPM, the law of the batches, APPM's optimum, the starting radius.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "oracle/estimator.h"
#include "shared/estimators.h"
#include "support/device/gpu.h"
#include "support/device/synthetic_field.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

Settings settings_of(const char* estimator) {
    Settings settings;
    settings.estimator = estimator;
    return settings;
}

// r_n^2 / r_1^2 = Gamma(n + alpha) / (Gamma(1 + alpha) Gamma(n + 1)) whatever the photons do.
TEST(Radius, KnausAndZwickerOnPhotons) {
    SyntheticField field(plain_device(), settings_of("sppm-kz"), find_field("gauss"), 8, 10.0, 1);
    std::uint32_t done = 0;
    for (const auto& [iterations, ratio] : {std::pair{10u, 0.4931}, {100u, 0.2376}, {1000u, 0.11072}}) {
        field.run(iterations - done);
        done = iterations;
        for (const gpu::PixelState& state : field.states()) {
            ASSERT_NEAR(state.radius2 / field.first_radius2(), ratio, 1e-4) << iterations << " iterations";
        }
    }
}

// Two pixels on the update kernel alone. One has a constant density, so M follows R^2; the other finds ten photons
// however small its disc is: a product with the closed form n! Gamma(1/alpha) / Gamma(n + 1/alpha).
TEST(Radius, HachisukaAndJensenAtConstantDensityAndAtConstantCount) {
    SyntheticField field(plain_device(), settings_of("sppm"), find_field("uniform"), 2, 10.0, 1);
    const auto ratio_of = [&](std::size_t pixel) { return field.states()[pixel].radius2 / field.first_radius2(); };
    std::uint32_t done = 0;
    for (const auto& [iterations, at_density] :
         {std::pair{1u, 0.6667}, {2u, 0.5556}, {3u, 0.4938}, {10u, 0.3390}, {100u, 0.1589}, {1000u, 0.07384}}) {
        for (; done < iterations; ++done) {
            const auto found = std::uint32_t(std::lround(1e6 * ratio_of(0)));
            const std::vector<gpu::Gathered> gathered = {{glm::vec3(0.0f), found, glm::vec3(0.0f), 0},
                                                         {glm::vec3(0.0f), 10, glm::vec3(0.0f), 0}};
            field.integrator().buffer(Binding::gathered).upload(gathered);
            field.integrator().run_kernel(KernelId::update, 2, {.iteration = 0, .last_round = 1});
        }
        EXPECT_NEAR(ratio_of(0), at_density, 1e-4) << iterations << " iterations";
        const double n = iterations,
                     at_count = std::exp(std::lgamma(n + 1.0) + std::lgamma(1.5) - std::lgamma(n + 1.5));
        EXPECT_NEAR(ratio_of(1), at_count, 1e-5) << iterations << " iterations";
    }
}

// The gather and the update together: ten photons in the first disc of a uniform field. M is random, but what a small M
// leaves too large finds more photons next time, so the mean over pixels stays within a few percent of the schedule.
TEST(Radius, HachisukaAndJensenOnPhotons) {
    SyntheticField field(plain_device(), settings_of("sppm"), find_field("uniform"), 24, 10.0, 2);
    std::uint32_t done = 0;
    for (const auto& [iterations, ratio] : {std::pair{10u, 0.3390}, {100u, 0.1589}}) {
        field.run(iterations - done);
        done = iterations;
        double mean = 0.0;
        for (const gpu::PixelState& state : field.states()) mean += state.radius2 / field.first_radius2();
        EXPECT_NEAR(mean / double(field.pixels()) / ratio, 1.0, 0.03) << iterations << " iterations";
    }
}

/// Slope of log R^2 against log T where every batch shrinks the disc, by least squares over a decade of iterations.
double batch_slope(double beta, std::uint32_t last) {
    Settings settings = settings_of("cppm-null");
    settings.beta = beta;
    constexpr std::uint32_t side = 12;
    SyntheticField field(plain_device(), settings, find_field("uniform"), side, 10.0, 3);
    // First batches spread over one period of the staircase, whose steps the mean over pixels thus does not see.
    std::vector<gpu::PixelState> states = field.states();
    for (std::size_t i = 0; i < states.size(); ++i) {
        states[i].batch = float(10.0 * std::pow(beta / settings.k, (i + 0.5) / double(states.size())));
    }
    field.set_states(states);
    std::uint32_t done = 0;
    std::vector<std::pair<double, double>> points;
    for (const double share : {0.1, 0.178, 0.316, 0.562, 1.0}) {
        const auto iterations = std::uint32_t(std::lround(share * last));
        field.run(iterations - done);
        done = iterations;
        double mean = 0.0;
        for (const gpu::PixelState& state : field.states()) mean += std::log(state.radius2);
        points.emplace_back(std::log(double(iterations)), mean / double(field.pixels()));
    }
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (const auto& [a, b] : points) {
        x += a / points.size();
        y += b / points.size();
    }
    for (const auto& [a, b] : points) {
        xx += (a - x) * (a - x);
        xy += (a - x) * (b - y);
    }
    return xy / xx;
}

// R^2 ~ T^-gamma, gamma = ln(1/k) / (ln(1/k) + ln(beta)): the law of SPPM's alpha = 2/3 at beta = 1 / k^2.
TEST(Radius, BatchesGrowLikeOneOverKSquared) { EXPECT_NEAR(batch_slope(1.0 / (0.8 * 0.8), 800), -1.0 / 3.0, 0.01); }

TEST(Radius, BatchesOfThePaperShrinkFaster) {
    EXPECT_NEAR(batch_slope(1.2, 400), std::log(0.8) / (std::log(1.2) - std::log(0.8)), 0.01);
}

/// Mean and standard error of a row of the moments.
std::pair<double, double> mean_moment(SyntheticField& field, std::uint32_t row) {
    const std::size_t pixels = field.pixels();
    const auto moments = field.integrator().buffer(Binding::moments).download<float>(APPM_MOMENTS * pixels);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double value = moments[row * pixels + i];
        sum += value;
        squares += value * value;
    }
    const double mean = sum / double(pixels);
    return {mean, std::sqrt((squares / double(pixels) - mean * mean) / double(pixels))};
}

/// Integral over [-1, 1]^2 by the midpoint rule: the integrands are smooth and vanish towards the rim.
double over_square(const std::function<double(double, double)>& integrand) {
    constexpr int steps = 400;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) sum += integrand((2.0 * i + 1.0) / steps - 1.0, (2.0 * j + 1.0) / steps - 1.0);
    }
    return sum * 4.0 / (steps * steps);
}

// After one iteration V and the Laplacian are the kernel's and the stencil's averages of the field (r = r_1,
// r_d = r_1 / 2), and the estimate is the kernel's.
TEST(Radius, AppmMomentsAreAveragesOfTheField) {
    constexpr double lambda = 100.0;
    const Field& gauss = find_field("gauss");
    SyntheticField field(plain_device(), settings_of("appm"), gauss, 40, lambda, 4);
    field.run(1);
    const double smoothed = over_square(
        [&](double x, double y) { return gauss.density(x, y) * oracle::smootherstep_kernel.value(std::hypot(x, y)); });
    const double curved =
        over_square([&](double x, double y) { return gauss.density(x, y) * oracle::laplacian_stencil(x, y, 0.5); });
    const double first = field.first_radius2();
    // A photon contributes y = pi R_1^2 / lambda; V = J E[sum y^2 K].
    const double paths = field.integrator().params().photons, unit = field.integrator().params().flux_unit;
    const auto [v, v_error] = mean_moment(field, APPM_SECOND_MOMENT);
    const double v_scale = unit * unit * paths * pi * first / lambda, laplacian_scale = unit / first;
    EXPECT_NEAR(v / v_scale, smoothed, 4.0 * v_error / v_scale);
    const auto [laplacian, laplacian_error] = mean_moment(field, APPM_LAPLACIAN);
    EXPECT_NEAR(laplacian / laplacian_scale, curved, 4.0 * laplacian_error / laplacian_scale);
    EXPECT_LT(laplacian_error / laplacian_scale, 0.025 * std::abs(curved)) << "the test would see little";
    double mean = 0.0;
    for (const double estimate : field.estimates()) mean += estimate / double(field.pixels());
    EXPECT_NEAR(mean, smoothed, 0.02);
}

TEST(Radius, AppmApproachesTheOptimumOnAGaussianSpot) {
    constexpr double lambda = 100.0;
    SyntheticField field(plain_device(), settings_of("appm"), find_field("gauss"), 16, lambda, 5);
    const double first = std::sqrt(field.first_radius2()), paths = field.integrator().params().photons;
    std::uint32_t done = 0;
    // The pilot sees the spot flattened, so the radius comes from above.
    for (const auto& [iterations, tolerance] : {std::pair{1u, 0.2}, {10u, 0.12}, {60u, 0.06}}) {
        field.run(iterations - done);
        done = iterations;
        const auto moments = field.integrator().buffer(Binding::moments).download<float>(APPM_MOMENTS * field.pixels());
        const std::vector<gpu::PixelState> states = field.states();
        std::vector<double> ratios;
        // Laplacian -2 / sigma^2 of the spot of height 1, sigma = R_1 / 2; V as above with f = 1.
        const double best =
            oracle::appm_optimal_radius(oracle::smootherstep_kernel, paths * pi * first * first / lambda,
                                        -8.0 / (first * first), paths * iterations);
        for (std::size_t i = 0; i < states.size(); ++i) {
            const auto sum = [&](std::uint32_t row) { return double(iterations) * moments[row * states.size() + i]; };
            const oracle::AppmState state{sum(APPM_SECOND_MOMENT), sum(APPM_LAPLACIAN), iterations,
                                          double(states[i].total), first};
            const double want = oracle::appm_radius(state, oracle::smootherstep_kernel, paths, 0.1, 2.0, 1e-300);
            ASSERT_NEAR(std::sqrt(states[i].radius2) / want, 1.0, 1e-5)
                << "pixel " << i << ", iteration " << iterations;
            ratios.push_back(std::sqrt(states[i].radius2) / best);
        }
        std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
        EXPECT_NEAR(ratios[ratios.size() / 2], 1.0, tolerance) << "median over pixels, iteration " << iterations;
    }
}

// The squared distance of the k-th nearest photon leaves k - 1 inside: (k - 1) / (pi R^2) is unbiased, and so is the
// estimate of the iteration that chose the radius.
TEST(Radius, TheKthNearestPhotonGivesAnUnbiasedDensity) {
    constexpr double lambda = 40.0, k = 10.0;
    SyntheticField field(plain_device(), settings_of("cppm"), find_field("uniform"), 64, lambda, 6);
    std::vector<gpu::PixelState> states = field.states();
    for (gpu::PixelState& state : states) {
        state.radius2 = 0.0f;
        state.seeded = 0;
    }
    field.set_states(states);
    field.run(1);
    states = field.states();
    const std::vector<double> estimates = field.estimates();
    double density = 0.0, estimate = 0.0;
    for (std::size_t i = 0; i < states.size(); ++i) {
        ASSERT_EQ(states[i].seeded, 1u);
        ASSERT_EQ(states[i].photons, k - 1.0);
        density += (k - 1.0) / (states[i].radius2 / field.first_radius2() * lambda) / double(states.size());
        estimate += estimates[i] / double(states.size());
    }
    // 1 / R^2 is an inverse gamma variable: relative variance 1 / (k - 2).
    const double error = 1.0 / std::sqrt((k - 2.0) * double(states.size()));
    EXPECT_NEAR(density, 1.0, 4.0 * error);
    EXPECT_NEAR(estimate, 1.0, 4.0 * error);
}

}  // namespace
}  // namespace vkcppm::test
