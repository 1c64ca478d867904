// The photons in the order of their cells: scan, radix sort and cell starts, for dense rows and for the hash.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

Settings small(std::uint32_t photons) {
    Settings settings;
    settings.size = Extent{32, 32};
    settings.photons = photons;
    settings.direct = direct_gathered;  // many photons of few paths
    return settings;
}

/// The cell of a position, its box padded by none: out of range cells belong to the nearest.
glm::ivec3 cell_of(const gpu::Grid& grid, std::uint32_t level, const glm::vec3& position) {
    const glm::vec3 place = (position - grid.origin) * grid.inverse_cell[level];
    glm::ivec3 cell;
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = std::clamp(int(std::floor(place[axis])), 0, int(grid.dims[level][axis]) - 1);
    }
    return cell;
}

/// Rows along x one after the other; or runs of eight cells along x hashed as by Teschner et al. 2003.
std::uint32_t entry_of(const gpu::Grid& grid, std::uint32_t level, const glm::ivec3& cell) {
    const glm::uvec3 c(cell);
    const glm::uvec4& dims = grid.dims[level];
    if (dims.w == 0) return grid.first[level] + (c.z * dims.y + c.y) * dims.x + c.x;
    std::uint32_t hash = (c.x / 8 * 73856093u) ^ (c.y * 19349663u) ^ (c.z * 83492791u);
    hash ^= hash >> 15;
    return grid.first[level] + ((hash * 8) & dims.w) + c.x % 8;
}

class GridOrder : public GpuTest {
protected:
    /// Runs an iteration with a table of `cells` entries (0: the default) and compares everything with the host.
    void check(Rig& rig, std::uint32_t cells, bool hashed) {
        gpu::Params params = rig.integrator.params();
        if (cells > 0) params.cells = cells;
        rig.integrator.set_params(params);
        rig.integrator.run(1);
        params = rig.integrator.params();
        const gpu::Grid grid = rig.integrator.buffer(Binding::grid).download_value<gpu::Grid>();
        ASSERT_EQ(grid.levels, 1u);
        const glm::uvec4& dims = grid.dims[0];
        ASSERT_EQ(dims.w != 0, hashed) << dims.x << " x " << dims.y << " x " << dims.z << " cells of " << grid.cell[0]
                                       << ", table of " << params.cells;
        if (hashed) {
            EXPECT_EQ(dims.w, params.cells - 1);
        }
        ASSERT_EQ(grid.first[0], 0u);
        ASSERT_EQ(grid.entries, hashed ? params.cells : dims.x * dims.y * dims.z);
        ASSERT_LE(grid.entries, params.cells);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(grid.origin[axis] + float(dims[axis]) * grid.cell[0], params.bounds_high[axis])
                << "axis " << axis;
        }
        expect_order(rig, grid);
    }

    /// Compares the sorted photons and the table of cell starts with the host's.
    static void expect_order(Rig& rig, const gpu::Grid& grid) {
        // Path by path and bounce by bounce.
        const auto photons = rig.all<gpu::Photon>(Binding::photons);
        const auto fluxes = rig.all<gpu::PhotonFlux>(Binding::photon_flux);
        struct Entry {
            std::uint32_t cell;
            std::size_t slot;
        };
        std::vector<Entry> entries;
        for (const StoredPath& path : rig.stored_paths()) {
            for (std::size_t slot = path.slot; slot < path.slot + path.count; ++slot) {
                for (std::uint32_t level = 0; level < grid.levels; ++level) {
                    entries.push_back({entry_of(grid, level, cell_of(grid, level, photons[slot].position)), slot});
                }
            }
        }
        ASSERT_GT(entries.size(), *rig.settings.photons);
        std::stable_sort(entries.begin(), entries.end(),
                         [](const Entry& a, const Entry& b) { return a.cell < b.cell; });

        const auto sorted = rig.all<gpu::Photon>(Binding::sorted);
        const auto sorted_flux = rig.all<gpu::PhotonFlux>(Binding::sorted_flux);
        for (std::size_t i = 0; i < entries.size(); ++i) {
            ASSERT_EQ(std::memcmp(&sorted[i], &photons[entries[i].slot], sizeof(gpu::Photon)), 0)
                << "place " << i << " of " << entries.size() << ", slot " << entries[i].slot << ", cell "
                << entries[i].cell;
            ASSERT_EQ(std::memcmp(&sorted_flux[i], &fluxes[entries[i].slot], sizeof(gpu::PhotonFlux)), 0)
                << "place " << i << ", slot " << entries[i].slot;
        }
        const auto counters = rig.all<std::uint32_t>(Binding::counters);
        std::size_t next = 0, occupied = 0;
        for (std::uint32_t cell = 0; cell < grid.entries; ++cell) {
            ASSERT_EQ(counters[cell], next) << "start of cell " << cell << " of " << grid.entries;
            const std::size_t begin = next;
            while (next < entries.size() && entries[next].cell == cell) ++next;
            occupied += next > begin ? 1 : 0;
        }
        ASSERT_EQ(counters[grid.entries], entries.size()) << "the end of the last cell";
        EXPECT_GT(occupied, 30u) << "too few cells to mean anything";
    }
};

TEST_F(GridOrder, DenseRowsHoldThePhotonsInOrder) {
    Rig rig(room(), small(4096));
    check(rig, 0, false);
}

TEST_F(GridOrder, HashedRunsHoldThePhotonsInOrder) {
    for (const std::uint32_t cells : {64u, 1024u}) {
        SCOPED_TRACE(cells);
        Rig rig(room(), small(4096));
        check(rig, cells, true);
    }
}

TEST_F(GridOrder, ManyPhotonsAndManyDigits) {
    Rig rig(room(), small(40000));
    check(rig, 0, false);
    ASSERT_NO_FATAL_FAILURE();
    Rig one(bare_room(0.5f), small(100));
    check(one, 0, false);
}

TEST_F(GridOrder, EveryLevelHoldsThePhotonsInOrder) {
    Settings settings = small(400);
    settings.size = Extent{256, 256};  // so many discs that a level more pays
    Rig rig(room(), settings);
    rig.integrator.run(1);
    set_two_radii(rig);
    rig.integrator.run(2);
    const auto grid = rig.integrator.buffer(Binding::grid).download_value<gpu::Grid>();
    ASSERT_GE(grid.levels, 2u);
    for (std::uint32_t level = 1; level < grid.levels; ++level) {
        EXPECT_GT(grid.cell[level], grid.cell[level - 1]);
        EXPECT_GT(grid.reach[level], grid.reach[level - 1]);
    }
    expect_order(rig, grid);
}

TEST_F(GridOrder, PlansFromTheRadiiInForce) {
    Rig rig(room(), small(4096));
    rig.integrator.run(2);  // plans before iterations 0, 1 and 2: the radii were counted after iteration 1
    std::uint32_t diffuse = 0;
    for (const auto& hit : rig.all<gpu::HitPosition>(Binding::hit_position))
        diffuse += (hit.state & HIT_MASK) == HIT_DIFFUSE ? 1 : 0;
    const gpu::Status status = rig.status();
    std::uint32_t counted = 0;
    for (const std::uint32_t bin : status.radius_histogram) counted += bin;
    EXPECT_EQ(counted, diffuse) << "radii in the histogram, pixels that see a diffuse surface";
    std::uint64_t photons = 0, gathered = 0;
    for (int bin = 0; bin < RADIUS_BINS; ++bin) {
        photons += (std::uint64_t(status.photon_histogram_high[bin]) << 32) + status.photon_histogram[bin];
    }
    for (const auto& found : rig.all<gpu::Gathered>(Binding::gathered)) gathered += found.tested;
    EXPECT_EQ(photons, gathered) << "photons in the histogram, and in the discs' neighbourhoods";
    EXPECT_GT(photons, 0u);
}

TEST_F(GridOrder, ExclusiveScanOfAnyRange) {
    Rig rig(bare_room(0.5f), small(4096));
    const std::size_t words = rig.integrator.buffer(Binding::counters).bytes() / 4;
    const gpu::Params& params = rig.integrator.params();
    std::mt19937 random(14);
    const std::uint32_t limit = params.cells + 1 + 2 * params.photons + 1 + params.sort_lanes * 64;
    // What stands at 0 is the table of cells: of it only the entries in use are scanned, and the end of the last.
    struct Case {
        std::uint32_t offset, count, entries;
    };
    for (const auto& [offset, asked, entries] :
         {Case{0, 1, limit}, Case{0, 4096, limit}, Case{5, 4097, 10}, Case{17, 100, 10}, Case{0, limit, limit},
          Case{0, limit, 5000}, Case{1, 65535, 10}}) {
        const std::uint32_t count = offset == 0 ? std::min(asked, entries + 1) : asked;
        gpu::Grid grid{};
        grid.entries = entries;
        rig.integrator.buffer(Binding::grid).upload_value(grid);
        std::vector<std::uint32_t> values(words);
        for (auto& value : values) value = random() % 200000u;  // the largest sums wrap, here as there
        rig.integrator.buffer(Binding::counters).upload(values);
        const gpu::Launch launch{.iteration = 0, .last_round = 1, .scan_first = offset, .scan_count = asked};
        rig.integrator.run_kernel(KernelId::scan_sums, 4096, launch);
        rig.integrator.run_kernel(KernelId::scan_blocks, 64, launch);
        rig.integrator.run_kernel(KernelId::scan_apply, 4096, launch);
        const auto scanned = rig.all<std::uint32_t>(Binding::counters);
        std::uint32_t running = 0;
        for (std::uint32_t i = 0; i < limit; ++i) {
            const bool inside = i >= offset && i < offset + count;
            ASSERT_EQ(scanned[i], inside ? running : values[i])
                << "word " << i << " of a scan of " << count << " from " << offset;
            if (inside) running += values[i];
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
