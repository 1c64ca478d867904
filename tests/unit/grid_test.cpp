// The grid as the host handles it; its kernels are tested with them.

#include <limits>

#include <gtest/gtest.h>

#include "render/grid.h"

namespace vkcppm::test {
namespace {

gpu::Params room_for(std::uint32_t cells, std::uint32_t levels) {
    gpu::Params params{};
    params.cells = cells;
    params.most_levels = levels;
    return params;
}

constexpr float all_the_rest = std::numeric_limits<float>::max();

/// A hashed level, a coarser one, and dense rows.
gpu::Grid three_levels() {
    gpu::Grid grid{};
    grid.levels = 3;
    grid.dims[0] = {400, 400, 400, 63};
    grid.dims[1] = {40, 40, 40, 31};
    grid.dims[2] = {4, 3, 2, 0};
    for (std::uint32_t level = 0; level < 3; ++level) {
        grid.cell[level] = 0.01f * float(level + 1);
        grid.inverse_cell[level] = 1.0f / grid.cell[level];
        grid.reach[level] = level < 2 ? 0.02f * float(level + 1) : all_the_rest;
    }
    grid.reach[3] = all_the_rest;
    grid.first[1] = 64;
    grid.first[2] = 96;
    grid.entries = 120;
    return grid;
}

TEST(Grid, FitsItsTable) {
    const gpu::Grid grid = three_levels();
    EXPECT_TRUE(grid_fits(grid, room_for(128, 4)));
    EXPECT_FALSE(grid_fits(grid, room_for(64, 4))) << "120 entries in 64";
    EXPECT_FALSE(grid_fits(grid, room_for(128, 2))) << "three levels where there is room for two";
    gpu::Grid overlapping = grid;
    overlapping.first[1] = 32;
    EXPECT_FALSE(grid_fits(overlapping, room_for(128, 4)));
}

TEST(Grid, WithoutItsFinestLevels) {
    const gpu::Grid grid = three_levels(), kept = coarsest(grid, 2);
    EXPECT_EQ(kept.levels, 2u);
    EXPECT_TRUE(grid_fits(kept, room_for(128, 2))) << "its levels stay where they stand in the table";
    for (std::uint32_t level = 0; level < 2; ++level) {
        EXPECT_EQ(kept.dims[level], grid.dims[level + 1]);
        EXPECT_EQ(kept.cell[level], grid.cell[level + 1]);
        EXPECT_EQ(kept.inverse_cell[level], grid.inverse_cell[level + 1]);
        EXPECT_EQ(kept.first[level], grid.first[level + 1]);
    }
    EXPECT_EQ(kept.reach[0], grid.reach[1]);
    EXPECT_EQ(coarsest(grid, 4).levels, 3u);
    // Kernels made for more levels look at all reaches.
    for (const std::uint32_t levels : {1u, 2u, 3u}) {
        for (std::uint32_t level = levels - 1; level < GRID_LEVELS; ++level) {
            EXPECT_EQ(coarsest(grid, levels).reach[level], all_the_rest) << level << " of " << levels;
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
