// The area of the surface in a disc: its reciprocal is estimated without bias, for discs whose area is known.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "core/image.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t iteration = 511;  // of the measures
constexpr int terms = 5;                  // of the series that are followed then

/// What the estimate leaves of 1 / f: the sum of the first terms of its series.
double of_terms(double share) { return (1.0 - std::pow(1.0 - share, terms)) / share; }

/// The variance of the number of terms until a line meets the surface, or of all.
double variance_of_terms(double share) {
    double squares = 0.0;
    for (int n = 1; n <= terms; ++n) {
        squares += std::pow(1.0 - share, n - 1) * (n < terms ? share : 1.0) * n * n;
    }
    return squares - of_terms(share) * of_terms(share);
}

Settings small_settings() {
    Settings settings;
    settings.size = Extent{24, 24};
    settings.photons = 64;
    return settings;
}

/// A square [-1, 1]^2 at y = 0 seen from above, and a light that has nothing to do with it.
Scene plate(bool in_a_mirror) {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    if (in_a_mirror) {
        const auto metal = add_material(scene, mirror(glm::vec3(0.9f)));
        for (int side = 0; side < 4; ++side) {
            const double angle = side * std::numbers::pi / 2.0;
            const auto turned = [&](double x, double z) {
                return glm::dvec3(std::round(std::cos(angle)) * x + std::round(std::sin(angle)) * z, 0.0,
                                  std::round(std::cos(angle)) * z - std::round(std::sin(angle)) * x);
            };
            add_quad(scene, turned(1, -1), turned(0, 2), turned(2, 0), metal);
        }
    }
    add_point_light(scene, {0, 2, 0}, glm::vec3(1.0f));
    add_camera(scene, {0, 1.9, 0.001}, {0, 0, 0}, 1.0);
    return scene;
}

/// The share of the disc about a point of the square that is in the square, by radii: no step of it is the kernel's.
double share_of_square(double x, double z, double radius) {
    double sum = 0.0;
    constexpr int directions = 4096;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.5) / directions;
        const double c = std::cos(angle), s = std::sin(angle);
        const double to_x = c != 0.0 ? ((c > 0.0 ? 1.0 : -1.0) - x) / c : 1e9;
        const double to_z = s != 0.0 ? ((s > 0.0 ? 1.0 : -1.0) - z) / s : 1e9;
        const double length = std::min({radius, to_x, to_z}) / radius;
        sum += length * length;
    }
    return sum / directions;
}

class Area : public GpuTest {
protected:
    /// Sets all radii, m, and measures `seeds` times; calls found(pixel, excess) for every pixel that gathers.
    template <typename Found> static void measure(Rig& rig, double radius, std::uint32_t seeds, const Found& found) {
        rig.integrator.run(1);
        auto states = rig.all<gpu::PixelState>(Binding::pixels);
        const float length = float(radius * rig.flat.frame.scale);
        for (gpu::PixelState& state : states) state.radius2 = length * length;
        rig.integrator.buffer(Binding::pixels).upload(states);
        gpu::Status status = rig.status();
        status.completed = iteration;
        rig.integrator.buffer(Binding::status).upload_value(status);
        const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
            gpu::Params params = rig.integrator.params();
            params.seed = seed;
            rig.integrator.set_params(params);
            rig.integrator.run_kernel(KernelId::area, rig.pixels(), {.iteration = iteration, .last_round = 1});
            const auto measured = rig.all<gpu::PixelState>(Binding::pixels);
            for (std::size_t i = 0; i < rig.pixels(); ++i) {
                if (hits[i].state & HIT_DIFFUSE) found(i, double(measured[i].excess));
            }
        }
        EXPECT_EQ(rig.status().blocked, 0u);
    }
};

TEST_F(Area, OfASquareIsWhatLiesInIt) {
    for (const bool in_a_mirror : {false, true}) {
        SCOPED_TRACE(in_a_mirror ? "in a mirror, which keeps no photons" : "alone");
        Rig rig(plate(in_a_mirror), small_settings());
        constexpr double radius = 0.6;
        constexpr std::uint32_t seeds = 300;
        std::vector<double> sum(rig.pixels());
        measure(rig, radius, seeds, [&](std::size_t pixel, double excess) { sum[pixel] += 1.0 + excess; });
        const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
        double differences = 0.0, variances = 0.0, largest = 1.0;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < rig.pixels(); ++i) {
            if (!(hits[i].state & HIT_DIFFUSE)) continue;
            const glm::dvec3 at = glm::dvec3(hits[i].position) / rig.flat.frame.scale + rig.flat.frame.centre;
            const double share = share_of_square(at.x, at.z, radius), want = of_terms(share);
            const double mean = sum[i] / seeds;
            if (share == 1.0) {
                ++inside;
                ASSERT_EQ(mean, 1.0) << "pixel " << i << ": a whole disc is measured without noise";
                continue;
            }
            const double variance = std::max(variance_of_terms(share), 1.0 / seeds) / seeds;
            ASSERT_LT(std::abs(mean - want), 5.0 * std::sqrt(variance))
                << fmt::format("pixel {} at ({:.3f}, {:.3f}): {:.4f}, want {:.4f}", i, at.x, at.z, mean, want);
            differences += mean - want;
            variances += variance;
            largest = std::max(largest, want);
        }
        EXPECT_LT(std::abs(differences), 4.0 * std::sqrt(variances)) << "over all pixels";
        EXPECT_GT(inside, 20u);
        EXPECT_GT(largest, 1.9) << "no disc that lies half beside the square";
    }
}

// The part of a sphere within R of a point of it has the area pi R^2: lines through it count by their cosines.
TEST_F(Area, OfASphereIsThatOfADisc) {
    Scene scene;
    add_sphere(scene, {0, 0, 0}, 1.0, 6, add_material(scene, lambert(glm::vec3(0.5f))), true);
    add_point_light(scene, {0, 3, 0}, glm::vec3(1.0f));
    add_camera(scene, {0, 0, 3}, {0, 0, 0}, 0.4);
    Rig rig(std::move(scene), small_settings());
    double sum = 0.0;
    std::size_t count = 0;
    measure(rig, 0.6, 100, [&](std::size_t, double excess) {
        sum += excess;
        ++count;
    });
    ASSERT_GT(count, 20000u);
    EXPECT_NEAR(sum / double(count), 0.0, 4e-3);
}

// A plate under a sky of radiance 1 sends its albedo to the eye, up to its edges and corners.
TEST_F(Area, EdgesAreAsBrightAsWhatIsBesideThem) {
    Scene scene;
    add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    scene.environment = Environment{{1, 1}, {glm::vec3(1.0f)}};
    add_camera(scene, {0, 3, 0.001}, {0, 0, 0}, 2.0 * std::atan(0.999 / 3.0));  // to its edges
    Settings settings;
    settings.size = Extent{32, 32};
    settings.photons = 512;
    settings.direct = direct_gathered;
    Image pictures[2];
    for (const bool measured : {true, false}) {
        settings.disc_area = measured ? area_measured : area_whole;
        const Image& picture = pictures[measured ? 0 : 1] = valid_picture(scene, settings, 64);
        double edge = 0.0, middle = 0.0;
        int at_edge = 0, within = 0;
        for (std::uint32_t y = 0; y < 32; ++y) {
            for (std::uint32_t x = 0; x < 32; ++x) {
                const std::uint32_t from_edge = std::min({x, y, 31 - x, 31 - y});
                if (from_edge < 2) {
                    edge += picture.at(x, y).y;
                    ++at_edge;
                } else if (from_edge > 10) {
                    middle += picture.at(x, y).y;
                    ++within;
                }
            }
        }
        edge /= at_edge;
        middle /= within;
        EXPECT_NEAR(middle, 0.5, 0.01) << settings.disc_area;
        if (measured) {
            EXPECT_NEAR(edge, 0.5, 0.02);
        } else {
            EXPECT_LT(edge, 0.47) << "what it is for";
        }
    }
    if (HasFailure()) leave_pictures(pictures[0], pictures[1], "measured and whole");
}

}  // namespace
}  // namespace vkcppm::test
