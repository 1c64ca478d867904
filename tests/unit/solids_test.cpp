// How solids of glass lie to one another, against arrangements of boxes where it is plain.

#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "flat/solids.h"
#include "support/scenes/materials.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t outer = 0, inner = 1;

Scene two_glasses() {
    Scene scene;
    add_material(scene, glass(1.5f));
    add_material(scene, glass(1.33f));
    scene.materials[outer].name = "glass";
    scene.materials[inner].name = "water";
    return scene;
}

std::string nested(const Scene& scene) { return nested_solids(scene, solid_shells(scene, traits_of(scene))); }

std::vector<std::uint32_t> priorities(const Scene& scene) {
    const std::vector<MaterialTraits> traits = traits_of(scene);
    return priorities_of(scene, traits, solid_shells(scene, traits));
}

TEST(Solids, AreNestedWhereOneIsInAnotherOrTheyCross) {
    const auto with = [](const glm::dvec3& low, const glm::dvec3& high) {
        Scene scene = two_glasses();
        add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
        add_box(scene, low, high, inner, false);
        return scene;
    };
    EXPECT_EQ(nested(with({2, 0, 0}, {3, 1, 1})), "") << "apart";
    EXPECT_EQ(nested(with({0.5, 1.001, 0.5}, {0.7, 2, 0.7})), "") << "a small gap";
    EXPECT_NE(nested(with({0.2, 0.2, 0.2}, {0.7, 0.7, 0.7})), "") << "inside";
    EXPECT_NE(nested(with({-1, -1, -1}, {2, 2, 2})), "") << "round it";
    EXPECT_NE(nested(with({0.5, 0.5, 0.5}, {1.5, 1.4, 1.3})), "") << "a corner in it";
    EXPECT_NE(nested(with({0, 0.9, 0}, {1, 1.7, 1})), "") << "into its top, flush with its sides";
    EXPECT_NE(nested(with({-1, 0.3, 0.4}, {2, 0.6, 0.7})), "") << "through it, without a corner inside";
    const std::string words = nested(with({0.2, 0.2, 0.2}, {0.7, 0.7, 0.7}));
    EXPECT_NE(words.find("glass"), std::string::npos) << words;
    EXPECT_NE(words.find("water"), std::string::npos) << words;
    Scene thin = with({0.2, 0.2, 0.2}, {0.7, 0.7, 0.7});
    thin.materials[inner].thickness = 0.0f;
    EXPECT_EQ(nested(thin), "") << "no solid";
}

TEST(Solids, InTheHollowOfAnotherAreNotNested) {
    Scene scene = two_glasses();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(scene, {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, outer, true);
    EXPECT_EQ(nested(scene), "") << "hollow";
    add_box(scene, {0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}, inner, false);
    EXPECT_EQ(nested(scene), "") << "with water in it that does not touch";
    EXPECT_EQ(flatten(scene).nested, "");
    EXPECT_TRUE(flatten(scene).solids.empty()) << "costs nothing";
    Scene filled = two_glasses();
    add_box(filled, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(filled, {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, outer, true);
    add_box(filled, {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, inner, false);
    EXPECT_NE(flatten(filled).nested, "") << "with water up to its walls";
}

TEST(Solids, TheSmallerCounts) {
    Scene scene = two_glasses();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(scene, {0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, outer, true);         // 0.488 m^3 of glass
    add_box(scene, {0.05, 0.05, 0.05}, {0.95, 0.95, 0.95}, inner, false);  // 0.729 m^3 of water
    add_material(scene, lambert(glm::vec3(0.5f)));
    EXPECT_EQ(priorities(scene), (std::vector<std::uint32_t>{2, 1, 0}));
    add_box(scene, {0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}, inner, false);  // 0.365 m^3 in the mean
    EXPECT_EQ(priorities(scene), (std::vector<std::uint32_t>{1, 2, 0}));
}

TEST(Solids, ThatTouchByTheirEdgesAreTwo) {
    Scene scene = two_glasses();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(scene, {0, 1, 0}, {1, 1.5, 1}, inner, false);
    EXPECT_EQ(priorities(scene), (std::vector<std::uint32_t>{1, 2}));
}

TEST(Solids, OfOneBodyAreOne) {
    Scene scene = two_glasses();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(scene, {0.2, 0.2, 0.2}, {0.7, 0.7, 0.7}, inner, false);
    const std::uint32_t lid = add_material(scene, glass(1.33f));
    scene.triangles.back().material = scene.triangles[scene.triangles.size() - 2].material = lid;
    EXPECT_EQ(priorities(scene), (std::vector<std::uint32_t>{1, 2, 2}));
}

TEST(Solids, AreKnownToThePointInThem) {
    Scene scene = two_glasses();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, outer, false);
    add_box(scene, {0.5, 0.5, 0.5}, {0.8, 0.8, 0.8}, inner, false);
    add_box(scene, {0.6, 0.6, 0.6}, {0.9, 0.9, 0.9}, inner, false);
    const FlatScene flat = flatten(scene);
    const auto at = [&](const glm::dvec3& world) { return media_at(flat.solids, flat.frame.point(world)); };
    constexpr std::uint32_t none = 0xffffffffu, none_twice = 0xffff0000u;
    EXPECT_EQ(at({2, 2, 2}).first, PATH_NO_MEDIUM);
    EXPECT_EQ(at({0.1, 0.2, 0.3}).first, outer);
    EXPECT_EQ(at({0.1, 0.2, 0.3}).others, glm::uvec2(none));
    EXPECT_EQ(at({0.55, 0.55, 0.55}).first, inner);
    EXPECT_EQ(at({0.55, 0.55, 0.55}).others, glm::uvec2(none_twice | outer, none));
    EXPECT_EQ(at({0.7, 0.7, 0.7}).first, inner) << "in two of a kind";
    EXPECT_EQ(at({0.7, 0.7, 0.7}).others, glm::uvec2(inner | outer << 16, none));
}

}  // namespace
}  // namespace vkcppm::test
