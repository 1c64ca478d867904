// The light tree against what it is to hold: every lamp once, whatever their places and powers, and wherever a light
// shines a probability above 0; probabilities of all lamps are 1 together.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "flat/light_tree.h"
#include "oracle/light_tree.h"
#include "support/scenes/lamps.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

/// Whether any of the light arrives at the point, in double precision.
bool shines_at(const gpu::Light& light, const glm::dvec3& point) {
    if (light.kind == LIGHT_TRIANGLE) {
        const glm::dvec3 normal = glm::cross(glm::dvec3(light.e1), glm::dvec3(light.e2));
        return light.double_sided != 0 || glm::dot(point - glm::dvec3(light.position), normal) > 0.0;
    }
    const glm::dvec3 away = point - glm::dvec3(light.position);
    if (light.e2.z > 0.0f && glm::length(away) >= double(light.e2.z)) return false;
    return light.kind == LIGHT_POINT || 1.0 - glm::dot(glm::normalize(away), glm::dvec3(light.e1)) < double(light.e2.y);
}

/// What the tree's lamps are made of, and that each stands in it once.
struct LampLights {
    std::uint32_t lamp;  // branch << 1 | which child
    std::vector<gpu::Light> lights;
};

std::vector<LampLights> lamps_in(const FlatScene& flat) {
    std::vector<LampLights> lamps;
    std::vector<int> seen(flat.lights.size(), 0);
    for (std::uint32_t i = 0; i < 2 * flat.light_tree.size(); ++i) {
        const gpu::LightBranch& branch = flat.light_tree[i / 2];
        const std::uint32_t first = branch.first[i % 2], count = branch.count[i % 2];
        if (count == 0) {
            EXPECT_EQ(flat.light_tree.at(first).parent, i);
            continue;
        }
        LampLights& lamp = lamps.emplace_back(LampLights{i, {}});
        for (std::uint32_t k = first; k < first + count; ++k) {
            const std::uint32_t light = flat.asked_lights.at(k).light;
            ++seen.at(light);
            lamp.lights.push_back(flat.lights[light]);
        }
    }
    EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; })) << "each light stands in the tree once";
    return lamps;
}

TEST(LightTree, FindsEveryLightWhereItShines) {
    for (const double decades : {0.0, 2.0, 15.0}) {
        for (const std::uint32_t count : {2u, 3u, 40u, 400u}) {
            SCOPED_TRACE(fmt::format("{} lamps of {} decades", count, 2.0 * decades));
            const FlatScene flat = flatten(lamps_of_every_kind(count, decades, 1));
            ASSERT_EQ(flat.light_tree.size(), count - 1) << "two triangles of a square are one lamp";
            const std::vector<LampLights> lamps = lamps_in(flat);
            std::mt19937 random(2);
            std::uniform_real_distribution<double> uniform(-1.0, 1.0);
            for (int i = 0; i < 100; ++i) {
                const glm::dvec3 point(uniform(random), uniform(random), uniform(random));
                double sum = 0.0;
                for (const LampLights& lamp : lamps) {
                    const double probability = oracle::lamp_probability(flat.light_tree, lamp.lamp, point);
                    sum += probability;
                    const bool shines = std::ranges::any_of(lamp.lights, [&](auto& l) { return shines_at(l, point); });
                    if (shines) {
                        ASSERT_GT(probability, 0.0) << "lamp " << lamp.lamp << " in sample " << i;
                    }
                }
                // What comes to a branch of which both children are dark is lost.
                ASSERT_LE(sum, 1.0 + 1e-9);
                if (count == 400) {
                    ASSERT_GT(sum, 0.5);
                }
            }
        }
    }
}

// Bulbs shine everywhere: nothing is lost.
TEST(LightTree, HasProbabilitiesThatSumToOne) {
    Scene scene;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 place(uniform(random), uniform(random), uniform(random));
        add_point_light(scene, place, glm::vec3(float(std::pow(10.0, 5.0 * uniform(random)))));
    }
    const FlatScene flat = flatten(scene);
    const std::vector<LampLights> lamps = lamps_in(flat);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 point(uniform(random), uniform(random), uniform(random));
        double sum = 0.0;
        for (const LampLights& lamp : lamps) sum += oracle::lamp_probability(flat.light_tree, lamp.lamp, point);
        EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

Lamp bulb_at(const glm::vec3& place, double intensity) {
    Lamp lamp;
    lamp.count = 1;
    lamp.low = lamp.high = place;
    lamp.spread = 3.2f;
    lamp.reach = FAR;
    lamp.intensity = intensity;
    return lamp;
}

TEST(LightTree, IsShallowWhereLampsAreInOnePlaceOrEverCloser) {
    std::vector<Lamp> same(10000, bulb_at({0.1f, 0.2f, 0.3f}, 1.0));
    EXPECT_EQ(build_light_tree(same).depth, 14u) << "halves";
    std::vector<Lamp> closer;
    for (int i = 0; i < 120; ++i)
        closer.push_back(bulb_at({std::ldexp(1.0f, -i), 0.0f, 0.0f}, std::pow(10.0, i / 2 - 30)));
    EXPECT_LE(build_light_tree(closer).depth, 71u) << "at most 64 by choice, then halves of what is left";
}

// A square lamp is one lamp, and asked for without a tree.
TEST(LightTree, IsNotThereForOneLamp) {
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, add_material(scene, emitter(glm::vec3(1.0f))));
    FlatScene flat = flatten(scene);
    EXPECT_TRUE(flat.light_tree.empty());
    EXPECT_TRUE(flat.lamps.empty());
    ASSERT_EQ(flat.asked.size(), 1u);
    EXPECT_EQ(flat.asked[0].depth, 0u);
    EXPECT_EQ(flat.asked[0].count, 2u);
    add_point_light(scene, {0, 2, 0}, glm::vec3(1e6f));
    flat = flatten(scene);
    EXPECT_EQ(flat.light_tree.size(), 1u);
    EXPECT_EQ(flat.lamps, (std::vector<std::uint32_t>{flat.lamps[0], flat.lamps[0]}));
    EXPECT_EQ(flat.asked[0].depth, 1u);
}

}  // namespace
}  // namespace vkcppm::test
