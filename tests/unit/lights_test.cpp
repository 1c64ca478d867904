// The table of lights.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

// So that the same random numbers choose the same light, whatever tree is built over the triangles.
TEST(Lights, StandInTheOrderOfTheScene) {
    Scene scene;
    const auto emitter = add_material(scene, test::emitter(glm::vec3(1.0f)));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        const glm::dvec3 p(place(random), place(random), place(random));
        add_triangle(scene, p, p + glm::dvec3(0.1, 0, 0), p + glm::dvec3(0, 0.1, 0), emitter);
    }
    const FlatScene flat = flatten(scene);
    ASSERT_FALSE(std::ranges::is_sorted(flat.bvh.order)) << "the tree must move triangles for this to tell anything";
    ASSERT_EQ(flat.lights.size(), 100u);
    for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(flat.bvh.order[flat.lights[i].triangle], i) << "light " << i;
}

}  // namespace
}  // namespace vkcppm::test
