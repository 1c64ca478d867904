// Which triangles in one place are kept, and which are moved apart, and how far.

#include "flat/coincidence.h"

#include <algorithm>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr FaceTraits diffuse{0, false, false}, other{1, false, false}, lamp{2, true, false}, glass{3, false, true};

Corners in_plane(float y, float size, bool up) {
    const glm::vec3 a(0, y, 0), b(0, y, size), c(size, y, 0);
    return up ? Corners{a, b, c} : Corners{a, c, b};
}

TEST(Coincidence, OnePlaceHasOneTriangle) {
    const Corners up = in_plane(0.1f, 1.0f, true), down = in_plane(0.1f, 1.0f, false);
    const Corners turned{up[1], up[2], up[0]};
    using Indices = std::vector<std::uint32_t>;
    EXPECT_EQ(distinct_triangles(std::vector{up, down}, std::vector{diffuse, diffuse}), (Indices{0, 1})) << "two sides";
    EXPECT_EQ(distinct_triangles(std::vector{up, turned, up}, std::vector{diffuse, other, diffuse}), (Indices{0}));
    EXPECT_EQ(distinct_triangles(std::vector{up, turned, up}, std::vector{diffuse, lamp, lamp}), (Indices{1}))
        << "the lamp";
    Corners nearly = up;
    nearly[2].x = 1.0000001f;
    EXPECT_EQ(distinct_triangles(std::vector{up, nearly}, std::vector{diffuse, diffuse}), (Indices{0, 1}));
}

TEST(Coincidence, WhatHasNoNormalIsLeftOut) {
    const glm::vec3 a(0.1f, 0.2f, 0.3f), b(0.7f, 0.1f, 0.5f);
    const std::vector<Corners> corners = {{a, a, a},
                                          {a, b, a},
                                          {a, b, 0.5f * (a + b)},
                                          {a, b, 0.5f * (a + b) + glm::vec3(1e-3f, 0, 0)},
                                          {a, b, a + glm::vec3(0, 1e-6f, 0)}};
    EXPECT_EQ(distinct_triangles(corners, std::vector(5, diffuse)), (std::vector<std::uint32_t>{3, 4}));
}

TEST(Coincidence, TwoSidesOfAMeshWhoseInstancesAreKnownLessWellAreFurtherApart) {
    std::vector<Corners> sides = {in_plane(0.1f, 1.0f, true), in_plane(0.1f, 1.0f, false)};
    part_touching_faces(sides, std::vector{diffuse, other}, 1e-3f);
    EXPECT_NEAR(sides[0][0].y - sides[1][0].y, 8e-3f, 1e-4f);
}

/// How far each triangle moves along y, in its rounding errors.
std::vector<float> shifts(const std::vector<Corners>& corners, const std::vector<FaceTraits>& faces) {
    std::vector<Corners> moved = corners;
    part_touching_faces(moved, faces);
    std::vector<float> result;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(moved[i][c].x, corners[i][c].x) << "triangle " << i;
            EXPECT_EQ(moved[i][c].z, corners[i][c].z) << "triangle " << i;
            EXPECT_EQ(moved[i][c].y, moved[i][0].y) << "triangle " << i;
        }
        result.push_back((moved[i][0].y - corners[i][0].y) / position_error(corners[i]));
    }
    return result;
}

TEST(Coincidence, GlassGivesWayToWhatItTouches) {
    const Corners floor = in_plane(0.125f, 1.0f, true), bottom = in_plane(0.125f, 0.5f, false);
    const auto on_floor = shifts({floor, bottom}, {diffuse, glass});
    EXPECT_EQ(on_floor[0], 0.0f);
    EXPECT_GT(on_floor[1], 2.0f);
    EXPECT_LT(on_floor[1], 8.0f);
    const auto on_glass = shifts({in_plane(0.125f, 1.0f, true), bottom}, {glass, glass});
    EXPECT_GT(on_glass[0], 2.0f) << "each out of its own solid, so that nothing is between them";
    EXPECT_LT(on_glass[1], -2.0f);
    EXPECT_EQ(shifts({floor, in_plane(0.126f, 0.5f, false)}, {diffuse, glass}), (std::vector{0.0f, 0.0f})) << "a gap";
    EXPECT_EQ(shifts({floor, in_plane(0.125f, 0.5f, true)}, {diffuse, glass})[1], 0.0f) << "side by side, fronts alike";
    Corners beside = bottom;
    for (glm::vec3& corner : beside) corner.x -= 0.5f;
    EXPECT_EQ(shifts({floor, beside}, {diffuse, glass})[1], 0.0f) << "they share no more than an edge";
}

// Both would go the same way, as far: they would be in one place again.
TEST(Coincidence, GlassGivesWayToWhatItselfGoesToItsFront) {
    const Corners ceiling = in_plane(0.125f, 1.0f, false), up = in_plane(0.125f, 0.5f, true),
                  down = in_plane(0.125f, 0.5f, false);
    const auto gap = [](const std::vector<Corners>& corners, const std::vector<FaceTraits>& faces) {
        std::vector<Corners> moved = corners;
        part_touching_faces(moved, faces);
        return (moved[0][0].y - moved[1][0].y) / position_error(corners[0]);
    };
    const auto is_thin = [](float errors) { return errors > 2.0f && errors < 8.0f; };
    EXPECT_PRED1(is_thin, gap({down, up}, {lamp, glass}));
    EXPECT_PRED1(is_thin, gap({down, up, ceiling}, {lamp, glass, diffuse})) << "on a ceiling";
    EXPECT_PRED1(is_thin, gap({down, up, up}, {diffuse, glass, other})) << "on a side of a sheet";
    EXPECT_PRED1(is_thin, gap({up, up}, {lamp, glass})) << "a lamp that shines away from the glass goes alone";
}

TEST(Coincidence, LampsAndSidesOfSheetsGoToTheirFronts) {
    const Corners panel = in_plane(0.125f, 1.0f, true), small = in_plane(0.125f, 0.5f, true);
    const auto on_panel = shifts({panel, small}, {diffuse, lamp});
    EXPECT_EQ(on_panel[0], 0.0f);
    EXPECT_GT(on_panel[1], 2.0f);
    const Corners back{panel[0], panel[2], panel[1]};
    const auto sheet = shifts({panel, back}, {diffuse, other});
    EXPECT_GT(sheet[0], 2.0f);
    EXPECT_LT(sheet[1], -2.0f);
    EXPECT_EQ(shifts({panel, back}, {diffuse, diffuse}), (std::vector{0.0f, 0.0f})) << "alike on both sides";
}

// Barycentrics of needles are read off a short edge and a long one; attributes go with the corners.
TEST(Coincidence, NeedlesStartAtTheirShortEdge) {
    Scene scene;
    add_material(scene, lambert(glm::vec3(0.5f)));
    add_triangle(scene, {0, 0, 1}, {0.001, 0, 0}, {0, 0, 0}, 0);
    add_triangle(scene, {0, 0, 1}, {0, 0, 0}, {-1, 0, 0}, 0);
    const FlatScene flat = flatten(scene);
    for (std::size_t i = 0; i < 2; ++i) {
        const gpu::TriangleGeometry& g = flat.triangles[i];
        const double sine = glm::length(glm::cross(glm::dvec3(g.e1), glm::dvec3(g.e2))) /
                            (glm::length(glm::dvec3(g.e1)) * glm::length(glm::dvec3(g.e2)));
        EXPECT_GT(sine, 0.5) << "triangle " << i;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3 corner = c == 0 ? g.v0 : g.v0 + (c == 1 ? g.e1 : g.e2);
            const glm::dvec3 want = flat.frame.point(scene.positions[source_of(scene, flat, i).vertex[c]]);
            EXPECT_LT(glm::distance(glm::dvec3(corner), want), 1e-6) << "triangle " << i << ", corner " << c;
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
