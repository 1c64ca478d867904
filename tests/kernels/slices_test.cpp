// Slices of a render hang on its pilot alone, have the random numbers of their iterations, and radii by the schedule.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/estimators.h"
#include "render/schedule.h"
#include "render/slices.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/names.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

const KeepGoing always = [](const Progress&) { return true; };

/// A scene and who renders slices of it.
struct Slicer {
    explicit Slicer(const Settings& settings)
        : scene(room()), renderer(scene, resolve_settings(settings, scene), plain_device()) {}

    Scene scene;
    SliceRenderer renderer;
};

void expect_same_sums(const IterationSums& a, const IterationSums& b, const std::string& what) {
    SCOPED_TRACE(what);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.film, b.film);
    EXPECT_EQ(surface_channels(a, 1.0), surface_channels(b, 1.0));
    EXPECT_EQ(a.errors.sizes, b.errors.sizes);
    EXPECT_EQ(a.errors.of_group, b.errors.of_group);
}

class Slices : public GpuTest, public testing::WithParamInterface<std::string> {};

TEST_P(Slices, HaveTheSameBitsInAnyOrder) {
    Slicer one(settings_with_all(GetParam())), other(settings_with_all(GetParam()));
    const auto pilot = one.renderer.render_pilot(least_pilot, always);
    const auto again = other.renderer.render_pilot(least_pilot, always);
    ASSERT_TRUE(pilot && again);
    expect_same_sums(pilot->slice.sums, again->slice.sums, "the pilot");
    EXPECT_EQ(pilot->pilot.state, again->pilot.state);
    // The second is longer than what goes by between two plans of the grid.
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> cuts = {{8, 3}, {11, 19}, {30, 1}};
    std::vector<Slice> slices;
    for (const auto& [first, count] : cuts) {
        slices.push_back(one.renderer.render_slice(pilot->pilot, first, count, always).value());
        EXPECT_EQ(slices.back().report.iterations, count);
        EXPECT_EQ(slices.back().sums.iterations, count);
        EXPECT_EQ(slices.back().report.emitted_paths, count * 600u);
    }
    for (std::size_t i = cuts.size(); i-- > 0;) {
        const Slice slice = other.renderer.render_slice(again->pilot, cuts[i].first, cuts[i].second, always).value();
        expect_same_sums(slice.sums, slices[i].sums, "slice " + std::to_string(i));
    }
    // One that was begun and left leaves nothing behind.
    EXPECT_FALSE(one.renderer.render_slice(pilot->pilot, 8, 3, [](const Progress&) { return false; }));
    const Slice slice = one.renderer.render_slice(pilot->pilot, 11, 19, always).value();
    expect_same_sums(slice.sums, slices[1].sums, "after one that was left");
}

TEST_P(Slices, HaveRadiiByTheSchedule) {
    const Settings settings = settings_with_all(GetParam());
    Slicer slicer(settings);
    const PilotOfSlices pilot = slicer.renderer.render_pilot(16, always).value();
    const Slice slice = slicer.renderer.render_slice(pilot.pilot, 40, 8, always).value();
    const double wanted = mean_shrink(shrink_exponent(settings), 16, 40, 8);
    const std::size_t pixels = pilot.slice.sums.surfaces.size();
    std::size_t smaller = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double before = pilot.slice.sums.surfaces[i].radius2, after = slice.sums.surfaces[i].radius2;
        smaller += std::abs(after / before - wanted) < 1e-6 ? 1 : 0;
    }
    EXPECT_GT(smaller, pixels * 9 / 10);  // the others have no radius yet, or have found it in the slice
}

INSTANTIATE_TEST_SUITE_P(Estimators, Slices, testing::ValuesIn(all_estimators()),
                         [](const auto& info) { return identifier(info.param); });

class SlicesOfARender : public GpuTest {};

// With radii that hardly shrink a render has the same ones in every iteration, whoever renders it: what is left is
// that its random numbers and strata are those of the iteration. Photons may be added up in another order.
TEST_F(SlicesOfARender, AddUpToItWhereRadiiStay) {
    Settings settings = settings_with_all("sppm-kz");
    settings.alpha = 0.9999999;
    settings.iterations = 20;
    Slicer slicer(settings);
    const PilotOfSlices pilot = slicer.renderer.render_pilot(8, always).value();
    std::vector<glm::dvec3> film = pilot.slice.sums.film;
    for (const std::uint32_t first : {8u, 14u}) {
        const Slice slice = slicer.renderer.render_slice(pilot.pilot, first, 6, always).value();
        for (std::size_t i = 0; i < film.size(); ++i) film[i] += slice.sums.film[i];
    }
    const Rendering whole = render(slicer.scene, resolve_settings(settings, slicer.scene), plain_device());
    double error = 0.0, sum = 0.0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < film.size(); ++i) {
        const glm::dvec3 wanted(whole.image.rgb[i]);
        const double distance = glm::length(film[i] / 20.0 - wanted), size = glm::length(wanted);
        error += distance;
        sum += size;
        differing += distance > 1e-4 * size ? 1 : 0;
    }
    // A pixel that finds its first radius later than in the pilot looks for it in every slice.
    EXPECT_LE(differing, film.size() / 50);
    EXPECT_LT(error, 1e-3 * sum);
}

TEST_F(SlicesOfARender, ThePilotIsItsBeginning) {
    Settings settings = settings_with_all("cppm");
    settings.iterations = 16;
    Slicer slicer(settings);
    const PilotOfSlices pilot = slicer.renderer.render_pilot(16, always).value();
    const Rendering whole = render(slicer.scene, resolve_settings(settings, slicer.scene), plain_device());
    const Image picture = picture_of(pilot.slice.sums);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(picture.rgb[i][c], whole.image.rgb[i][c]) << "pixel " << i;
    }
    for (const auto& [name, channel] : surface_channels(pilot.slice.sums, slicer.renderer.scale()))
        EXPECT_EQ(channel, whole.aovs.at(name)) << name;
    EXPECT_EQ(estimate_error(pilot.slice.sums.errors).relmse.error.value, whole.estimate->relmse.error.value);
}

}  // namespace
}  // namespace vkcppm::test
