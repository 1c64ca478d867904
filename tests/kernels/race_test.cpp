// A race is fair: what its entrants share is the same to the last bit, and it can be run again.

#include "study/race.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/metrics.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/scenes.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using test::Rig;

Settings small(const std::string& estimator) {
    Settings settings;
    settings.estimator = estimator;
    settings.size = Extent{24, 18};
    settings.photons = 2000;
    settings.iterations = 5;
    settings.seed = 3;
    return settings;
}

RaceSettings race_of(const std::vector<std::string>& estimators) {
    RaceSettings race;
    for (const std::string& estimator : estimators) race.entrants.push_back({estimator, small(estimator)});
    return race;
}

Image black() { return {{24, 18}, std::vector<glm::vec3>(24 * 18, glm::vec3(0.0f))}; }

bool go_on(const RaceProgress&) { return true; }

class Race : public test::GpuTest {};

TEST_F(Race, SeedsGiveAllEstimatorsTheSamePhotonsAndFirstRadii) {
    std::vector<float> nearest;          // [knn x pixels] squared distances of the photons that give the first radius
    std::vector<std::uint32_t> photons;  // of the fifth iteration, in the order of the paths: places, directions, power
    for (const char* name : {"cppm", "sppm", "sppm-kz", "appm", "ftest", "cppm-fold"}) {
        SCOPED_TRACE(name);
        Rig rig(test::project_scene("torus"), small(name), test::plain_device());
        rig.integrator.run(1);
        const std::vector<float> found = rig.all<float>(Binding::nearest);
        rig.integrator.run(4);
        std::vector<std::uint32_t> stored = rig.all<std::uint32_t>(Binding::photons);
        const std::vector<std::uint32_t> flux = rig.all<std::uint32_t>(Binding::photon_flux);
        stored.insert(stored.end(), flux.begin(), flux.end());
        if (photons.empty()) {
            nearest = found;
            photons = stored;
            ASSERT_GT(std::ranges::count_if(photons, [](std::uint32_t word) { return word != 0; }), 5000);
            ASSERT_GT(*std::ranges::max_element(nearest), 0.0f);
        }
        EXPECT_EQ(found, nearest);
        EXPECT_TRUE(stored == photons) << "photons of the fifth iteration";
    }
}

TEST_F(Race, AfterOneIterationThoseWithTheSameKernelAgreeToTheLastBit) {
    RaceSettings race = race_of({"cppm", "sppm", "cppm-lf", "ftest"});  // appm weighs photons by a kernel of its own
    for (Entrant& entrant : race.entrants) entrant.settings.iterations = 1;
    const Scene scene = test::project_scene("torus");
    const RaceResult result = run_race(scene, resolve_race(race, scene), black(), test::plain_device(), go_on);
    for (const RaceRun& run : result.runs) {
        test::expect_same_picture(run.image, result.runs.front().image, run.entrant.name);
        EXPECT_GT(run.curves[0].back().error.mse.all, 0.0) << "a black picture would agree with anything";
    }
}

TEST_F(Race, EntrantsAreWhatTheyAreAlone) {
    const Scene scene = test::project_scene("torus");
    const RaceSettings race = resolve_race(race_of({"cppm", "appm", "sppm"}), scene);
    const RaceResult result = run_race(scene, race, black(), test::device(), go_on);
    EXPECT_EQ(result.baseline, 2u);
    EXPECT_EQ(result.seeds, std::vector<std::uint32_t>{3});
    for (const RaceRun& run : result.runs) {
        Rig alone(test::project_scene("torus"), run.entrant.settings);
        alone.integrator.run(5);
        test::expect_same_picture(run.image, alone.integrator.resolve(), run.entrant.name);
        EXPECT_EQ(run.radius, alone.integrator.radii()) << run.entrant.name;
        const Curve& curve = run.curves.at(0);
        ASSERT_EQ(curve.size(), 4u) << "after 1, 2, 4 and, the end, 5 iterations";
        EXPECT_EQ(curve.back().iterations, 5u);
        double sum = 0.0;  // against black the squared error is the picture's square
        for (const glm::vec3& pixel : run.image.rgb) sum += glm::dot(glm::dvec3(pixel), glm::dvec3(pixel)) / 3.0;
        EXPECT_NEAR(curve.back().error.mse.all, sum / double(run.image.rgb.size()), 1e-12 * sum);
        double squared = 0.0;
        for (const double error : run.squared_error) squared += error;
        EXPECT_NEAR(squared, sum, 1e-12 * sum);
        for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_GT(curve[i].seconds, curve[i - 1].seconds);
    }
}

TEST_F(Race, TwiceGivesTheSameCurvesToTheLastBit) {
    const Scene scene = test::project_scene("caustic");
    RaceSettings race = race_of({"cppm", "appm"});
    race.seeds = 2;
    race = resolve_race(race, scene);
    const RaceResult a = run_race(scene, race, black(), test::plain_device(), go_on);
    const RaceResult b = run_race(scene, race, black(), test::plain_device(), go_on);
    ASSERT_EQ(a.seeds, (std::vector<std::uint32_t>{3, 4}));
    for (std::size_t e = 0; e < 2; ++e) {
        for (std::size_t s = 0; s < 2; ++s) {
            const Curve &first = a.runs[e].curves[s], &second = b.runs[e].curves[s];
            ASSERT_EQ(first.size(), second.size());
            for (std::size_t i = 0; i < first.size(); ++i) {
                EXPECT_EQ(first[i].iterations, second[i].iterations);
                for (const Metric& metric : metrics()) {
                    EXPECT_EQ(metric.of(first[i].error), metric.of(second[i].error)) << metric.name;
                }
            }
        }
        EXPECT_NE(a.runs[e].curves[0].back().error.mse.all, a.runs[e].curves[1].back().error.mse.all) << "two seeds";
        EXPECT_EQ(a.runs[e].squared_error, b.runs[e].squared_error);
    }
}

// Against black every snapshot has an error: an entrant ends with the first that is at or below the bound.
TEST_F(Race, AnEntrantEndsWhereItIsNearEnough) {
    const Scene scene = test::project_scene("torus");
    RaceSettings race = race_of({"cppm", "sppm"});
    const RaceResult whole = run_race(scene, resolve_race(race, scene), black(), test::device(), go_on);
    const Metric& metric = find_metric("", "mse");
    const Curve& curve = whole.runs[0].curves[0];
    // The error after two iterations: who is at or below it ends at the first such point.
    race.stop_at = StopAt{&metric, metric.of(curve.at(1).error)};
    const RaceResult result = run_race(scene, resolve_race(race, scene), black(), test::device(), go_on);
    for (std::size_t e = 0; e < 2; ++e) {
        const Curve &all = whole.runs[e].curves[0], &until = result.runs[e].curves[0];
        const auto end = std::ranges::find_if(
            all, [&](const CurvePoint& point) { return metric.of(point.error) <= race.stop_at->value; });
        const std::uint64_t last = end == all.end() ? all.back().iterations : end->iterations;
        EXPECT_EQ(until.back().iterations, last) << race.entrants[e].name;
        EXPECT_EQ(reached(*race.stop_at, until), end != all.end());
        EXPECT_EQ(result.runs[e].reports[0].iterations, last);
    }
    EXPECT_LE(result.runs[0].curves[0].back().iterations, 2u);
}

// What was kept of a shorter race with one seed becomes a longer one with two.
TEST_F(Race, GoesOnFromWhatWasKeptToTheLastBit) {
    const Scene scene = test::project_scene("torus");
    std::map<std::string, Checkpoint> kept;
    const auto name = [](const Entrant& entrant) { return fmt::format("{} {}", entrant.name, entrant.settings.seed); };
    RaceStates states;
    states.keep = [&](const Entrant& entrant, const Checkpoint& state) { kept[name(entrant)] = state; };
    RaceSettings race = race_of({"cppm", "sppm"});
    run_race(scene, resolve_race(race, scene), black(), test::device(), go_on, states);
    EXPECT_EQ(kept.size(), 2u);
    for (Entrant& entrant : race.entrants) entrant.settings.iterations = 9;
    race.seeds = 2;
    const RaceResult whole = run_race(scene, resolve_race(race, scene), black(), test::device(), go_on);
    int found = 0;
    states.find = [&](const Entrant& entrant) -> std::optional<Checkpoint> {
        if (!kept.contains(name(entrant))) return std::nullopt;
        ++found;
        return kept[name(entrant)];
    };
    const RaceResult result = run_race(scene, resolve_race(race, scene), black(), test::device(), go_on, states);
    EXPECT_EQ(found, 2) << "the second seed begins";
    EXPECT_EQ(kept.size(), 4u);
    EXPECT_EQ(result.seeds, (std::vector<std::uint32_t>{3, 4}));
    for (std::size_t e = 0; e < result.runs.size(); ++e) {
        const RaceRun &run = result.runs[e], &same = whole.runs[e];
        test::expect_same_picture(run.image, same.image, run.entrant.name);
        EXPECT_EQ(run.radius, same.radius);
        EXPECT_EQ(run.squared_error, same.squared_error);
        for (std::size_t s = 0; s < 2; ++s) {
            EXPECT_EQ(run.curves[s].back().iterations, 9u);
            EXPECT_EQ(run.curves[s].back().error.mse.all, same.curves[s].back().error.mse.all);
            EXPECT_EQ(run.reports[s].emitted_paths, same.reports[s].emitted_paths);
            EXPECT_TRUE(std::ranges::is_sorted(run.curves[s], {}, &CurvePoint::iterations));
        }
    }
}

TEST_F(Race, TurnsGoToWhoeverIsBehind) {
    const Scene scene = test::project_scene("torus");
    const RaceSettings race = resolve_race(race_of({"cppm", "sppm"}), scene);
    std::vector<std::size_t> snapshots[2];
    run_race(scene, race, black(), test::plain_device(), [&](const RaceProgress& progress) {
        for (int e = 0; e < 2; ++e) snapshots[e].push_back(progress.runs[std::size_t(e)].curves.back().size());
        EXPECT_GE(progress.done, 0.1);
        EXPECT_LE(progress.done, 1.0);
        return true;
    });
    for (std::size_t i = 0; i < snapshots[0].size(); ++i) {
        EXPECT_LE(snapshots[0][i] - snapshots[1][i] + 1, 2u) << "after turn " << i << " no more than one apart";
    }
}

TEST_F(Race, CutShortItKeepsAPictureOfEveryone) {
    const Scene scene = test::project_scene("torus");
    RaceSettings race = race_of({"cppm", "sppm", "appm"});
    race.seeds = 2;
    race = resolve_race(race, scene);
    const auto stop = [](const RaceProgress&) { return false; };
    const RaceResult at_once = run_race(scene, race, black(), test::plain_device(), stop);
    EXPECT_TRUE(at_once.interrupted);
    EXPECT_EQ(at_once.seeds, std::vector<std::uint32_t>{3});
    for (const RaceRun& run : at_once.runs) {
        ASSERT_EQ(run.curves.size(), 1u);
        EXPECT_EQ(run.curves[0].back().iterations, 1u) << run.entrant.name;
        EXPECT_EQ(run.image.rgb.size(), 24u * 18u);
    }
    const auto first_seed = [](const RaceProgress& progress) { return progress.seed == 0; };
    const RaceResult later = run_race(scene, race, black(), test::plain_device(), first_seed);
    EXPECT_TRUE(later.interrupted);
    EXPECT_EQ(later.seeds, std::vector<std::uint32_t>{3}) << "the second seed was not complete";
    for (const RaceRun& run : later.runs) {
        ASSERT_EQ(run.curves.size(), 1u);
        EXPECT_EQ(run.curves[0].back().iterations, 5u) << run.entrant.name;
        EXPECT_EQ(run.reports.size(), 1u);
    }
}

TEST_F(Race, TimeEndsEveryEntrantInTheIterationInWhichItPasses) {
    const Scene scene = test::project_scene("torus");
    RaceSettings race = race_of({"cppm", "sppm"});
    for (Entrant& entrant : race.entrants) {
        entrant.settings.iterations = 1000000;
        entrant.settings.seconds = 0.3;
    }
    const RaceResult result = run_race(scene, resolve_race(race, scene), black(), test::plain_device(), go_on);
    for (const RaceRun& run : result.runs) {
        const Curve& curve = run.curves[0];
        EXPECT_GE(curve.back().seconds, 0.3) << run.entrant.name;
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) EXPECT_LT(curve[i].seconds, 0.3) << run.entrant.name;
    }
}

TEST_F(Race, SettingsAreRefusedWithTheEntrant) {
    const Scene scene = test::project_scene("torus");
    RaceSettings race = race_of({"cppm", "sppm"});
    race.entrants[1].name = "sppm:alpha=2";
    race.entrants[1].settings.alpha = 2.0;
    const auto range = test::thrown_by([&] { resolve_race(race, scene); });
    ASSERT_TRUE(range);
    EXPECT_EQ(range->code(), ExitCode::usage);
    EXPECT_EQ(std::string(range->what()), "--alpha 2 is not between 0 and 1 (entrant 'sppm:alpha=2')");
    const auto twice = test::thrown_by([&] { resolve_race(race_of({"cppm", "sppm", "cppm"}), scene); });
    ASSERT_TRUE(twice);
    EXPECT_NE(std::string(twice->what()).find("'cppm' stands there twice"), std::string::npos) << twice->what();
}

TEST_F(Race, WhatDoesNotFitTheDeviceTogetherIsToldWithTheEntrant) {
    const Scene scene = test::project_scene("torus");
    RaceSettings race = race_of({"cppm", "sppm"});
    race.entrants[1].settings.size = Extent{65536, 32768};
    const auto error =
        test::thrown_by([&] { run_race(scene, resolve_race(race, scene), black(), test::plain_device(), go_on); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::out_of_device_memory);
    for (const char* told : {"entrant 'sppm'", "the render needs ", "hold", "bytes"}) {
        EXPECT_NE(std::string(error->what()).find(told), std::string::npos) << error->what();
    }
}

}  // namespace
}  // namespace vkcppm
