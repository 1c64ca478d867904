// A render that is put down and taken up by another integrator goes on with the same bits, at every iteration and for
// every estimator; and the hashes of its passes tell where two renders part.

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/estimators.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/names.h"
#include "support/scenes/shapes.h"
#include "support/thrown.h"

namespace vkcppm::test {
namespace {

class Checkpoints : public GpuTest, public testing::WithParamInterface<std::string> {};

// The grid is planned before iterations 0, 1, 2, 4, ... and multiples of 16 from what iterations before have left: put
// down right before, right after and between two plans.
TEST_P(Checkpoints, GoOnWithTheSameBits) {
    constexpr std::uint32_t last = 34;
    struct Kept {
        Report report;
        std::vector<std::byte> state;
    };
    Rig whole(room(), settings_with_all(GetParam()), plain_device());
    Rig resumed(room(), settings_with_all(GetParam()), plain_device());
    std::vector<Kept> kept;
    for (const std::uint32_t stop : {5u, 16u, 23u}) {
        whole.integrator.run(stop - whole.integrator.completed());
        kept.push_back({whole.report(), whole.integrator.save()});
    }
    whole.integrator.run(last - whole.integrator.completed());
    const Report expected = whole.report();
    // The first time on buffers of zeros, then on what the time before has left in them.
    for (const auto& [report, state] : kept) {
        const std::string what = "put down after " + std::to_string(report.iterations) +
                                 " iterations, compared after " + std::to_string(last);
        resumed.integrator.restore(report, state);
        EXPECT_EQ(resumed.integrator.completed(), report.iterations);
        resumed.integrator.run(last - resumed.integrator.completed());
        expect_same_state(whole, resumed, what);
        expect_same_picture(resumed.integrator.resolve(), whole.integrator.resolve(), what);
        EXPECT_EQ(whole.integrator.aovs(), resumed.integrator.aovs()) << what;
        const Report got = resumed.report();
        EXPECT_EQ(got.iterations, expected.iterations) << what;
        EXPECT_EQ(got.stored_photons, expected.stored_photons) << what;
        EXPECT_EQ(got.emitted_paths, expected.emitted_paths) << what;
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, Checkpoints, testing::ValuesIn(all_estimators()),
                         [](const auto& info) { return identifier(info.param); });

class CheckpointState : public GpuTest {};

TEST_F(CheckpointState, OfAGridOfSeveralLevelsGoesOnWithTheSameBits) {
    Settings settings = settings_with_all("cppm");
    settings.size = Extent{256, 256};  // so many discs that a level more pays
    settings.photons = 400;
    Rig whole(room(), settings, plain_device());
    whole.integrator.run(1);
    set_two_radii(whole);
    whole.integrator.run(2);
    ASSERT_GE(whole.integrator.buffer(Binding::grid).download_value<gpu::Grid>().levels, 2u);
    const std::vector<std::byte> state = whole.integrator.save();
    const Report report = whole.report();
    const auto hashes = [](Rig& rig) {
        std::vector<std::uint64_t> all;
        for (int i = 0; i < 3; ++i) {
            for (const Integrator::PassHash& hash : rig.integrator.run_hashed()) all.push_back(hash.hash);
        }
        return all;
    };
    const auto wanted = hashes(whole);
    Rig resumed(room(), settings, plain_device());
    resumed.integrator.restore(report, state);
    EXPECT_EQ(hashes(resumed), wanted);
    expect_same_picture(resumed.integrator.resolve(), whole.integrator.resolve());
}

TEST_F(CheckpointState, OfAnotherSizeOrWithAnImpossibleGridIsRefused) {
    Rig rig(room(), settings_with_all("cppm"), plain_device());
    rig.integrator.run(2);
    const std::vector<std::byte> good = rig.integrator.save();
    for (const std::size_t size : {std::size_t(0), good.size() - 1, good.size() + 1}) {
        std::vector<std::byte> bad = good;
        bad.resize(size);
        const auto error = thrown_by([&] { rig.integrator.restore(rig.report(), bad); });
        ASSERT_TRUE(error) << size << " bytes were taken";
        EXPECT_EQ(error->code(), ExitCode::bad_input);
        EXPECT_NE(std::string(error->what()).find(std::to_string(size)), std::string::npos) << error->what();
    }
    // Every cell of a larger grid would be looked up past the end of the table.
    std::size_t grid_at = sizeof(gpu::Status) - offsetof(gpu::Status, photons);  // what the status carries comes first
    for (const BufferRow& row : buffer_rows()) {
        if (row.binding == Binding::grid) break;
        if (row.life != Life::scratch) grid_at += rig.integrator.buffer(row.binding).bytes();
    }
    const auto grid = rig.integrator.buffer(Binding::grid).download_value<gpu::Grid>();
    gpu::Grid wide = grid, hashed = grid, empty = grid, flat = grid, deep = grid, shifted = grid;
    wide.dims[0].x *= 1000;
    hashed.dims[0].w = 0xffffffffu;
    empty.entries = 0;
    flat.cell[0] = 0.0f;
    deep.levels = GRID_LEVELS + 1;
    shifted.first[0] = 1;
    for (const gpu::Grid& wrong : {wide, hashed, empty, flat, deep, shifted}) {
        std::vector<std::byte> bad = good;
        std::memcpy(bad.data() + grid_at, &wrong, sizeof(wrong));
        const auto error = thrown_by([&] { rig.integrator.restore(rig.report(), bad); });
        ASSERT_TRUE(error) << wrong.dims[0].x << " x " << wrong.dims[0].y << " x " << wrong.dims[0].z << ", "
                           << wrong.entries << ", " << wrong.levels << " levels";
        EXPECT_EQ(error->code(), ExitCode::bad_input);
    }
    rig.integrator.restore(rig.report(), good);
}

class PassHashes : public GpuTest {
protected:
    static constexpr std::size_t passes = 7;  // of an iteration

    static std::vector<Integrator::PassHash> run(Rig& rig, std::uint32_t iterations) {
        std::vector<Integrator::PassHash> hashes;
        for (std::uint32_t i = 0; i < iterations; ++i) {
            for (const Integrator::PassHash& hash : rig.integrator.run_hashed()) hashes.push_back(hash);
        }
        return hashes;
    }
    /// "3 gather" for the first that differs, "" where none does.
    static std::string first_difference(const std::vector<Integrator::PassHash>& a,
                                        const std::vector<Integrator::PassHash>& b) {
        for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
            if (a[i].pass != b[i].pass || a[i].hash != b[i].hash) {
                return std::to_string(i / passes + 1) + " " + a[i].pass;
            }
        }
        return a.size() == b.size() ? "" : "their number";
    }
};

TEST_F(PassHashes, DoNotDependOnHowTheWorkIsCut) {
    Rig whole(room(), settings_with_all("cppm"), plain_device());
    const auto expected = run(whole, 5);
    ASSERT_EQ(expected.size(), 5 * passes);
    std::string names;
    for (std::size_t i = passes; i < 2 * passes; ++i) names += expected[i].pass + " ";
    EXPECT_EQ(names, "photon grid eye knn area gather update ");

    Rig cut(room(), settings_with_all("cppm"), plain_device());
    gpu::Params params = cut.integrator.params();
    params.step_budget = 150;
    params.photon_capacity = 3;
    cut.integrator.set_params(params);
    EXPECT_EQ(first_difference(expected, run(cut, 5)), "") << "small step budgets and photon buffers";

    Rig plain(room(), settings_with_all("cppm"), plain_device());
    plain.integrator.run(5);
    expect_same_state(whole, plain, "with hashes and without");

    Rig resumed(room(), settings_with_all("cppm"), plain_device());
    resumed.integrator.restore(whole.report(), whole.integrator.save());
    EXPECT_EQ(first_difference(run(whole, 3), run(resumed, 3)), "") << "of iterations 6 to 8, after a checkpoint";
}

TEST_F(PassHashes, TellTheFirstPassThatDiffers) {
    Rig expected_rig(room(), settings_with_all("cppm"), plain_device());
    const auto expected = run(expected_rig, 3);
    const auto differs_with = [&](std::uint32_t before, const auto& change) {
        Rig rig(room(), settings_with_all("cppm"), plain_device());
        auto hashes = run(rig, before);
        gpu::Params params = rig.integrator.params();
        change(params);
        rig.integrator.set_params(params);
        const auto rest = run(rig, 3 - before);
        hashes.insert(hashes.end(), rest.begin(), rest.end());
        return first_difference(expected, hashes);
    };
    EXPECT_EQ(differs_with(2, [](gpu::Params& p) { p.pixel_radius *= 1.0001f; }), "3 eye");
    EXPECT_EQ(differs_with(1, [](gpu::Params& p) { --p.photons; }), "2 photon");
    EXPECT_EQ(differs_with(0, [](gpu::Params& p) { p.radius_floor *= 1.5f; }), "1 grid");
    EXPECT_EQ(differs_with(1, [](gpu::Params& p) { p.knn = 5; }), "2 knn");
    EXPECT_EQ(differs_with(1, [](gpu::Params& p) { p.sector_edge[1].x *= 0.5f; }), "2 gather");
    EXPECT_EQ(differs_with(1, [](gpu::Params& p) { p.inverse_paths *= 1.0001f; }), "2 update");
}

}  // namespace
}  // namespace vkcppm::test
