// The update kernel on random states: the schedules and cppm's decision against oracle/estimator, the film's sum
// against doubles. statistical/estimator_update_test.cpp holds the estimators with statistics of their own to account.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "oracle/estimator.h"
#include "render/estimators.h"
#include "render/kernels.h"
#include "render/scene_on_device.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/names.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr Extent size{400, 250};  // 10^5 states

/// What the oracle says of one pixel; none where its p-values are too near the significance to decide in floats.
struct Wanted {
    double area_factor = 1.0;
    double batch_factor = 1.0;
    bool clear = false;
    double count = 0.0;
};
struct State {
    gpu::PixelState pixel;
    std::uint32_t found = 0;
    std::vector<std::uint32_t> tally;
};
using Rule = std::function<std::optional<Wanted>(const State&, const Settings&)>;

std::optional<Wanted> decide_cppm(const State& state, const Settings& settings) {
    const oracle::Cells cells{settings.rings, settings.sectors};
    for (std::uint32_t rings = 1; rings <= settings.rings; ++rings) {
        const double p = oracle::constant_p_value(state.tally, {rings, settings.sectors});
        if (std::abs(p - settings.significance) < 1e-5) return std::nullopt;
    }
    const oracle::TestParameters parameters{settings.k, settings.beta, settings.significance};
    const auto d =
        oracle::cppm_update(state.tally, cells, double(state.pixel.total) + state.found, state.pixel.batch, parameters);
    return Wanted{d.area_factor, d.batch_factor, d.clear, d.clear ? 0.0 : double(state.pixel.count)};
}

std::optional<Wanted> decide_sppm(const State& state, const Settings& settings) {
    const auto u = oracle::sppm_update(state.pixel.count, state.found, settings.alpha);
    return Wanted{u.area_factor, 1.0, false, u.count};
}

std::optional<Wanted> decide_sppm_kz(const State& state, const Settings& settings) {
    const auto iteration = std::uint64_t(state.pixel.count) + 1;
    return Wanted{oracle::sppm_kz_area_factor(iteration, settings.alpha), 1.0, false, double(iteration)};
}

/// One rule an estimator.
const std::map<std::string, Rule> rules = {{"cppm", decide_cppm}, {"sppm", decide_sppm}, {"sppm-kz", decide_sppm_kz}};

/// Tested against the oracle by EstimatorUpdate and AppmUpdate of tests/statistical.
const std::set<std::string> statistical = {"appm",      "cppm-lf", "cppm-gof",  "cppm-fold",
                                           "cppm-null", "ftest",   "ftest-fold"};

State random_state(std::mt19937& random, const Settings& settings, bool whole_count) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    State state{};
    state.pixel.radius2 = float(std::pow(10.0, uniform(-9.0, 0.0)));
    state.pixel.seeded = random() % 8 > 0 ? 1 : 0;
    state.pixel.count = whole_count ? float(random() % 100000) : float(std::pow(10.0, uniform(-1.0, 5.0)));
    if (random() % 16 == 0) state.pixel.count = 0.0f;
    state.pixel.batch = 10.0f * std::pow(1.2f, float(random() % 40));
    state.pixel.total = std::uint32_t(double(state.pixel.batch) * uniform(0.0, 3.0));
    state.pixel.rejections = random() % 100;
    state.pixel.photons = random() % 100000;
    state.pixel.seen = random() % 1000;
    state.found = random() % 4 == 0 ? 0 : random() % 40;
    // Tallies of a uniform density, of rings of two densities, of a slope, of a spike; few or very many photons.
    const double mean = std::pow(10.0, uniform(-1.0, random() % 20 == 0 ? 7.5 : 3.0));
    const std::uint32_t sort = random() % 5;
    for (std::uint32_t bin = 0; bin < settings.rings * settings.sectors; ++bin) {
        const std::uint32_t ring = bin / settings.sectors, sector = bin % settings.sectors;
        double factor = 1.0;
        if (sort == 1) factor = ring + 1 == settings.rings ? 1.0 : uniform(0.5, 1.5);
        if (sort == 2) factor = 1.0 + 0.5 * std::cos(2.0 * std::numbers::pi * sector / settings.sectors);
        if (sort == 3 && bin == 3) factor = 4.0;
        if (sort == 4) factor = ring + 1 == settings.rings ? 0.6 : 1.0;
        state.tally.push_back(std::uint32_t(std::poisson_distribution<std::int64_t>(mean * factor)(random)));
    }
    if (random() % 64 == 0) std::fill(state.tally.begin(), state.tally.end(), 0);
    return state;
}

class Update : public GpuTest, public testing::WithParamInterface<std::string> {};

TEST_P(Update, DecidesAsTheReference) {
    const EstimatorRow& row = find_estimator(GetParam());
    ASSERT_TRUE(rules.contains(GetParam())) << "estimator '" << GetParam() << "' has no rule of the oracle";
    const Rule& rule = rules.at(GetParam());
    for (const auto& [rings, sectors] : {std::pair(2u, 6u), std::pair(4u, 12u)}) {
        SCOPED_TRACE(fmt::format("{} rings, {} sectors", rings, sectors));
        Settings settings;
        settings.estimator = GetParam();
        settings.size = size;
        settings.photons = 100;
        settings.rings = rings;
        settings.sectors = sectors;
        Rig rig(bare_room(0.5f), settings);
        const std::size_t pixels = rig.pixels();
        std::mt19937 random(17);
        std::vector<State> states;
        std::vector<gpu::PixelState> pixel_states;
        std::vector<gpu::Gathered> gathered;
        std::vector<gpu::HitPosition> hits;
        std::vector<std::uint32_t> tally(row.statistic == Statistic::tally ? rings * sectors * pixels : 0);
        for (std::size_t i = 0; i < pixels; ++i) {
            states.push_back(random_state(random, settings, GetParam() == "sppm-kz"));
            State& state = states.back();
            const bool diffuse = i % 16 != 0;
            if (!diffuse) state.found = 0;  // and some never saw a surface
            if (i % 32 == 0) state.pixel.radius2 = 0.0f;
            pixel_states.push_back(state.pixel);
            gathered.push_back({glm::vec3(0.0f), state.found, glm::vec3(0.0f), 0});
            hits.push_back({glm::vec3(0.0f), diffuse ? HIT_DIFFUSE : HIT_NONE});
            for (std::size_t bin = 0; !tally.empty() && bin < state.tally.size(); ++bin)
                tally[bin * pixels + i] = state.tally[bin];
        }
        rig.integrator.buffer(Binding::pixels).upload(pixel_states);
        rig.integrator.buffer(Binding::gathered).upload(gathered);
        rig.integrator.buffer(Binding::hit_position).upload(hits);
        rig.integrator.buffer(Binding::tally).upload(tally);
        rig.integrator.run_kernel(KernelId::update, pixels, {.iteration = 0, .last_round = 1});
        const auto after = rig.all<gpu::PixelState>(Binding::pixels);
        const auto tally_after = rig.all<std::uint32_t>(Binding::tally);

        std::size_t undecided = 0;
        std::map<double, std::size_t> factors;
        for (std::size_t i = 0; i < pixels; ++i) {
            const State& state = states[i];
            const gpu::PixelState& got = after[i];
            const auto line = [&] {
                return fmt::format(
                    "pixel {}: found {}, before: radius^2 {:.9g}, count {}, total {}, batch {}; tally {}", i,
                    state.found, state.pixel.radius2, state.pixel.count, state.pixel.total, state.pixel.batch,
                    testing::PrintToString(state.tally));
            };
            if (state.pixel.radius2 == 0.0f) {
                ASSERT_EQ(got.radius2, 0.0f) << line();
                ASSERT_EQ(got.total, state.pixel.total) << line();
                continue;
            }
            const auto want = rule(state, rig.settings);
            if (!want) {
                ++undecided;
                continue;
            }
            if (row.statistic == Statistic::tally) ++factors[want->area_factor];
            ASSERT_NEAR(got.radius2, state.pixel.radius2 * want->area_factor, 1e-6 * state.pixel.radius2)
                << line() << ", factor " << want->area_factor;
            ASSERT_NEAR(got.batch, state.pixel.batch * want->batch_factor, 1e-6 * got.batch) << line();
            ASSERT_NEAR(got.count, want->count, 1e-6 * want->count) << line();
            ASSERT_EQ(got.rejections, state.pixel.rejections + (want->clear ? 1 : 0)) << line();
            ASSERT_EQ(got.photons, state.pixel.photons + state.found) << line();
            ASSERT_EQ(got.seen, state.pixel.seen + (i % 16 != 0 ? 1 : 0)) << line();
            ASSERT_EQ(got.seeded, state.pixel.seeded) << line();
            if (row.statistic != Statistic::tally) continue;
            ASSERT_EQ(got.total, want->clear ? 0 : state.pixel.total + state.found) << line();
            for (std::size_t bin = 0; bin < state.tally.size(); ++bin) {
                ASSERT_EQ(tally_after[bin * pixels + i], want->clear ? 0 : state.tally[bin])
                    << line() << ", bin " << bin;
            }
        }
        EXPECT_LT(undecided, pixels / 500);
        if (row.statistic == Statistic::tally) {
            EXPECT_EQ(factors.size(), rings + 1) << "every decision: none, each inner disc, k";
            for (const auto& [factor, times] : factors) EXPECT_GT(times, 30u) << "area factor " << factor;
        }
    }
}

/// All but those that tests/statistical holds to account: a new row without a rule fails here.
std::vector<std::string> rows_tested_here() {
    std::vector<std::string> names;
    for (const EstimatorRow& row : estimators()) {
        if (!statistical.contains(std::string(row.name))) names.emplace_back(row.name);
    }
    return names;
}

INSTANTIATE_TEST_SUITE_P(Estimators, Update, testing::ValuesIn(rows_tested_here()),
                         [](const auto& info) { return identifier(info.param); });

class FilmSum : public GpuTest {
protected:
    static Settings settings(Extent extent) {
        Settings settings;
        settings.estimator = "sppm-kz";
        settings.size = extent;
        settings.photons = 100;
        return settings;
    }
};

TEST_F(FilmSum, AddsTheEstimateWithTheRadiusBeforeTheUpdate) {
    Rig rig(bare_room(0.5f), settings(size));
    std::mt19937 random(18);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto color = [&](double low, double high) {
        return glm::vec3(std::pow(10.0, uniform(low, high)), std::pow(10.0, uniform(low, high)),
                         std::pow(10.0, uniform(low, high)));
    };
    std::vector<gpu::Film> films;
    std::vector<gpu::HitPosition> hits;
    std::vector<gpu::HitWeight> weights;
    std::vector<gpu::HitEmission> emissions;
    std::vector<gpu::Gathered> gathered;
    std::vector<gpu::PixelState> states(rig.pixels());
    std::array<std::uint32_t, RADIUS_BINS> histogram{};
    for (std::size_t i = 0; i < rig.pixels(); ++i) {
        const glm::vec3 sum = color(-3.0, 6.0);
        films.push_back({sum, glm::vec3(float(uniform(-0.5, 0.5)) * sum * std::numeric_limits<float>::epsilon())});
        hits.push_back({glm::vec3(0.0f), i % 4 == 0 ? HIT_NONE : HIT_DIFFUSE});
        weights.push_back({color(-3.0, 0.0), 0});
        emissions.push_back({i % 3 == 0 ? color(-2.0, 3.0) : glm::vec3(0.0f), 0.0f});
        gathered.push_back({color(-6.0, 2.0), 9, glm::vec3(0.0f), 0});
        if (i % 1000 == 7) {
            gathered.back().flux[int(i % 3)] =
                i % 2 == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
        }
        states[i].radius2 = float(std::pow(10.0, uniform(-10.0, 0.0)));
    }
    std::uint32_t invalid = 0;
    for (std::size_t i = 0; i < rig.pixels(); ++i) {
        const glm::vec3 flux = gathered[i].flux;
        invalid +=
            hits[i].state == HIT_DIFFUSE && !(std::isfinite(flux.x) && std::isfinite(flux.y) && std::isfinite(flux.z))
                ? 1
                : 0;
    }
    rig.integrator.buffer(Binding::film).upload(films);
    rig.integrator.buffer(Binding::hit_position).upload(hits);
    rig.integrator.buffer(Binding::hit_weight).upload(weights);
    rig.integrator.buffer(Binding::hit_emission).upload(emissions);
    rig.integrator.buffer(Binding::gathered).upload(gathered);
    rig.integrator.buffer(Binding::pixels).upload(states);
    rig.integrator.run_kernel(KernelId::update, rig.pixels(), {.iteration = 0, .last_round = 1, .plans_next = 1});
    const auto after = rig.all<gpu::Film>(Binding::film);
    const auto pixels = rig.all<gpu::PixelState>(Binding::pixels);
    for (std::size_t i = 0; i < rig.pixels(); ++i) {
        const bool diffuse = hits[i].state == HIT_DIFFUSE;
        const bool finite = !diffuse || (std::isfinite(gathered[i].flux.x) && std::isfinite(gathered[i].flux.y) &&
                                         std::isfinite(gathered[i].flux.z));
        for (int c = 0; c < 3; ++c) {
            const double before = double(films[i].sum[c]) + double(films[i].low[c]);
            double estimate = emissions[i].emission[c];
            if (diffuse) {
                estimate += double(weights[i].weight[c]) * gathered[i].flux[c] /
                            (std::numbers::pi * double(states[i].radius2) * *rig.settings.photons);
            }
            if (!finite) estimate = 0.0;
            // The estimate is a product of floats; the sum adds two roundings of the low part.
            ASSERT_NEAR(double(after[i].sum[c]) + double(after[i].low[c]), before + estimate,
                        1e-6 * estimate + 1e-13 * (before + estimate))
                << "pixel " << i << " channel " << c << ": " << before << " + " << estimate;
        }
        if (diffuse)
            ++histogram[std::clamp(int(std::floor(std::log2(double(pixels[i].radius2)))) + 48, 0, RADIUS_BINS - 1)];
    }
    const gpu::Status status = rig.status();
    EXPECT_GT(invalid, 50u);
    EXPECT_EQ(status.invalid, invalid) << "contributions that are not finite";
    std::uint32_t misplaced = 0;
    for (int bin = 0; bin < RADIUS_BINS; ++bin)
        misplaced += std::uint32_t(std::abs(std::int64_t(status.radius_histogram[bin]) - std::int64_t(histogram[bin])));
    EXPECT_LE(misplaced, 10u) << "radii in other bins of the histogram; a few may lie on a boundary";
}

TEST_F(FilmSum, ManyAdditionsDoNotStagnate) {
    // Two floats err by at most 2^-47 of the sum in an addition; a million of them then by 1e-8.
    constexpr double error_of_one = 0x1p-47;
    // One pixel each: constant, small after a large one, smaller still, tiny.
    const std::vector<float> first = {0.1f, 1e6f, 3.3333333f, 1e-3f}, then = {0.1f, 0.1f, 1e-4f, 1e-3f};
    constexpr std::uint64_t additions = 50000, burst = 10000;
    const std::uint32_t count = std::uint32_t(first.size());
    gpu::Params params{};
    params.width = count;
    params.height = 1;
    params.photons = 1;
    params.inverse_paths = 1.0f;
    params.alpha = 0.5f;
    Buffer parameters(plain_device(), Binding::params, sizeof(params));
    parameters.upload_value(params);
    Bindings bindings(plain_device());
    bindings.bind(Binding::params, parameters);
    std::map<Binding, Buffer> buffers;
    for (const Binding binding : {Binding::status, Binding::quantiles, Binding::hit_position, Binding::hit_weight,
                                  Binding::hit_emission, Binding::gathered, Binding::pixels, Binding::tally,
                                  Binding::moments, Binding::film, Binding::eye_paths, Binding::errors}) {
        bindings.bind(binding, buffers.emplace(binding, Buffer(plain_device(), binding, 4096)).first->second);
    }
    Buffer& emission = buffers.at(Binding::hit_emission);
    const auto set = [&](const std::vector<float>& values) {
        std::vector<gpu::HitEmission> records;
        for (const float value : values) records.push_back({glm::vec3(value, 2.0f * value, 0.7f * value), 0.0f});
        emission.upload(records);
    };
    const Kernel kernel(plain_device(), "update", words_of(KernelId::update, "sppm"),
                        {{SPEC_WORKGROUP, 64}, {SPEC_RINGS, 2}, {SPEC_SECTORS, 6}});
    Commands commands(plain_device(), bindings);
    const auto run = [&](std::uint64_t launches) {
        commands.begin();
        const gpu::Launch push{.iteration = 0, .last_round = 1, .pixels = count};
        for (std::uint64_t i = 0; i < launches; ++i) commands.launch(kernel, count, push);
        const std::vector<Timing> timings = commands.finish();
        EXPECT_EQ(timings.size(), launches) << "every launch is timed";
        for (const Timing& timing : timings) ASSERT_TRUE(timing.seconds >= 0.0 && timing.seconds < 60.0);
    };
    set(first);
    run(1);
    set(then);
    for (std::uint64_t done = 1; done < additions; done += burst) run(std::min(burst, additions - done));
    const auto films = buffers.at(Binding::film).download<gpu::Film>(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c) {
            const float factor = c == 0 ? 1.0f : c == 1 ? 2.0f : 0.7f;
            const double want = double(factor * first[i]) + double(additions - 1) * double(factor * then[i]);
            const double got = double(films[i].sum[c]) + double(films[i].low[c]);
            EXPECT_NEAR(got, want, additions * error_of_one * want)
                << "pixel " << i << " channel " << c << ", sum " << films[i].sum[c] << ", low " << films[i].low[c];
        }
    }
}

TEST_F(FilmSum, ThePictureIsTheMeanOverCompletedIterations) {
    Rig rig(room(), settings({16, 16}));
    EXPECT_EQ(rig.integrator.completed(), 0u);
    for (const glm::vec3& value : rig.integrator.resolve().rgb) EXPECT_EQ(value, glm::vec3(0.0f));
    rig.integrator.run(3);
    EXPECT_EQ(rig.integrator.completed(), 3u);
    EXPECT_EQ(rig.status().completed, 3u);
    const Image image = rig.integrator.resolve();
    const auto films = rig.all<gpu::Film>(Binding::film);
    double total = 0.0;
    for (std::size_t i = 0; i < rig.pixels(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double want = (double(films[i].sum[c]) + double(films[i].low[c])) / 3.0;
            ASSERT_NEAR(image.rgb[i][c], want, 2e-7 * want) << "pixel " << i << " channel " << c;
            total += want;
        }
    }
    EXPECT_GT(total, 0.0);
}

}  // namespace
}  // namespace vkcppm::test
