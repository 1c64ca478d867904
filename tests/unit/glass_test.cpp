#include "scene/diagnosis/glass.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/scenes/shapes.h"

namespace vkcppm {
namespace {

std::uint32_t add_thin_glass(Scene& scene) {
    const std::uint32_t glass = test::add_material(scene, test::glass(1.5f));
    scene.materials[glass].thickness = 0.0f;
    return glass;
}

TEST(Glass, TransmitsAndIsNoMetalAllOver) {
    Material material;
    material.metallic = 0.0f;
    EXPECT_FALSE(is_glass(material));
    material.transmission = 0.1f;
    EXPECT_TRUE(is_glass(material));
    EXPECT_FALSE(is_solid_glass(material));
    material.thickness = 0.01f;
    EXPECT_TRUE(is_solid_glass(material));
    material.metallic = 1.0f;
    EXPECT_FALSE(is_glass(material));
    material.metallic_roughness_texture = Texture{};
    EXPECT_TRUE(is_glass(material)) << "the texture may take the metal away";
}

TEST(Glass, BecomesSolidOnClosedMeshesInPlace) {
    Scene scene;
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, add_thin_glass(scene), false);
    make_glass_solid(scene);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_GT(scene.materials[0].thickness, 0.0f);
}

TEST(Glass, IsDividedWhereItsMaterialIsOnOpenMeshesToo) {
    Scene scene;
    test::add_material(scene, test::lambert(glm::vec3(0.5f)));
    const std::uint32_t glass = add_thin_glass(scene);
    scene.materials[glass].name = "pane";
    test::add_quad(scene, {5, 0, 0}, {1, 0, 0}, {0, 1, 0}, glass);
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, glass, false);
    test::add_quad(scene, {7, 0, 0}, {1, 0, 0}, {0, 1, 0}, glass);
    test::add_box(scene, {2, 0, 0}, {3, 1, 1}, glass, false);
    make_glass_solid(scene);
    ASSERT_EQ(scene.materials.size(), 3u) << "one copy for both boxes";
    EXPECT_EQ(scene.materials[glass].thickness, 0.0f);
    EXPECT_GT(scene.materials[2].thickness, 0.0f);
    EXPECT_EQ(scene.materials[2].name, "pane");
    EXPECT_EQ(scene.materials[2].ior, 1.5f);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const bool of_a_pane = i < 2 || i == 14 || i == 15;
        EXPECT_EQ(scene.triangles[i].material, of_a_pane ? glass : 2u) << "triangle " << i;
    }
}

TEST(Glass, StaysAsItIsElsewhere) {
    Scene scene;
    const std::uint32_t solid = test::add_material(scene, test::glass(1.5f));
    scene.materials[solid].thickness = 0.25f;
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, solid, false);
    test::add_quad(scene, {5, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_thin_glass(scene));
    test::add_box(scene, {2, 0, 0}, {3, 1, 1}, test::add_material(scene, test::lambert(glm::vec3(0.5f))), false);
    make_glass_solid(scene);
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].thickness, 0.25f);
    EXPECT_EQ(scene.materials[1].thickness, 0.0f);
    EXPECT_EQ(scene.materials[2].thickness, 0.0f);
}

}  // namespace
}  // namespace vkcppm
