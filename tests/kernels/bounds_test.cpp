// Where rays from afar enter the scene's bounds.

#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "support/device/gpu.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t bounds_words[] = {
#include "bounds.spv.inc"
};

class BoundsEntry : public GpuTest {};

TEST_F(BoundsEntry, RaysStartBeforeTheBoxAndNearIt) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto point = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
    for (const double thickness : {0.6, 1e-5}) {  // a flat scene's box is its padding
        gpu::Params params{};
        params.bounds_low = {-0.8f, float(-thickness), -0.5f};
        params.bounds_high = {0.7f, float(thickness), 0.5f};
        const glm::dvec3 low(params.bounds_low), high(params.bounds_high);
        std::vector<gpu::RayInput> rays;
        for (int i = 0; i < 20000; ++i) {
            const double far = std::pow(10.0, i % 7 - 1);
            const glm::dvec3 origin = far * point();
            glm::dvec3 target = glm::mix(low, high, 0.5 + 0.5 * point());
            if (i % 5 == 0) target = far * point();
            glm::dvec3 direction = target - origin;
            if (i % 5 == 1) direction[i % 3] = 0.0;
            if (i % 50 == 2) direction = {0.0, i % 100 == 2 ? 1.0 : -1.0, 0.0};
            if (glm::length(direction) < 1e-6) continue;
            rays.push_back({glm::vec3(origin), glm::vec3(glm::normalize(direction))});
        }
        Probe probe("bounds", bounds_words);
        probe.input(Binding::params, std::vector{params});
        probe.input(PROBE_INPUT, rays);
        probe.output<glm::vec3>(PROBE_OUTPUT, rays.size());
        probe.run(rays.size(), {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(rays.size())});
        const auto starts = probe.result<glm::vec3>(PROBE_OUTPUT, rays.size());
        std::size_t moved = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::dvec3 o(rays[i].origin), d(rays[i].direction), start(starts[i]);
            const std::string line = fmt::format("ray {} from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})",
                                                 i, o.x, o.y, o.z, d.x, d.y, d.z);
            // Distance slab by slab to the box itself and to one that is smaller by the rounding of floats:
            // a ray that misses the latter may count as one that misses.
            const double rounding = 3e-7 * glm::length(o);
            double near = 0.0, far = std::numeric_limits<double>::infinity(), inner_near = near, inner_far = far;
            for (int axis = 0; axis < 3; ++axis) {
                const double shrink = std::min(rounding, 0.45 * (high[axis] - low[axis]));
                if (d[axis] == 0.0) {
                    if (o[axis] < low[axis] + shrink || o[axis] > high[axis] - shrink) inner_far = -1.0;
                    continue;
                }
                const auto cut = [&](double by, double& from, double& to) {
                    const double a = (low[axis] + by - o[axis]) / d[axis], b = (high[axis] - by - o[axis]) / d[axis];
                    from = std::max(from, std::min(a, b));
                    to = std::min(to, std::max(a, b));
                };
                cut(0.0, near, far);
                cut(shrink, inner_near, inner_far);
            }
            const double travelled = glm::dot(start - o, d);
            ASSERT_LT(glm::distance(start, o + travelled * d), 1e-6 + 2.0 * rounding) << line << ": off the ray";
            ASSERT_GE(travelled, -rounding) << line << ": moved back";
            if (inner_near > inner_far) {  // anything up to the box will do
                ASSERT_LE(travelled, glm::length(o) + 2.0) << line;
                continue;
            }
            ASSERT_LE(travelled, near + rounding) << line << ": started beyond the box's near side";
            if (near > 1.0) {
                ++moved;
                ASSERT_LE(glm::length(start), 2.0 + 2e-4 * glm::length(o)) << line << ": started far from the box";
            }
        }
        EXPECT_GT(moved, rays.size() / 4);
    }
}

}  // namespace
}  // namespace vkcppm::test
