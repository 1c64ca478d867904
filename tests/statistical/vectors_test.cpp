// Published numbers on the kernels: critical values, statistics of known tallies, what follows from them.

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "oracle/estimator.h"
#include "support/device/gpu.h"
#include "support/device/synthetic_field.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;
using Tally = std::vector<std::uint32_t>;

/// One pixel and the update kernel.
class Vectors : public GpuTest {
protected:
    static SyntheticField pixel(const std::string& estimator, std::uint32_t rings = 2) {
        Settings settings;
        settings.estimator = estimator;
        settings.rings = rings;
        return SyntheticField(device(), settings, find_field("uniform"), 1, 10.0, 1);
    }

    static gpu::PixelState update(SyntheticField& field) {
        field.integrator().run_kernel(KernelId::update, 1, {.iteration = 0, .last_round = 1});
        return field.states().front();
    }

    /// The state after a test of this tally.
    static gpu::PixelState test_tally(SyntheticField& field, const Tally& tally) {
        field.reset(0.0);
        field.integrator().buffer(Binding::tally).upload(tally);
        return update(field);
    }
};

TEST_F(Vectors, CriticalValuesOfChiSquared) {
    struct Case {
        const char* estimator;
        double inner, outer;
    };
    for (const Case& c : {Case{"cppm", 11.07050, 19.67514},
                          {"cppm-gof", 11.07050, 19.67514},
                          {"cppm-lf", 7.81473, 16.91898},
                          {"cppm-fold", 5.99146, 11.07050}}) {
        SyntheticField field = pixel(c.estimator);
        EXPECT_NEAR(field.integrator().params().threshold[0], c.inner, 6e-6) << c.estimator;
        EXPECT_NEAR(field.integrator().params().threshold[1], c.outer, 6e-6) << c.estimator;
    }
}

// The kernel's threshold is the F of a known state over the ratio that it reports.
TEST_F(Vectors, CriticalValuesOfTheFTest) {
    struct Case {
        std::uint32_t rings;
        float samples;
        double critical;
    };
    for (const Case& c : {Case{2, 3, 2.216},
                          {2, 5, 1.995},
                          {2, 10, 1.878},
                          {2, 20, 1.831},
                          {1, 3, 3.106},
                          {1, 5, 2.621},
                          {1, 10, 2.386},
                          {1, 20, 2.294}}) {
        SyntheticField field = pixel("ftest", c.rings);
        const std::size_t n = 6 * c.rings;
        field.reset(0.0);
        std::vector<gpu::PixelState> states = field.states();
        states.front().count = c.samples - 1.0f;
        field.set_states(states);
        // All cells at 1 but one at 1.5, and this iteration's sample at the mean; squares of 1 a sample and cell.
        std::vector<float> moments(2 * n, 1.0f);
        moments[0] = moments[n] = 1.5f;
        moments.insert(moments.end(), c.rings, 6.0f * c.samples);
        field.integrator().buffer(Binding::moments).upload(moments);
        const double between = c.samples * 0.25 * (1.0 - 1.0 / double(n)) / (double(n) - 1.0);
        const double within = double(n) * c.samples / (double(n) * (c.samples - 1.0));
        EXPECT_NEAR(between / within / update(field).statistic, c.critical, 6e-4)
            << n << " cells, " << c.samples << " samples";
    }
}

TEST_F(Vectors, ChiSquaredOfKnownTallies) {
    SyntheticField field = pixel("cppm");
    const double threshold = field.integrator().params().threshold[1];
    const auto area_factor = [&](const gpu::PixelState& state) { return state.radius2 / field.first_radius2(); };

    gpu::PixelState state = test_tally(field, Tally(12, 1));
    EXPECT_EQ(state.statistic, 0.0f) << "equal tallies";
    EXPECT_EQ(state.rejections, 0u);

    state = test_tally(field, Tally(12, 0));
    EXPECT_EQ(state.statistic, 0.0f) << "an empty disc passes";
    EXPECT_EQ(state.rejections, 0u);

    Tally one(12, 0);
    one[0] = 12;
    state = test_tally(field, one);
    EXPECT_NEAR(state.statistic * threshold, 132.0, 1e-4);
    EXPECT_NEAR(area_factor(state), 0.8, 1e-6) << "the inner disc, V = 60, fails too";
    EXPECT_NEAR(state.batch, 0.0, 0.0);
    EXPECT_EQ(state.rejections, 1u);

    Tally rim(12, 0);
    rim[11] = 12;
    state = test_tally(field, rim);
    EXPECT_NEAR(state.statistic * threshold, 132.0, 1e-4);
    EXPECT_NEAR(area_factor(state), 0.5, 1e-6) << "the inner disc is empty and passes";

    // Where a sum of squares of floats has no digits left: sum (O - E)^2 / E = 2 * 20,000^2 / 10^8.
    Tally large(12, 100'000'000);
    large[3] += 20'000;
    large[7] -= 20'000;
    EXPECT_NEAR(test_tally(field, large).statistic * threshold, 8.0, 1e-4);
}

TEST_F(Vectors, FoldedTallies) {
    SyntheticField field = pixel("cppm-fold");
    EXPECT_EQ(test_tally(field, Tally(6, 1)).statistic, 0.0f);
    const gpu::PixelState state = test_tally(field, {12, 0, 0, 0, 0, 0});
    EXPECT_NEAR(state.statistic * field.integrator().params().threshold[1], 60.0, 1e-4);
    EXPECT_EQ(state.rejections, 1u);
}

/// 10^9 photons spread like `p`.
Tally spread(const std::vector<double>& p) {
    Tally tally;
    for (const double share : p) tally.push_back(std::uint32_t(std::lround(1e9 * share)));
    return tally;
}

TEST_F(Vectors, TheLinearTestFitsLinearDensities) {
    SyntheticField field = pixel("cppm-lf");
    const double threshold = field.integrator().params().threshold[1];
    // By quadrature for n_a = 2, n_s = 6 and (k1, k2) = (0.37, -0.51) / pi.
    const std::vector<double> p = oracle::linear_cell_probabilities({2, 6}, 0.37 / pi, -0.51 / pi);
    EXPECT_NEAR(p[0], 0.0857877982, 1e-9);
    EXPECT_NEAR(p[2], 0.0617471468, 1e-9);
    EXPECT_NEAR(p[8], 0.0438645643, 1e-9);
    EXPECT_NEAR(p[11], 0.1228021023, 1e-9);
    EXPECT_LT(test_tally(field, spread(p)).statistic * threshold, 1e-2) << "a density that the model holds";
    // The inner disc is fitted by itself: a linear density there, anything outside.
    Tally inner = spread(p);
    inner[6] = 0;
    EXPECT_NEAR(test_tally(field, inner).radius2 / field.first_radius2(), 0.5, 1e-6);
}

// Tallies half as steep again as any density can be: the fit stops at |k| = 1 / pi, where the density is zero on the
// rim. With a factor too large by 2^(13/6), as it is printed, the clamp would not act and the statistic would be
// smaller.
TEST_F(Vectors, TheLinearTestKeepsDensitiesPositive) {
    SyntheticField field = pixel("cppm-lf");
    // Towards the centre of the first sector, so that the direction of the fit is exact by symmetry.
    const double kx = std::cos(pi / 6.0) / pi, ky = std::sin(pi / 6.0) / pi;
    const std::vector<double> steepest = oracle::linear_cell_probabilities({2, 6}, kx, ky);
    Tally tally;
    for (const double p : steepest) {
        tally.push_back(std::uint32_t(std::lround(12000.0 * std::max(0.0, 1.5 * p - 0.5 / 12.0))));
    }
    const double sum = std::accumulate(tally.begin(), tally.end(), 0.0);
    double statistic = 0.0;
    for (std::size_t i = 0; i < tally.size(); ++i) {
        statistic += std::pow(tally[i] - sum * steepest[i], 2) / (sum * steepest[i]);
    }
    EXPECT_NEAR(test_tally(field, tally).statistic * field.integrator().params().threshold[1], statistic,
                1e-4 * statistic);
}

}  // namespace
}  // namespace vkcppm::test
