// Packed directions and tangent frames.

#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "oracle/octahedral.h"
#include "support/device/gpu.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t frame_words[] = {
#include "frame.spv.inc"
};

std::string text(const glm::vec3& v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z); }

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::asin(std::min(1.0, 0.5 * glm::distance(glm::normalize(a), glm::normalize(b))));
}

class Frame : public GpuTest {
protected:
    std::vector<gpu::FrameSample> sample(const std::vector<glm::vec3>& directions) {
        probe_.input(PROBE_INPUT, directions);
        probe_.output<gpu::FrameSample>(PROBE_OUTPUT, directions.size());
        probe_.run(directions.size(),
                   {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(directions.size())});
        return probe_.result<gpu::FrameSample>(PROBE_OUTPUT, directions.size());
    }

    /// Axes with both signs of zero, diagonals of faces and cubes, both sides of the fold z = 0, then random ones.
    static std::vector<glm::vec3> directions() {
        std::vector<glm::vec3> list;
        for (const float x : {-1.0f, -0.0f, 0.0f, 1.0f}) {
            for (const float y : {-1.0f, -0.0f, 0.0f, 1.0f}) {
                for (const float z : {-1.0f, -1e-6f, -1e-20f, -0.0f, 0.0f, 1e-20f, 1e-6f, 1.0f}) {
                    if (std::abs(x) + std::abs(y) + std::abs(z) > 0.5f)
                        list.push_back(glm::normalize(glm::vec3(x, y, z)));
                }
            }
        }
        std::mt19937 random(2);
        std::normal_distribution<float> normal;
        for (int i = 0; i < 100000; ++i) {
            glm::vec3 n(normal(random), normal(random), normal(random));
            if (i % 4 == 1) n.z *= 1e-4f;  // near the fold
            if (i % 4 == 2) n.x *= 1e-4f;
            if (i % 8 == 3) n = glm::vec3(1e-3f * n.x, 1e-3f * n.y, n.z);  // near the poles
            list.push_back(glm::normalize(n));
        }
        return list;
    }

    Probe probe_{"frame", frame_words};
};

TEST_F(Frame, PackedDirectionsComeBackWithinTheRoundingOfSixteenBits) {
    // Half a step d = 0.5 / 32767 in x and in y moves the point of the octahedron by (d, d, -2 d); where that turns it
    // most, amid a face, it is 1 / sqrt(3) from the centre.
    const double bound = std::sqrt(6.0) * (0.5 / 32767.0) * std::sqrt(3.0) + 3e-7;
    const auto list = directions();
    const auto samples = sample(list);
    for (std::size_t i = 0; i < list.size(); ++i) {
        ASSERT_LE(angle_between(samples[i].unpacked, list[i]), bound)
            << text(list[i]) << " came back as " << text(samples[i].unpacked);
        ASSERT_NEAR(glm::length(glm::dvec3(samples[i].unpacked)), 1.0, 3e-7) << text(list[i]);
        ASSERT_LE(angle_between(samples[i].unpacked, oracle::unpack_direction(samples[i].word)), 1e-6)
            << text(list[i]) << " packed as " << samples[i].word;
    }
    for (const glm::vec3& axis : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                  glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        const auto back = sample({axis}).front().unpacked;
        EXPECT_TRUE(back == axis) << text(axis) << " came back as " << text(back);
    }
}

TEST_F(Frame, TangentsAreOrthonormalAndRightHanded) {
    const auto list = directions();
    const auto samples = sample(list);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const glm::dvec3 n(list[i]), t(samples[i].tangent), b(samples[i].bitangent);
        ASSERT_NEAR(glm::length(t), 1.0, 1e-6) << text(list[i]);
        ASSERT_NEAR(glm::length(b), 1.0, 1e-6) << text(list[i]);
        ASSERT_NEAR(glm::dot(t, b), 0.0, 1e-6) << text(list[i]);
        ASSERT_NEAR(glm::dot(t, n), 0.0, 1e-6) << text(list[i]);
        ASSERT_NEAR(glm::dot(b, n), 0.0, 1e-6) << text(list[i]);
        ASSERT_GT(glm::dot(glm::cross(t, b), n), 0.999) << text(list[i]);
        ASSERT_LT(glm::distance(glm::dvec3(samples[i].tilted), 0.6 * t + 0.8 * n), 1e-6) << text(list[i]);
    }
}

TEST_F(Frame, TangentsAreContinuousOnEachHemisphere) {
    const auto list = directions();
    std::vector<glm::vec3> moved;
    std::mt19937 random(3);
    std::normal_distribution<float> normal(0.0f, 1e-3f);
    for (const glm::vec3& n : list) {
        moved.push_back(glm::normalize(n + glm::vec3(normal(random), normal(random), normal(random))));
    }
    const auto samples = sample(list), neighbours = sample(moved);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if ((list[i].z >= 0.0f) != (moved[i].z >= 0.0f)) continue;
        ++compared;
        const double step = glm::distance(list[i], moved[i]);
        ASSERT_LT(glm::distance(samples[i].tangent, neighbours[i].tangent), 4.0 * step + 1e-6) << text(list[i]);
        ASSERT_LT(glm::distance(samples[i].bitangent, neighbours[i].bitangent), 4.0 * step + 1e-6) << text(list[i]);
    }
    EXPECT_GT(compared, list.size() / 2);
}

}  // namespace
}  // namespace vkcppm::test
