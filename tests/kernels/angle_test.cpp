// The kernels' own angle: near the true one, and to the bit what its formula gives in rounded steps, so that it is the
// same on every device and under every driver.

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "support/device/gpu.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t angle_words[] = {
#include "angle.spv.inc"
};

constexpr std::size_t tried = 100000;

class Angle : public GpuTest {
protected:
    std::vector<float> angles(const std::vector<glm::vec2>& points) {
        probe_.input(PROBE_INPUT, points);
        probe_.output<float>(PROBE_OUTPUT, points.size());
        probe_.run(points.size(),
                   {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(points.size())});
        return probe_.result<float>(PROBE_OUTPUT, points.size());
    }

    Probe probe_{"angle", angle_words};
};

// Mesa's atan errs by 2e-6.
TEST_F(Angle, IsThatOfThePlane) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> turn(-3.15f, 3.15f), exponent(-30.0f, 30.0f);
    std::vector<glm::vec2> points;
    for (const float x : {-1.0f, 0.0f, 1e-20f, 1.0f, 3.0f}) {
        for (const float y : {-3.0f, -1.0f, -1e-20f, 0.0f, 1.0f}) points.emplace_back(x, y);
    }
    while (points.size() < tried) {
        const float angle = turn(random), length = std::exp2(exponent(random));
        points.emplace_back(length * std::cos(angle), length * std::sin(angle));
    }
    const std::vector<float> got = angles(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double want = std::atan2(double(points[i].y), double(points[i].x));
        ASSERT_NEAR(got[i], want, 4e-7) << fmt::format("of ({:g}, {:g})", points[i].x, points[i].y);
    }
}

/// angle_of where t = min / max is exact. Sums and products in double, which hold those of two floats, are rounded to
/// float once: no compiler can fuse or rearrange them.
float angle_in_steps(float y, float x) {
    const float a = std::abs(x), b = std::abs(y);
    const float t = std::min(a, b) / std::max(a, b);
    const float s = float(double(t) * t);
    float p = -0.00466877315f;
    for (const float c :
         {0.0241661891f, -0.0593671016f, 0.0990609676f, -0.140165851f, 0.199692354f, -0.333319604f, 0.999999881f}) {
        p = float(double(float(double(p) * s)) + double(c));
    }
    float angle = float(double(p) * t);
    const auto pi = float(std::numbers::pi), half = float(std::numbers::pi / 2.0);
    if (b > a) angle = float(double(half) - angle);
    if (x < 0.0f) angle = float(double(pi) - angle);
    return y < 0.0f ? -angle : angle;
}

// The larger coordinate is a power of two, whose quotient every device knows exactly.
TEST_F(Angle, HasTheSameBitsEverywhere) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> small(-1.0f, 1.0f);
    std::vector<glm::vec2> points;
    while (points.size() < tried) {
        const float large = (random() & 1 ? 1.0f : -1.0f) * std::exp2(float(int(random() % 9) - 4));
        const float other = std::abs(large) * small(random);
        points.push_back(random() & 1 ? glm::vec2(large, other) : glm::vec2(other, large));
    }
    const std::vector<float> got = angles(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float want = angle_in_steps(points[i].y, points[i].x);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(got[i]), std::bit_cast<std::uint32_t>(want))
            << fmt::format("of ({:.9g}, {:.9g}): {:.9g} and {:.9g}", points[i].x, points[i].y, got[i], want);
    }
}

}  // namespace
}  // namespace vkcppm::test
