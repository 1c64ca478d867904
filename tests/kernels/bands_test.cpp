// A picture does not depend on how many bands it is gone through in: the same bits for every estimator, in the hash of
// every pass, with small step budgets, and where a checkpoint was written with another number of bands.

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/estimators.h"
#include "render/path_tracer.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/names.h"
#include "support/scenes/rooms.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint64_t third = 150;  // pixels of a band: three of 136
constexpr std::uint32_t iterations = 6;

Settings settings_of(const std::string& estimator) { return settings_with_all(estimator, {24, 17}, 800); }

void expect_same(Rig& whole, Rig& cut, const std::string& what) {
    expect_same_state(cut, whole, what);
    EXPECT_EQ(cut.integrator.aovs(), whole.integrator.aovs()) << what;
    EXPECT_EQ(cut.integrator.radii(), whole.integrator.radii()) << what;
    EXPECT_GT(cut.integrator.disc_width(), 0.0) << what;  // of the last band
    expect_same_picture(cut.integrator.resolve(), whole.integrator.resolve(), what);
    EXPECT_EQ(cut.report().stored_photons, whole.report().stored_photons) << what;
}

class Bands : public GpuTest, public testing::WithParamInterface<std::string> {};

TEST_P(Bands, GiveTheSameBits) {
    Rig whole(room(), settings_of(GetParam()), plain_device());
    Rig cut(room(), settings_of(GetParam()), plain_device(), third);
    whole.integrator.run(iterations);
    cut.integrator.run(iterations);
    expect_same(whole, cut, "three bands");
    EXPECT_EQ(cut.report().rays, whole.report().rays);
}

TEST_P(Bands, GiveTheSameBitsWithSmallStepBudgets) {
    Rig whole(room(), settings_of(GetParam()), plain_device());
    Rig cut(room(), settings_of(GetParam()), plain_device(), third);
    gpu::Params params = cut.integrator.params();
    params.step_budget = 150;
    params.photon_capacity = 3;
    cut.integrator.set_params(params);
    whole.integrator.run(iterations);
    cut.integrator.run(iterations);
    expect_same(whole, cut, "three bands, a budget of 150 steps, 3 photons a lane to begin with");
}

TEST_P(Bands, GoOnFromACheckpointOfAnotherNumberOfThem) {
    for (const auto& [before, after] : {std::pair(std::uint64_t(0), third), std::pair(third, std::uint64_t(100))}) {
        const std::string what = fmt::format("bands of {} pixels at most, then of {}; 0: one band", before, after);
        Rig whole(room(), settings_of(GetParam()), plain_device());
        Rig first(room(), settings_of(GetParam()), plain_device(), before);
        Rig second(room(), settings_of(GetParam()), plain_device(), after);
        whole.integrator.run(iterations);
        first.integrator.run(3);
        second.integrator.restore(first.report(), first.integrator.save());
        second.integrator.run(iterations - 3);
        expect_same(whole, second, what);
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, Bands, testing::ValuesIn(all_estimators()),
                         [](const auto& info) { return identifier(info.param); });

class BandsOfAPicture : public GpuTest {};

TEST_F(BandsOfAPicture, LeaveTheHashOfEveryPassAsItIs) {
    for (const Case& change : material_cases()) {
        Scene scene = make_room();
        Settings settings = settings_of("cppm");
        change.change(scene, settings);
        settings.size = Extent{24, 17};
        Rig whole(scene, settings, plain_device()), cut(scene, settings, plain_device(), third);
        for (int i = 0; i < 2; ++i) {
            const auto wanted = whole.integrator.run_hashed(), got = cut.integrator.run_hashed();
            ASSERT_EQ(got.size(), wanted.size());
            for (std::size_t pass = 0; pass < got.size(); ++pass) {
                EXPECT_EQ(got[pass].pass, wanted[pass].pass);
                EXPECT_EQ(got[pass].hash, wanted[pass].hash) << change.name << ", pass " << got[pass].pass;
            }
        }
    }
}

// Discs of so many sizes that the grid has several levels: the plan is made from histograms of all bands.
TEST_F(BandsOfAPicture, ShareTheGridOfPhotons) {
    Settings settings = settings_of("cppm");
    settings.size = Extent{96, 80};
    Rig whole(room(), settings, plain_device()), cut(room(), settings, plain_device(), 2000);
    whole.integrator.run(20);
    cut.integrator.run(20);
    expect_same(whole, cut, "four bands of 96x80");
}

TEST_F(BandsOfAPicture, TheLastMayBeSmaller) {
    for (const std::uint64_t most : {1u, 7u, 407u}) {
        Settings settings = settings_of("cppm");
        Rig whole(room(), settings, plain_device()), cut(room(), settings, plain_device(), most);
        whole.integrator.run(2);
        cut.integrator.run(2);
        expect_same(whole, cut, fmt::format("bands of {} pixels at most", most));
    }
}

TEST_F(BandsOfAPicture, OfThePathTracerGiveTheSameBits) {
    Settings settings = settings_of("cppm");
    settings.aovs = false;
    Rig rig(room(), settings, plain_device());
    using Light = PathTracer::Light;
    PathTracer whole(rig.on_device, rig.scene.cameras.at(0), rig.settings, Light::all);
    PathTracer cut(rig.on_device, rig.scene.cameras.at(0), rig.settings, Light::all, third);
    for (int i = 0; i < 2; ++i) {
        expect_same_picture(cut.trace(), whole.trace(), "three bands");
        EXPECT_EQ(cut.rays(), whole.rays());
    }
}

}  // namespace
}  // namespace vkcppm::test
