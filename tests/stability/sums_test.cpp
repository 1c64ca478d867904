// A million iterations, and counters at their end. Sums stand where 980,000 iterations would have left them; the last
// 20,000 run.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <boost/math/special_functions/gamma.hpp>
#include <fmt/format.h>

#include "core/error.h"
#include "oracle/estimator.h"
#include "render/estimators.h"
#include "shared/estimators.h"
#include "stability/table.h"
#include "support/device/rig.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t before = 980000, launches = 20000;

/// One pixel after another that gathers, of a scene that does not matter.
class Sums : public GpuTest {
protected:
    static constexpr Extent size{4, 1};

    static Rig rig_of(const std::string& estimator, bool aovs = false) {
        Settings settings;
        settings.estimator = estimator;
        settings.size = size;
        settings.photons = 64;
        settings.aovs = aovs;
        return Rig(bare_room(0.3f), settings, plain_device());
    }

    /// Every pixel has a diffuse surface, so much light without photons, and so many photons, each of no flux.
    static void set(Rig& rig, float emission, std::uint32_t found) {
        const std::size_t n = rig.pixels();
        rig.integrator.buffer(Binding::hit_position)
            .upload(std::vector<gpu::HitPosition>(n, {glm::vec3(0.0f), HIT_DIFFUSE}));
        rig.integrator.buffer(Binding::hit_weight).upload(std::vector<gpu::HitWeight>(n, {glm::vec3(1.0f), 0}));
        rig.integrator.buffer(Binding::hit_emission)
            .upload(std::vector<gpu::HitEmission>(n, {glm::vec3(emission), 0.0f}));
        rig.integrator.buffer(Binding::gathered)
            .upload(std::vector<gpu::Gathered>(n, {glm::vec3(0.0f), found, glm::vec3(0.0f), 0}));
    }

    static void set_state(Rig& rig, const gpu::PixelState& state) {
        rig.integrator.buffer(Binding::pixels).upload(std::vector<gpu::PixelState>(rig.pixels(), state));
    }
    static gpu::PixelState state_of(Rig& rig) { return rig.all<gpu::PixelState>(Binding::pixels).at(0); }

    static void update(Rig& rig, std::uint32_t times = 1) {
        for (std::uint32_t i = 0; i < times; ++i) {
            rig.integrator.run_kernel(KernelId::update, rig.pixels(), {.iteration = 0, .last_round = 1});
        }
    }

    /// So many photons an iteration over a disc of R^2 = first_radius2 with that count, for all launches.
    static constexpr float first_radius2 = 1e-3f;
    static void run_schedule(Rig& rig, std::uint32_t found, float count) {
        set(rig, 0.0f, found);
        gpu::PixelState state{};
        state.radius2 = first_radius2;
        state.seeded = 1;
        state.count = count;
        set_state(rig, state);
        update(rig, launches);
    }
};

// As a plain sum of floats: 6.2e-4.
TEST_F(Sums, TheFilm) {
    Rig rig = rig_of("cppm-null");
    constexpr float each = 1.0f / 3.0f;
    set(rig, each, 0);
    gpu::PixelState state{};
    state.radius2 = 1e-3f;
    state.seeded = 1;
    set_state(rig, state);
    const double start = double(before) * double(each);
    const float sum = float(start);
    rig.integrator.buffer(Binding::film)
        .upload(std::vector<gpu::Film>(rig.pixels(), {glm::vec3(sum), glm::vec3(float(start - double(sum)))}));
    update(rig, launches);
    const gpu::Film film = rig.all<gpu::Film>(Binding::film).at(0);
    const double want = double(before + launches) * double(each);
    expect_error("film after 10^6 iterations, against doubles",
                 std::abs((double(film.sum.x) + double(film.low.x)) / want - 1.0), 1e-9);
}

// Sums of one float each: 1.3e-4.
TEST_F(Sums, TheAovs) {
    Rig rig = rig_of("cppm", true);
    rig.integrator.run(1);
    const auto easy = rig.integrator.aovs();
    auto sums = rig.all<gpu::Aovs>(Binding::aovs);
    for (gpu::Aovs& sum : sums) {
        ASSERT_EQ(sum.hits, 1u);
        for (int c = 0; c < 3; ++c) {
            const double albedo = double(before) * double(sum.albedo[c]),
                         normal = double(before) * double(sum.normal[c]);
            sum.albedo[c] = float(albedo);
            sum.albedo_low[c] = float(albedo - double(sum.albedo[c]));
            sum.normal[c] = float(normal);
            sum.normal_low[c] = float(normal - double(sum.normal[c]));
        }
        sum.hits = before;
    }
    rig.integrator.buffer(Binding::aovs).upload(sums);
    for (std::uint32_t i = 0; i < launches / 2; ++i) {
        rig.integrator.run_kernel(KernelId::eye, rig.pixels(), {.iteration = 1, .last_round = 1});
    }
    const auto hard = rig.integrator.aovs();
    double error = 0.0;
    for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B"}) {
        for (std::size_t i = 0; i < rig.pixels(); ++i) {
            error = std::max(error, std::abs(double(hard.at(name)[i]) - double(easy.at(name)[i])));
        }
    }
    expect_error("albedo after 10^6 iterations", error, 1e-6);
}

// R^2 in one float: 0.041.
TEST_F(Sums, TheScheduleOfKnausAndZwicker) {
    Rig rig = rig_of("sppm-kz");
    run_schedule(rig, 10, float(before));
    // R_n^2 = R_1^2 Gamma(n + alpha) / (Gamma(1 + alpha) Gamma(n + 1)), n iterations done.
    const double alpha = double(rig.integrator.params().alpha);
    const auto log_radius2 = [&](double n) {
        return -std::log(boost::math::tgamma_delta_ratio(n + 1.0 + alpha, 1.0 - alpha));
    };
    const double want = -(log_radius2(before + launches) - log_radius2(before));
    const double got = std::log(double(state_of(rig).radius2) / first_radius2);
    expect_error("shrinkage of sppm-kz about iteration 10^6", std::abs(got / want - 1.0), 1e-4);
}

// N and R^2 in one float each: 1 and 1, neither moves.
TEST_F(Sums, TheScheduleOfHachisukaAndJensen) {
    Rig rig = rig_of("sppm");
    constexpr float counted = 33554432.0f;
    run_schedule(rig, 1, counted);
    double n = counted, log_radius2 = 0.0;
    for (std::uint32_t i = 0; i < launches; ++i) {
        const auto step = oracle::sppm_update(n, 1.0, double(rig.integrator.params().alpha));
        log_radius2 += std::log(step.area_factor);
        n = step.count;
    }
    const gpu::PixelState after = state_of(rig);
    expect_error("photons that sppm has counted after 2^25",
                 std::abs((double(after.count) + double(after.count_low) - counted) / (n - counted) - 1.0), 1e-4);
    expect_error("shrinkage of sppm after 2^25 photons",
                 std::abs(std::log(double(after.radius2) / first_radius2) / log_radius2 - 1.0), 1e-3);
}

// Means and squares in one float each: 0.056 and 1.
TEST_F(Sums, TheVarianceOfTheFTest) {
    Rig rig = rig_of("ftest");
    set(rig, 0.0f, 0);
    const std::size_t n = rig.pixels(), cells = rig.settings.rings * rig.settings.sectors, rings = rig.settings.rings;
    const double samples = before, mean = 1.0, squares = samples * double(rig.settings.sectors);
    std::vector<float> moments((3 * cells + 2 * rings) * n, 0.0f);
    for (std::size_t i = 0; i < cells * n; ++i) moments[cells * n + i] = float(mean);
    for (std::size_t i = 0; i < rings * n; ++i) moments[2 * cells * n + i] = float(squares);
    gpu::PixelState state{};
    state.radius2 = 1e-3f;
    state.seeded = 1;
    state.count = float(before);
    state.batch = 1e30f;
    set_state(rig, state);
    // Every sample a quarter above the mean: too little to show in a sum of 5.9e6, and so is its share of the mean.
    const double x = 1.25;
    double want_mean = mean, want_squares = squares, count = samples;
    std::vector<float> now(cells * n, float(x));
    constexpr std::uint32_t times = launches / 2;
    for (std::uint32_t i = 0; i < times; ++i) {
        std::copy(now.begin(), now.end(), moments.begin());
        if (i == 0) {
            rig.integrator.buffer(Binding::moments).upload(moments);
        } else {
            rig.integrator.buffer(Binding::moments).upload(now);
        }
        update(rig);
        count += 1.0;
        const double next = want_mean + (x - want_mean) / count;
        want_squares += double(rig.settings.sectors) * (x - want_mean) * (x - next);
        want_mean = next;
    }
    const auto after = rig.all<float>(Binding::moments);
    expect_error("mean of a cell of the F-test about sample 10^6",
                 std::abs((double(after[cells * n]) - mean) / (want_mean - mean) - 1.0), 1e-3);
    expect_error("squares of the F-test about sample 10^6",
                 std::abs((double(after[2 * cells * n]) - squares) / (want_squares - squares) - 1.0), 1e-3);
}

// The textbook form sum(O^2) c / S - S in floats: 73 and 280.
TEST_F(Sums, ChiSquared) {
    constexpr std::uint32_t states = 4096;
    for (const char* estimator : {"cppm", "cppm-fold"}) {
        Settings settings;
        settings.estimator = estimator;
        settings.size = Extent{states, 1};
        settings.photons = 64;
        Rig rig(bare_room(0.5f), settings, plain_device());
        const std::uint32_t cells = std::string(estimator) == "cppm" ? 12 : 6;
        std::mt19937 random(11);
        std::vector<std::uint32_t> tally(cells * states);
        std::vector<double> want(states);
        std::vector<gpu::PixelState> pixels(states);
        for (std::uint32_t i = 0; i < states; ++i) {
            const double mean = std::pow(10.0, 9.6 * double(i) / states) / cells;  // sums from 1 to 4e9
            double sum = 0.0, statistic = 0.0;
            for (std::uint32_t cell = 0; cell < cells; ++cell) {
                tally[cell * states + i] = std::uint32_t(std::poisson_distribution<std::int64_t>(mean)(random));
                sum += tally[cell * states + i];
            }
            for (std::uint32_t cell = 0; cell < cells && sum > 0.0; ++cell) {
                const double expected = sum / cells, off = double(tally[cell * states + i]) - expected;
                statistic += off * off / expected;
            }
            want[i] = statistic;
            pixels[i].radius2 = 1e-3f;
            pixels[i].seeded = 1;
        }
        set(rig, 0.0f, 0);
        rig.integrator.buffer(Binding::tally).upload(tally);
        rig.integrator.buffer(Binding::pixels).upload(pixels);
        const double threshold = double(rig.integrator.params().threshold[rig.settings.rings - 1]);
        update(rig);
        const auto after = rig.all<gpu::PixelState>(Binding::pixels);
        double error = 0.0;
        for (std::uint32_t i = 0; i < states; ++i) {
            error =
                std::max(error, std::abs(double(after[i].statistic) * threshold - want[i]) / std::max(want[i], 1.0));
        }
        expect_error(fmt::format("chi-squared of sums from 1 to 4e9, {}", estimator), error, 1e-5);
    }
}

// Counters that wrap: `photons` at 119,999,704 and rays of 2^32 lost; a tally that is never full holds 8.6e9 photons,
// its next iterations beyond 2^32.
TEST_F(Sums, CountersNearTheirEnd) {
    Rig rig = rig_of("cppm");
    const std::size_t n = rig.pixels(), cells = rig.settings.rings * rig.settings.sectors;
    set(rig, 0.0f, 120000000);
    gpu::PixelState state{};
    state.radius2 = 1e-3f;
    state.seeded = 1;
    state.batch = 10.0f;
    state.total = 2040000000;
    state.photons = 4294967000u;
    set_state(rig, state);
    rig.integrator.buffer(Binding::tally).upload(std::vector<std::uint32_t>(cells * n, 2160000000u / 12));
    update(rig);
    gpu::PixelState after = state_of(rig);
    EXPECT_EQ(after.photons, 0xffffffffu) << "photons accepted in all stay at their largest number";
    EXPECT_EQ(after.radius2, 1e-3f) << "the disc is even";
    EXPECT_EQ(after.rejections, 0u);
    EXPECT_EQ(after.total, 0u) << "a full tally starts again";
    const auto tally = rig.all<std::uint32_t>(Binding::tally);
    expect_error("photons left in a tally that starts again", std::accumulate(tally.begin(), tally.end(), 0.0), 0.0);

    // An uneven disc is still found out with as many.
    state.total = 4100000000u;
    state.batch = 1e30f;
    set_state(rig, state);
    std::vector<std::uint32_t> uneven(cells * n, 4200000000u / 12);
    for (std::size_t i = 0; i < n; ++i) uneven[i] += 1000000;
    rig.integrator.buffer(Binding::tally).upload(uneven);
    update(rig);
    after = state_of(rig);
    EXPECT_EQ(after.rejections, 1u) << "a batch beyond all counters is full when they are";
    EXPECT_EQ(after.total, 0u);

    // Rays of one submission.
    gpu::Status status = rig.status();
    status.rays = 0xfffffff0u;
    rig.integrator.buffer(Binding::status).upload_value(status);
    rig.integrator.run(20);
    const Report report = rig.report();
    expect_error("rays lost past 2^32", report.rays >= 4294967296u && report.rays < 4295067296u ? 0.0 : 1.0, 0.0);

    // Beyond 2^30 - 1 iterations random numbers would repeat.
    Settings settings;
    settings.iterations = 1u << 30;
    EXPECT_THROW(resolve_settings(settings, bare_room(0.5f)), Error);
}

}  // namespace
}  // namespace vkcppm::test
