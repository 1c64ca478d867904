#include "scene/diagnosis/shell.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "support/scenes/shapes.h"

namespace vkcppm {
namespace {

std::vector<std::uint32_t> all_triangles(const Scene& scene) {
    std::vector<std::uint32_t> triangles(scene.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0u);
    return triangles;
}

std::vector<Shell> shells_of(const Scene& scene) { return find_shells(scene, all_triangles(scene)); }

/// A box of 1 x 2 x 3 m; every triangle has vertices of its own.
Scene box_scene(bool inwards = false) {
    Scene scene;
    test::add_box(scene, {1.0, 0.0, -1.0}, {2.0, 2.0, 2.0}, test::add_material(scene, test::glass(1.5f)), inwards);
    return scene;
}

TEST(Shell, OfABoxIsClosedAndEnclosesItsVolume) {
    const std::vector<Shell> shells = shells_of(box_scene());
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].triangles.size(), 12u);
    EXPECT_EQ(shells[0].open_edges, 0u);
    EXPECT_EQ(shells[0].twisted_edges, 0u);
    EXPECT_NEAR(shells[0].volume, 6.0, 1e-12);
    EXPECT_EQ(shells[0].low, glm::dvec3(1.0, 0.0, -1.0));
    EXPECT_EQ(shells[0].high, glm::dvec3(2.0, 2.0, 2.0));
    EXPECT_TRUE(shells[0].is_closed());
}

TEST(Shell, TurnedInsideOutHasANegativeVolume) {
    const std::vector<Shell> shells = shells_of(box_scene(true));
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_NEAR(shells[0].volume, -6.0, 1e-12);
    EXPECT_TRUE(shells[0].is_closed());
}

TEST(Shell, OfASphereWithSeamsIsClosed) {
    Scene scene;
    test::add_sphere(scene, {5.0, 6.0, 7.0}, 2.0, 4, test::add_material(scene, test::glass(1.5f)), true);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_TRUE(shells[0].is_closed()) << shells[0].open_edges << " open, " << shells[0].twisted_edges << " twisted";
    const double ball = 4.0 / 3.0 * std::numbers::pi * 8.0;
    EXPECT_LT(shells[0].volume, ball);
    EXPECT_GT(shells[0].volume, 0.98 * ball);
}

// Spheres and tubes are commonly made of rows of vertices by sine and cosine, whose last column, and whose poles, are
// where the first ones are but for rounding; in floats for much more than in doubles.
template <typename Float> void expect_closed_in_rows_of(std::uint32_t columns, std::uint32_t rows) {
    Scene scene;
    const std::uint32_t material = test::add_material(scene, test::glass(1.5f));
    const auto pi = Float(std::numbers::pi);
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const Float v = Float(row) / Float(rows) * pi, u = Float(column) / Float(columns) * Float(2) * pi;
            const glm::vec3 p(-std::cos(u) * std::sin(v), std::cos(v), std::sin(u) * std::sin(v));
            scene.positions.push_back(glm::dvec3(3, 2, 1) + 0.25 * glm::dvec3(p));
        }
    }
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t b = row * (columns + 1) + column, a = b + 1, c = b + columns + 1, d = c + 1;
            if (row > 0) scene.triangles.push_back({{a, b, d}, material});
            if (row + 1 < rows) scene.triangles.push_back({{b, c, d}, material});
        }
    }
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].triangles.size(), scene.triangles.size());
    EXPECT_TRUE(shells[0].is_closed()) << shells[0].open_edges << " open, " << shells[0].twisted_edges << " twisted";
}

TEST(Shell, WhoseSeamsDifferByRoundingIsClosed) {
    for (const std::uint32_t columns : {3, 8, 32, 500}) {
        SCOPED_TRACE(columns);
        expect_closed_in_rows_of<float>(columns, columns / 2 + 1);
        expect_closed_in_rows_of<double>(columns, columns / 2 + 1);
    }
}

// What is apart by more than rounding stays so: here a gap of 10^-5 of the box.
TEST(Shell, WithAGapIsOpen) {
    Scene scene = box_scene();
    for (const std::size_t i : {0, 1}) {
        for (const std::uint32_t vertex : scene.triangles[i].vertex) scene.positions[vertex] *= 1.0 + 1e-5;
    }
    EXPECT_FALSE(shells_of(scene).front().is_closed());
}

TEST(Shell, WithoutAFaceHasItsEdgesOpen) {
    Scene scene = box_scene();
    scene.triangles.resize(10);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].open_edges, 4u);
    EXPECT_EQ(shells[0].twisted_edges, 0u);
    EXPECT_FALSE(shells[0].is_closed());
}

TEST(Shell, WithAFaceTurnedOverIsTwisted) {
    Scene scene = box_scene();
    for (const std::size_t i : {0, 1}) std::swap(scene.triangles[i].vertex[1], scene.triangles[i].vertex[2]);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].open_edges, 0u);
    EXPECT_EQ(shells[0].twisted_edges, 4u);
    EXPECT_FALSE(shells[0].is_closed());
}

TEST(Shell, OfTwoSheetsThatLieOnOneAnotherIsFlat) {
    Scene scene;
    const std::uint32_t glass = test::add_material(scene, test::glass(1.5f));
    const glm::dvec3 corner(0.3, 0.1, 0.7), u(1.0, 0.2, 0.1), v(-0.3, 0.9, 0.4);
    test::add_quad(scene, corner, u, v, glass);
    test::add_triangle(scene, corner, corner + u + v, corner + u, glass);
    test::add_triangle(scene, corner, corner + v, corner + u + v, glass);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].open_edges + shells[0].twisted_edges, 0u);
    EXPECT_TRUE(shells[0].is_flat()) << "volume " << shells[0].volume;
    EXPECT_FALSE(shells[0].is_closed());
}

TEST(Shell, IsAPieceForItself) {
    Scene scene = box_scene();
    test::add_box(scene, {4.0, 0.0, 0.0}, {5.0, 1.0, 1.0}, 0, false);
    test::add_box(scene, {5.0, 1.0, 1.0}, {6.0, 2.0, 2.0}, 0, true);  // touches the one before in a corner
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 3u);
    EXPECT_EQ(shells[0].triangles.front(), 0u);
    EXPECT_NEAR(shells[1].volume, 1.0, 1e-12);
    EXPECT_NEAR(shells[2].volume, -1.0, 1e-12);
}

TEST(Shell, StaysClosedWhereBoxesShareAnEdge) {
    Scene scene;
    test::add_material(scene, test::glass(1.5f));
    test::add_box(scene, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 0, false);
    test::add_box(scene, {1.0, 1.0, 0.0}, {2.0, 2.0, 1.0}, 0, false);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_TRUE(shells[0].is_closed()) << shells[0].open_edges << " open, " << shells[0].twisted_edges << " twisted";
    EXPECT_NEAR(shells[0].volume, 2.0, 1e-12);
}

TEST(Shell, LooksAtTheGivenTrianglesOnly) {
    Scene scene = box_scene();
    test::add_box(scene, {4.0, 0.0, 0.0}, {5.0, 1.0, 1.0}, 0, false);
    EXPECT_TRUE(find_shells(scene, {}).empty());
    const std::vector<std::uint32_t> some = {12, 13, 14, 15};
    const std::vector<Shell> shells = find_shells(scene, some);
    ASSERT_EQ(shells.size(), 2u) << "two opposite faces";
    EXPECT_EQ(shells[0].triangles, (std::vector<std::uint32_t>{12, 13}));
    EXPECT_EQ(shells[1].triangles, (std::vector<std::uint32_t>{14, 15}));
    EXPECT_EQ(shells[0].open_edges, 4u);
}

TEST(Shell, LeavesOutTrianglesWithTwoCornersAtOnePlace) {
    Scene scene = box_scene();
    test::add_triangle(scene, {1.0, 0.0, -1.0}, {2.0, 0.0, -1.0}, {2.0, 0.0, -1.0}, 0);
    const std::vector<Shell> shells = shells_of(scene);
    ASSERT_EQ(shells.size(), 1u);
    EXPECT_EQ(shells[0].triangles.size(), 12u);
    EXPECT_TRUE(shells[0].is_closed());
}

TEST(Shell, WindsOnceAroundWhatIsInside) {
    const Scene outwards = box_scene(), inwards = box_scene(true);
    const Shell shell = shells_of(outwards).at(0), inverse = shells_of(inwards).at(0);
    for (const glm::dvec3& inside : {glm::dvec3(1.5, 1.0, 0.5), glm::dvec3(1.001, 0.001, -0.999)}) {
        EXPECT_NEAR(winding_number(outwards, shell, inside), 1.0, 1e-9);
        EXPECT_NEAR(winding_number(inwards, inverse, inside), -1.0, 1e-9);
    }
    for (const glm::dvec3& outside : {glm::dvec3(0.999, 1.0, 0.5), glm::dvec3(100.0, -50.0, 3.0)}) {
        EXPECT_NEAR(winding_number(outwards, shell, outside), 0.0, 1e-9);
    }
    for (const glm::dvec3& on_a_face : {glm::dvec3(1.0, 1.1, 0.3), glm::dvec3(1.7, 0.0, 0.1)}) {
        EXPECT_NEAR(winding_number(outwards, shell, on_a_face), 0.5, 1e-9);
    }
    EXPECT_NEAR(winding_number(outwards, shell, {1.0, 0.7, -1.0}), 0.25, 1e-9) << "on an edge";
    EXPECT_NEAR(winding_number(outwards, shell, {1.0, 0.0, -1.0}), 0.125, 1e-9) << "on a corner";
}

TEST(Shell, WindsHalfAroundAPointOnAnyOfItsFaces) {
    Scene scene;
    test::add_sphere(scene, {5.1, 6.2, 7.3}, 2.0, 2, test::add_material(scene, test::glass(1.5f)), false);
    const Shell shell = shells_of(scene).at(0);
    for (const Triangle& triangle : scene.triangles) {
        const auto& [a, b, c] = triangle.vertex;
        const glm::dvec3 point = 0.2 * scene.positions[a] + 0.3 * scene.positions[b] + 0.5 * scene.positions[c];
        EXPECT_NEAR(winding_number(scene, shell, point), 0.5, 1e-9);
    }
}

}  // namespace
}  // namespace vkcppm
