// The oracle's rays and gather against constructions whose answer is known.

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "oracle/bvh.h"
#include "oracle/gather.h"
#include "oracle/intersect.h"

namespace vkcppm::oracle {
namespace {

Scene random_triangles(int count, std::mt19937_64& random) {
    std::uniform_real_distribution<double> place(-1.0, 1.0), size(-0.2, 0.2);
    Scene scene;
    scene.materials.emplace_back();
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 center(place(random), place(random), place(random));
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (int j = 0; j < 3; ++j) {
            scene.positions.push_back(center + glm::dvec3(size(random), size(random), size(random)));
            scene.normals.emplace_back(0.0f, 0.0f, 1.0f);
        }
        scene.triangles.push_back({{first, first + 1, first + 2}, 0});
    }
    return scene;
}

TEST(OracleIntersect, FindsTheBarycentricsAndTheDistance) {
    Scene scene;
    scene.positions = {{0, 0, 5}, {2, 0, 5}, {0, 3, 5}};
    scene.triangles = {{{0, 1, 2}, 0}};
    const auto hit = nearest_hit(scene, {{0.5, 0.75, 1.0}, {0.0, 0.0, 2.0}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 2.0, 1e-15) << "counted in lengths of the direction";
    EXPECT_NEAR(hit->barycentric.x, 0.5, 1e-15);
    EXPECT_NEAR(hit->barycentric.y, 0.25, 1e-15);
    EXPECT_NEAR(hit->barycentric.z, 0.25, 1e-15);
    EXPECT_TRUE(nearest_hit(scene, {{0.5, 0.75, 9.0}, {0.0, 0.0, -1.0}})) << "from behind";
    EXPECT_FALSE(nearest_hit(scene, {{0.5, 0.75, 9.0}, {0.0, 0.0, 1.0}})) << "behind the origin";
    EXPECT_FALSE(nearest_hit(scene, {{1.5, 1.5, 1.0}, {0.0, 0.0, 1.0}})) << "beside it";
    EXPECT_FALSE(nearest_hit(scene, {{-1.0, 0.5, 5.0}, {1.0, 0.0, 0.0}})) << "in its plane";
    EXPECT_FALSE(nearest_hit(scene, {{0.5, 0.75, 1.0}, {0.0, 0.0, 2.0}, 0.0, 2.0})) << "t_max is exclusive";
    EXPECT_FALSE(nearest_hit(scene, {{0.5, 0.75, 1.0}, {0.0, 0.0, 2.0}, 2.0})) << "t_min is exclusive";
    scene.positions[2] = {4, 0, 5};
    EXPECT_FALSE(nearest_hit(scene, {{1.0, 0.0, 1.0}, {0.0, 0.0, 1.0}})) << "a triangle without area";
}

TEST(OracleIntersect, HitPointLiesOnTheRayAndOnTheTriangle) {
    std::mt19937_64 random(7);
    const Scene scene = random_triangles(200, random);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    int hits = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray ray{{place(random), place(random), place(random)}, {place(random), place(random), place(random)}};
        const auto hit = nearest_hit(scene, ray);
        if (!hit) continue;
        ++hits;
        const auto& v = scene.triangles[hit->triangle].vertex;
        const glm::dvec3 on_triangle = hit->barycentric.x * scene.positions[v[0]] +
                                       hit->barycentric.y * scene.positions[v[1]] +
                                       hit->barycentric.z * scene.positions[v[2]];
        EXPECT_LT(glm::distance(ray.origin + hit->t * ray.direction, on_triangle), 1e-12) << "ray " << i;
    }
    EXPECT_GT(hits, 500);
}

TEST(OracleIntersect, NoRaySlipsThroughASharedEdge) {
    Scene scene;
    scene.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    scene.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> along(-0.9, 0.9);
    for (int i = 0; i < 5000; ++i) {
        const double s = along(random);
        const glm::dvec3 origin(along(random), along(random), 1.0);
        EXPECT_TRUE(nearest_hit(scene, {origin, glm::dvec3(s, s, 0.0) - origin})) << "diagonal at " << s;
    }
}

TEST(OracleBvh, AgreesWithAllTriangles) {
    std::mt19937_64 random(9);
    for (const int count : {0, 1, 5, 600}) {
        const Scene scene = random_triangles(count, random);
        const Bvh bvh(scene);
        std::uniform_real_distribution<double> place(-1.0, 1.0);
        for (int i = 0; i < 1000; ++i) {
            Ray ray{{place(random), place(random), place(random)}, {place(random), place(random), place(random)}};
            ray.direction[i % 3] = i % 4 == 0 ? 0.0 : ray.direction[i % 3];  // parallel to a side of the boxes
            ray.t_max = i % 2 == 0 ? 0.7 : ray.t_max;
            const auto expected = nearest_hit(scene, ray), found = bvh.nearest(ray);
            ASSERT_EQ(expected.has_value(), found.has_value()) << "ray " << i << ", " << count << " triangles";
            if (expected) {
                EXPECT_EQ(expected->t, found->t) << "ray " << i;
                EXPECT_EQ(expected->triangle, found->triangle) << "ray " << i;
            }
        }
    }
}

GatherPoint floor_point() { return {glm::dvec3(0.0), {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 2, 6}; }

Photon photon_at(double radius, double angle, double flux = 1.0) {
    return {{radius * std::cos(angle), 0.0, radius * std::sin(angle)}, {0, 1, 0}, glm::dvec3(flux)};
}

TEST(OracleGather, PutsEachPhotonIntoItsCell) {
    for (std::uint32_t ring = 0; ring < 2; ++ring) {
        for (std::uint32_t sector = 0; sector < 6; ++sector) {
            const double angle = (sector + 0.5) * std::numbers::pi / 3.0;
            const std::vector<Photon> photons{photon_at(ring == 0 ? 1.4 : 1.43, angle, 3.0)};  // sqrt(2) between
            const auto gathered = gather(floor_point(), 2.0, photons);
            EXPECT_EQ(gathered.count, 1u);
            EXPECT_EQ(gathered.flux, glm::dvec3(3.0));
            for (std::uint32_t cell = 0; cell < 12; ++cell) {
                EXPECT_EQ(gathered.tallies[cell], cell == ring * 6 + sector ? 1u : 0u) << "cell " << cell;
                EXPECT_EQ(gathered.cell_flux[cell].x, cell == ring * 6 + sector ? 3.0 : 0.0) << "cell " << cell;
            }
        }
    }
}

TEST(OracleGather, AcceptsByDistanceAndNormal) {
    const auto count = [](const Photon& photon) {
        return gather(floor_point(), 1.0, std::vector<Photon>{photon}).count;
    };
    EXPECT_EQ(count({{1.0, 0.0, 0.0}, {0, 1, 0}, glm::dvec3(1.0)}), 0u) << "at the radius";
    EXPECT_EQ(count({{std::nextafter(1.0, 0.0), 0.0, 0.0}, {0, 1, 0}, glm::dvec3(1.0)}), 1u);
    EXPECT_EQ(count({{0.8, 0.8, 0.0}, {0, 1, 0}, glm::dvec3(1.0)}), 0u) << "a ball, not a cylinder";
    EXPECT_EQ(count({{0.1, 0.0, 0.0}, {0, -1, 0}, glm::dvec3(1.0)}), 0u) << "the other side";
    EXPECT_EQ(count({{0.1, 0.0, 0.0}, {std::sqrt(1.0 - 0.11 * 0.11), 0.11, 0}, glm::dvec3(1.0)}), 1u);
    EXPECT_EQ(count({{0.1, 0.0, 0.0}, {std::sqrt(1.0 - 0.09 * 0.09), 0.09, 0}, glm::dvec3(1.0)}), 0u);
}

TEST(OracleGather, KthNearestGivesTheDensity) {
    std::mt19937_64 random(10);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    constexpr int trials = 3000, count = 400, k = 10;
    double sum = 0.0, squares = 0.0;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<Photon> photons;
        for (int i = 0; i < count; ++i) {
            photons.push_back({{place(random), 0.0, place(random)}, {0, i % 2 ? 1 : -1, 0}, glm::dvec3(1.0)});
        }
        const double radius = kth_nearest_distance(floor_point(), k, photons).value();
        ASSERT_EQ(gather(floor_point(), radius, photons).count, k - 1u) << "the k-th itself is outside";
        const double density = (k - 1) / (std::numbers::pi * radius * radius);
        sum += density;
        squares += density * density;
    }
    const double mean = sum / trials;
    const double error = std::sqrt((squares / trials - mean * mean) / trials);
    EXPECT_NEAR(mean, count / 2 / 4.0, 4.0 * error) << "standard error " << error;
    EXPECT_LT(error, 0.01 * mean);
    EXPECT_FALSE(kth_nearest_distance(floor_point(), 2, std::vector<Photon>{photon_at(0.5, 0.0)}));
}

}  // namespace
}  // namespace vkcppm::oracle
