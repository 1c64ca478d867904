// What kernels count, as the host takes it.

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/status.h"
#include "shared/kernels.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

TEST(Status, CountsAreTakenOnce) {
    gpu::Status status{};
    status.completed = 9;
    status.rays = 5;
    status.rays_high = 2;
    status.stored = 7;
    status.invalid = 3;
    status.blocked = PASS_EYE;
    const StatusCounts counts = take_counts(status, 100, "d");
    EXPECT_EQ(counts.rays, (std::uint64_t(2) << 32) + 5);
    EXPECT_EQ(counts.stored, 7u);
    EXPECT_EQ(counts.invalid, 3u);
    EXPECT_EQ(status.blocked, 0u);
    EXPECT_EQ(status.completed, 9u) << "the next iteration is no count";
    const StatusCounts again = take_counts(status, 100, "d");
    EXPECT_EQ(again.rays + again.stored + again.invalid, 0u);
}

TEST(Status, ARayThatCannotBeTracedIsAnError) {
    gpu::Status status{};
    status.stuck = 4;
    const auto error = test::thrown_by([&] { take_counts(status, 100, "a device"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::internal);
    EXPECT_STREQ(error->what(), "4 rays need more than 100 steps of the BVH each, the limit of device 'a device'");
}

}  // namespace
}  // namespace vkcppm
