// The update kernel of the estimators that test or adapt against the oracle in double precision, on random states.
// A state whose p-value lies so near the significance that the kernel's floats may fall on the other side is left out
// and counted: within 1e-5 for chi-squared; within 1e-4 for the F-tests, whose means are floats: after 10^4 samples
// means differ significantly that share their first two digits. (Interpolating the thresholds moves p by less than
// 1e-6.)

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "oracle/estimator.h"
#include "render/estimators.h"
#include "shared/estimators.h"
#include "support/device/gpu.h"
#include "support/device/synthetic_field.h"
#include "support/names.h"

namespace vkcppm::test {
namespace {

using oracle::Cells;
using oracle::Decision;

/// Uniform in the logarithm.
double log_uniform(Random& random, double low, double high) {
    return low * std::exp(uniform(random) * std::log(high / low));
}

/// What the update kernel reads and writes of every pixel.
struct States {
    std::vector<gpu::PixelState> pixels;
    std::vector<std::uint32_t> found;  // photons of the iteration
    std::vector<std::uint32_t> tally;  // [rows x P]
    std::vector<float> moments;        // [rows x P]
};

/// Column `pixel` of [rows x P] values.
template <typename T> std::vector<T> column(const std::vector<T>& values, std::size_t pixels, std::size_t pixel) {
    std::vector<T> result;
    for (std::size_t i = pixel; i < values.size(); i += pixels) result.push_back(values[i]);
    return result;
}

/// One launch of the update kernel of an estimator.
class Update {
public:
    Update(const std::string& estimator, std::uint32_t rings, std::uint32_t sectors, std::uint32_t side)
        : settings_([&] {
              Settings settings;
              settings.estimator = estimator;
              settings.rings = rings;
              settings.sectors = sectors;
              return settings;
          }()),
          row_(find_estimator(estimator)),
          field_(device(), settings_, find_field("uniform"), side, 0.01, 1) {}

    std::size_t pixels() const { return field_.pixels(); }
    const EstimatorRow& row() const { return row_; }
    const gpu::Params& params() { return field_.integrator().params(); }

    States run(const States& before) {
        Integrator& integrator = field_.integrator();
        field_.set_states(before.pixels);
        std::vector<gpu::Gathered> gathered;
        for (const std::uint32_t count : before.found) gathered.push_back({glm::vec3(0.0f), count, glm::vec3(0.0f), 0});
        integrator.buffer(Binding::gathered).upload(gathered);
        if (!before.tally.empty()) integrator.buffer(Binding::tally).upload(before.tally);
        if (!before.moments.empty()) integrator.buffer(Binding::moments).upload(before.moments);
        integrator.run_kernel(KernelId::update, pixels(), {.iteration = 0, .last_round = 1});
        return {field_.states(), before.found,
                integrator.buffer(Binding::tally).download<std::uint32_t>(before.tally.size()),
                integrator.buffer(Binding::moments).download<float>(before.moments.size())};
    }

private:
    Settings settings_;
    const EstimatorRow& row_;
    SyntheticField field_;
};

/// A pixel between two iterations; `total` photons once those `found` now are added, about one batch.
gpu::PixelState random_state(Random& random, std::uint32_t total, std::uint32_t found) {
    gpu::PixelState state{};
    state.radius2 = float(log_uniform(random, 1e-8, 1e-2));
    state.seeded = 1;
    state.total = total - found;
    state.batch = float((total + 1.0) * (0.5 + uniform(random)));
    state.rejections = std::uint32_t(8 * uniform(random));
    state.photons = state.total;
    return state;
}

/// Tallies of `total` photons, about uniform, tilted, stretched along an axis, gathered towards the centre or the rim.
std::vector<std::uint32_t> random_tally(Random& random, const Cells& cells, std::uint32_t total) {
    const double tilt = 1.2 * std::pow(uniform(random), 2), direction = 6.2831853 * uniform(random);
    const double stretch = 1.2 * std::pow(uniform(random), 2), rise = 8.0 * std::pow(2.0 * uniform(random) - 1.0, 3);
    std::vector<double> weights;
    for (std::uint32_t i = 0; i < cells.rings * cells.sectors; ++i) {
        const double ring = (i / cells.sectors + 0.5) / cells.rings;
        const double angle = 6.2831853 * (i % cells.sectors + 0.5) / cells.sectors;
        weights.push_back(std::max(0.01, 1.0 + tilt * std::sqrt(ring) * std::cos(angle - direction) +
                                             stretch * ring * std::cos(2.0 * angle + direction) + rise * ring));
    }
    std::discrete_distribution<std::uint32_t> cell(weights.begin(), weights.end());
    std::vector<std::uint32_t> tally(weights.size(), 0);
    for (std::uint32_t i = 0; i < total; ++i) ++tally[cell(random)];
    return tally;
}

/// Compares the kernel's next state with the decision; counts decisions, so that a test can insist on all kinds.
struct Outcome {
    std::size_t kept = 0, inner = 0, shrunk = 0, excluded = 0;

    void compare(const gpu::PixelState& before, std::uint32_t found, const gpu::PixelState& after, const Decision& want,
                 const gpu::Params& params) {
        ++(want.area_factor == 1.0 ? kept : want.area_factor == double(params.k) ? shrunk : inner);
        EXPECT_NEAR(after.radius2 / double(before.radius2), want.area_factor, 1e-6);
        EXPECT_NEAR(after.batch / double(before.batch), want.batch_factor, 1e-6);
        EXPECT_EQ(after.total, want.clear ? 0 : before.total + found);
        EXPECT_EQ(after.rejections, before.rejections + (want.clear ? 1 : 0));
        EXPECT_EQ(after.photons, before.photons + found);
        EXPECT_EQ(after.seen, before.seen + 1);
    }
};

/// p-value of the disc of the first `rings` rings.
using PValue = std::function<double(std::uint32_t rings)>;

/// True where no p-value of the discs lies within `margin` of the significance.
bool decided(const PValue& p_value, std::uint32_t rings, double margin) {
    for (; rings > 0; --rings) {
        if (std::abs(p_value(rings) - oracle::TestParameters().significance) < margin) return false;
    }
    return true;
}

oracle::TestParameters parameters_of(const gpu::Params& params) {
    oracle::TestParameters parameters;
    parameters.k = params.k;
    parameters.beta = params.beta;
    return parameters;
}

Outcome compare_tally_estimator(const std::string& name, std::uint32_t rings, std::uint32_t sectors,
                                std::uint32_t side) {
    Update update(name, rings, sectors, side);
    const std::size_t pixels = update.pixels();
    const Cells cells{rings, update.row().folded ? sectors / 2 : sectors};
    const oracle::TestParameters parameters = parameters_of(update.params());
    Random random(7);
    States before;
    std::vector<std::vector<std::uint32_t>> tallies;  // as a photon falls; the kernel's are folded
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const auto total = std::uint32_t(log_uniform(random, 1.0, 300.0));
        tallies.push_back(random_tally(random, {rings, sectors}, total));
        before.found.push_back(std::uint32_t(uniform(random) * (total + 1)));
        before.pixels.push_back(random_state(random, total, before.found.back()));
    }
    before.tally.resize(pixels * tally_rows(update.row(), rings, sectors));
    for (std::size_t pixel = 0; pixel < pixels && !before.tally.empty(); ++pixel) {
        const auto kept = update.row().folded ? oracle::fold(tallies[pixel], {rings, sectors}) : tallies[pixel];
        for (std::size_t bin = 0; bin < kept.size(); ++bin) before.tally[bin * pixels + pixel] = kept[bin];
    }
    const States after = update.run(before);

    Outcome outcome;
    for (std::size_t pixel = 0; pixel < pixels && !testing::Test::HasFailure(); ++pixel) {
        const gpu::PixelState& state = before.pixels[pixel];
        const auto tally = column(before.tally, pixels, pixel);
        const double total = state.total + before.found[pixel];
        if (name != "cppm-null" && total >= state.batch) {
            const PValue p_value = [&](std::uint32_t inner) {
                return name == "cppm-lf" ? oracle::linear_p_value(tally, {inner, cells.sectors})
                                         : oracle::constant_p_value(tally, {inner, cells.sectors});
            };
            if (!decided(p_value, rings, 1e-5)) {
                ++outcome.excluded;
                continue;
            }
        }
        const auto& tallied = tallies[pixel];
        const Cells whole{rings, sectors};
        const Decision want =
            name == "cppm-null"   ? oracle::cppm_null_update(total, state.batch, parameters)
            : name == "cppm-lf"   ? oracle::cppm_lf_update(tallied, whole, total, state.batch, parameters)
            : name == "cppm-fold" ? oracle::cppm_fold_update(tallied, whole, total, state.batch, parameters)
                                  : oracle::cppm_update(tallied, whole, total, state.batch, parameters);
        outcome.compare(state, before.found[pixel], after.pixels[pixel], want, update.params());
        const auto next = column(after.tally, pixels, pixel);
        EXPECT_EQ(next, want.clear && name != "cppm-null" ? std::vector<std::uint32_t>(tally.size(), 0) : tally);
        if (testing::Test::HasFailure()) {
            ADD_FAILURE() << "pixel " << pixel << ", tally " << testing::PrintToString(tally) << ", total " << total
                          << ", batch " << state.batch;
        }
    }
    return outcome;
}

Outcome compare_f_test(const std::string& name, std::uint32_t rings, std::uint32_t sectors, std::uint32_t side) {
    Update update(name, rings, sectors, side);
    const std::size_t pixels = update.pixels();
    const Cells cells{rings, update.row().folded ? sectors / 2 : sectors};
    const std::size_t n = std::size_t(cells.rings) * cells.sectors;
    const oracle::TestParameters parameters = parameters_of(update.params());
    Random random(8);
    std::normal_distribution<double> normal;
    States before;
    before.moments.resize(pixels * (2 * n + rings));
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const auto total = std::uint32_t(log_uniform(random, 1.0, 300.0));
        before.found.push_back(std::uint32_t(uniform(random) * (total + 1)));
        gpu::PixelState state = random_state(random, total, before.found.back());
        // Samples so far: none, one, two, or up to 10^4; mean 1, deviations of cells from far below to far above noise.
        // Some pixels never met a photon.
        const bool dark = pixel % 101 == 0;
        const double samples = pixel % 8 == 0 ? double(pixel / 8 % 3) : std::floor(log_uniform(random, 2.0, 1e4));
        state.count = float(samples);
        const double noise = log_uniform(random, 0.1, 3.0), scale = dark ? 0.0 : log_uniform(random, 1e-6, 1e6);
        const double effect = noise * std::sqrt(8.0 * uniform(random) / std::max(1.0, samples));
        for (std::size_t cell = 0; cell < n; ++cell) {
            const double spread = std::hypot(noise / std::sqrt(std::max(1.0, samples)), cell % 2 ? effect : 0.0);
            const double mean = samples > 0 ? std::abs(1.0 + spread * normal(random)) : 0.0;
            before.moments[cell * pixels + pixel] = float(scale * std::abs(1.0 + noise * normal(random)));
            before.moments[(n + cell) * pixels + pixel] = float(scale * mean);
        }
        for (std::uint32_t ring = 0; ring < rings; ++ring) {
            const double freedom = cells.sectors * (samples - 1.0);
            const double squares = freedom > 0 ? std::chi_squared_distribution<double>(freedom)(random) : 0.0;
            before.moments[(2 * n + ring) * pixels + pixel] = float(scale * scale * noise * noise * squares);
        }
        before.pixels.push_back(state);
    }
    const States after = update.run(before);

    Outcome outcome;
    for (std::size_t pixel = 0; pixel < pixels && !testing::Test::HasFailure(); ++pixel) {
        const gpu::PixelState& state = before.pixels[pixel];
        const std::vector<float> kept = column(before.moments, pixels, pixel);
        const double so_far = state.count, samples = so_far + 1.0;
        oracle::FTestState statistics;
        statistics.samples = std::uint32_t(samples);
        statistics.sums.resize(n);
        statistics.squares.assign(kept.begin() + 2 * n, kept.end());
        for (std::size_t cell = 0; cell < n; ++cell) {
            const double x = kept[cell], mean = kept[n + cell];
            statistics.sums[cell] = so_far * mean + x;
            statistics.squares[cell / cells.sectors] += so_far * mean * mean + x * x;
        }
        const double total = state.total + before.found[pixel];
        if (total >= state.batch) {
            const PValue p_value = [&](std::uint32_t inner) {
                return oracle::f_test_p_value(statistics, {inner, cells.sectors});
            };
            if (!decided(p_value, rings, 1e-4)) {
                ++outcome.excluded;
                continue;
            }
        }
        const Decision want = oracle::f_test_update(statistics, cells, total, state.batch, parameters);
        outcome.compare(state, before.found[pixel], after.pixels[pixel], want, update.params());
        EXPECT_EQ(after.pixels[pixel].count, want.clear ? 0.0f : float(samples));
        const std::vector<float> next = column(after.moments, pixels, pixel);
        for (std::size_t cell = 0; cell < n; ++cell) {
            EXPECT_EQ(next[cell], 0.0f) << "the iteration's own sums start again";
            const double mean = want.clear ? 0.0 : statistics.sums[cell] / samples;
            EXPECT_NEAR(next[n + cell], mean, 1e-6 * std::max(kept[cell], kept[n + cell])) << "mean of cell " << cell;
        }
        for (std::uint32_t ring = 0; ring < rings; ++ring) {
            const double squares = statistics.squares[ring];
            double within = squares;
            for (std::size_t cell = ring * cells.sectors; cell < (ring + 1) * cells.sectors; ++cell) {
                within -= statistics.sums[cell] * statistics.sums[cell] / samples;
            }
            EXPECT_NEAR(next[2 * n + ring], want.clear ? 0.0 : within, 2e-5 * within + 1e-14 * samples * squares)
                << "ring " << ring;
        }
        if (testing::Test::HasFailure()) {
            ADD_FAILURE() << "pixel " << pixel << ", moments " << testing::PrintToString(kept) << ", samples "
                          << samples << ", total " << total << ", batch " << state.batch;
        }
    }
    return outcome;
}

constexpr std::uint32_t many = 317;  // 100,489 states
constexpr std::uint32_t few = 48;    // 2,304 states

class EstimatorUpdate : public GpuTest, public testing::WithParamInterface<std::string> {
protected:
    static Outcome compare(const std::string& name, std::uint32_t rings, std::uint32_t sectors, std::uint32_t side) {
        return find_estimator(name).statistic == Statistic::contribution
                   ? compare_f_test(name, rings, sectors, side)
                   : compare_tally_estimator(name, rings, sectors, side);
    }
};

TEST_P(EstimatorUpdate, DecidesAsTheReference) {
    const Outcome outcome = compare(GetParam(), 2, 6, many);
    RecordProperty("kept", int(outcome.kept));
    RecordProperty("inner", int(outcome.inner));
    RecordProperty("shrunk", int(outcome.shrunk));
    RecordProperty("excluded", int(outcome.excluded));
    EXPECT_GT(outcome.kept, 10000u);
    EXPECT_GT(outcome.shrunk, 3000u);
    if (GetParam() != "cppm-null") {
        EXPECT_GT(outcome.inner, 3000u);
    }
    EXPECT_LT(outcome.excluded, many * many / 500);
}

class OtherCells : public EstimatorUpdate {};

TEST_P(OtherCells, DecideAsTheReference) {
    for (const auto& [rings, sectors] : {std::pair{1u, 4u}, {1u, 12u}, {2u, 8u}, {3u, 6u}, {4u, 4u}, {4u, 12u}}) {
        SCOPED_TRACE("rings " + std::to_string(rings) + ", sectors " + std::to_string(sectors));
        const Outcome outcome = compare(GetParam(), rings, sectors, few);
        EXPECT_GT(outcome.kept, few * few / 10);
        EXPECT_GT(outcome.inner + outcome.shrunk, few * few / 20);
        EXPECT_LT(outcome.excluded, few * few / 500);
        if (HasFailure()) return;
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) { return identifier(info.param); }

INSTANTIATE_TEST_SUITE_P(Estimators, EstimatorUpdate,
                         testing::Values("cppm-lf", "cppm-gof", "cppm-fold", "cppm-null", "ftest", "ftest-fold"),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Estimators, OtherCells,
                         testing::Values("cppm-lf", "cppm-gof", "cppm-fold", "ftest", "ftest-fold"), test_name);

class AppmUpdate : public GpuTest {};

TEST_F(AppmUpdate, ChoosesTheRadiusOfTheReference) {
    Update update("appm", 2, 6, many);
    const std::size_t pixels = update.pixels();
    Random random(9);
    States before;
    before.moments.resize(pixels * APPM_MOMENTS);
    const auto moment = [&](auto& states, std::uint32_t row, std::size_t pixel) -> auto& {
        return states.moments[row * pixels + pixel];
    };
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const auto total = std::uint32_t(log_uniform(random, 1.0, 1000.0));
        before.found.push_back(std::uint32_t(uniform(random) * (total + 1)));
        gpu::PixelState state = random_state(random, total, before.found.back());
        const double done = pixel % 8 == 0 ? 0.0 : std::floor(log_uniform(random, 1.0, 1e4));
        const double first = std::sqrt(state.radius2);
        state.count = float(done);
        if (done > 0) {
            moment(before, APPM_FIRST_RADIUS2, pixel) = state.radius2;
            // Beyond ten photons the radius in force is another than the first.
            if (state.total >= 10) state.radius2 = float(state.radius2 * log_uniform(random, 0.1, 1.0));
        }
        // A radiance of about 1; the Laplacian from far below to far above what the clamps leave alone; some are 0.
        const double v = log_uniform(random, 0.1, 10.0) * first * first;
        const double laplacian = log_uniform(random, 1e-3, 1e5) / (first * first) * (pixel % 2 ? 1.0 : -1.0);
        const bool flat = pixel % 97 == 0;
        for (const std::uint32_t row : {APPM_SECOND_MOMENT_NOW, APPM_SECOND_MOMENT}) {
            const bool now = row == APPM_SECOND_MOMENT_NOW;
            if (!now && done == 0.0) continue;
            moment(before, row, pixel) = float(v * (0.5 + uniform(random)));
            moment(before, row + 1, pixel) = flat ? 0.0f : float(laplacian * (0.5 + uniform(random)));
        }
        before.pixels.push_back(state);
    }
    const States after = update.run(before);

    std::size_t kept = 0, low = 0, high = 0, between = 0;
    for (std::size_t pixel = 0; pixel < pixels && !HasFailure(); ++pixel) {
        const gpu::PixelState& state = before.pixels[pixel];
        const double done = state.count;
        const auto sum = [&](std::uint32_t row) {
            return done * moment(before, APPM_SECOND_MOMENT + row, pixel) + double(moment(before, row, pixel));
        };
        oracle::AppmState oracle;
        oracle.sum_second_moment = sum(APPM_SECOND_MOMENT_NOW);
        oracle.sum_laplacian = sum(APPM_LAPLACIAN_NOW);
        oracle.iterations = std::uint64_t(done) + 1;
        oracle.photons = double(state.total) + before.found[pixel];
        oracle.first_radius = std::sqrt(done > 0 ? moment(before, APPM_FIRST_RADIUS2, pixel) : state.radius2);
        // The clamps [0.1, 2] r_1 n^(-1/6) are this renderer's choice.
        const double radius =
            oracle::appm_radius(oracle, oracle::smootherstep_kernel, update.params().photons, 0.1, 2.0, 1e-300);
        const double got = std::sqrt(after.pixels[pixel].radius2);
        EXPECT_NEAR(got / radius, 1.0, 1e-5)
            << "pixel " << pixel << ": " << oracle.iterations << " iterations, V " << oracle.sum_second_moment
            << ", Laplacian " << oracle.sum_laplacian << ", first radius " << oracle.first_radius;
        const double unit = radius / oracle.first_radius * std::pow(done + 1.0, 1.0 / 6.0);
        ++(oracle.photons < 10 ? kept : unit < 0.1000001 ? low : unit > 1.9999999 ? high : between);
        EXPECT_EQ(after.pixels[pixel].total, state.total + before.found[pixel]);
        EXPECT_EQ(after.pixels[pixel].count, float(done + 1.0));
        EXPECT_EQ(moment(after, APPM_SECOND_MOMENT_NOW, pixel), 0.0f);
        EXPECT_EQ(moment(after, APPM_LAPLACIAN_NOW, pixel), 0.0f);
    }
    for (const std::size_t outcome : {kept, low, high, between}) EXPECT_GT(outcome, 5000u);
}

}  // namespace
}  // namespace vkcppm::test
