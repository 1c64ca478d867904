// This group runs with the assertions of host/flat and host/render on, whatever the build's type.

#include <gtest/gtest.h>

#include "render/grid.h"

namespace vkcppm {
namespace {

TEST(Assertions, AreOnInThisGroup) { EXPECT_DEATH(coarsest(gpu::Grid{}, 0), "levels > 0"); }

}  // namespace
}  // namespace vkcppm
