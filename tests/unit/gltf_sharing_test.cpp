// Which meshes of a glTF file are stored once, and that with or without it the scene shows the same.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/features.h"
#include "flat/flatten.h"
#include "scene/diagnosis/diagnosis.h"
#include "scene/diagnosis/glass.h"
#include "scene/gltf/gltf.h"
#include "scene/instances.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/instanced.h"
#include "support/scenes/loading.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::GltfBuilder;

Scene load(const GltfBuilder& builder, Sharing sharing) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    return load_gltf(folder / "scene.gltf", {.sharing = sharing});
}

/// Corners and normals of triangles, in an order that does not hang on that of nodes.
std::vector<std::array<double, 6>> sorted_corners(const Scene& scene) {
    std::vector<std::array<double, 6>> all;
    for (const Triangle& triangle : scene.triangles) {
        for (const std::uint32_t v : triangle.vertex) {
            const glm::dvec3 p = scene.positions[v], n(scene.normals[v]);
            const auto round = [](double x) { return std::round(x * 1e5) / 1e5 + 0.0; };
            all.push_back({round(p.x), round(p.y), round(p.z), round(n.x), round(n.y), round(n.z)});
        }
    }
    std::ranges::sort(all);
    return all;
}

void expect_same(const Scene& got, const Scene& want) {
    const auto a = sorted_corners(got), b = sorted_corners(want);
    ASSERT_EQ(a.size(), b.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (int c = 0; c < 6; ++c) differing += std::abs(a[i][c] - b[i][c]) > 3e-5;
    }
    EXPECT_LE(differing, a.size() / 1000) << "of " << 6 * a.size() << " numbers";
}

TEST(Sharing, ShowsWhatCopiesShow) {
    const GltfBuilder builder = test::instanced_spheres(50, 200);
    const Scene shared = load(builder, Sharing::always), copies = load(builder, Sharing::never);
    EXPECT_EQ(shared.instances.size(), 50u);
    ASSERT_EQ(shared.meshes.size(), 1u);
    EXPECT_NEAR(double(triangles_of_mesh(shared, 0).count()), 200.0, 20.0);
    EXPECT_TRUE(copies.instances.empty() && copies.meshes.empty());
    EXPECT_EQ(shown_triangles(shared), copies.triangles.size());
    expect_same(test::copied(shared), copies);
    const SceneBox box = world_box(shared), exact = world_box(copies);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(box.low[axis], exact.low[axis]);
        EXPECT_GE(box.high[axis], exact.high[axis]);
        EXPECT_LT(box.high[axis] - box.low[axis], 1.02 * (exact.high[axis] - exact.low[axis]));
    }
    EXPECT_EQ(diagnose(shared), diagnose(copies));
}

TEST(Sharing, FollowsCost) {
    EXPECT_TRUE(load(test::instanced_spheres(50, 200), Sharing::by_cost).meshes.empty()) << "copies are few";
    const Scene many = load(test::instanced_spheres(3000, 200), Sharing::by_cost);
    EXPECT_EQ(many.instances.size(), 3000u);
    EXPECT_LT(many.triangles.size(), 300u);
    EXPECT_TRUE(load(test::instanced_spheres(60000, 6), Sharing::by_cost).meshes.empty()) << "triangles are few";
    EXPECT_TRUE(load(test::instanced_spheres(1, 200), Sharing::always).meshes.empty()) << "it is used once";
}

/// Nodes of the first mesh.
GltfBuilder with_nodes(const json& nodes) {
    GltfBuilder builder = test::one_triangle();
    builder.document["nodes"] = nodes;
    return builder;
}

TEST(Sharing, LeavesOutWhatCannotBeShared) {
    const json plain = {{"mesh", 0}}, moved = {{"mesh", 0}, {"translation", {3, 0, 0}}};
    const json flat = {{"mesh", 0}, {"scale", {1, 0, 1}}};
    const json sheared = {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 1, 1e-6, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
    const Scene two = load(with_nodes({plain, moved}), Sharing::always);
    EXPECT_EQ(two.instances.size(), 2u);
    EXPECT_EQ(world_triangles(two).count(), 0u);
    EXPECT_EQ(two.mesh_nodes.size(), 2u);
    const Scene dropped = load(with_nodes({plain, moved, flat}), Sharing::always);
    EXPECT_EQ(dropped.instances.size(), 2u);
    EXPECT_ONE_WARNING(dropped, "singular");
    const Scene copied = load(with_nodes({plain, sheared, moved}), Sharing::always);
    EXPECT_EQ(copied.instances.size(), 2u);
    EXPECT_EQ(world_triangles(copied).count(), 1u) << "shears so much that it is copied";
    expect_same(test::copied(copied), load(with_nodes({plain, sheared, moved}), Sharing::never));

    GltfBuilder lamp = with_nodes({plain, moved});
    lamp.add("materials", {{"emissiveFactor", {1, 1, 1}}});
    lamp.document["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_TRUE(load(lamp, Sharing::always).meshes.empty()) << "lights are in world space";
}

TEST(Sharing, MillionsOfTrianglesAreShownByFew) {
    // They show more triangles than any scene may have.
    const Scene scene = load(test::instanced_spheres(20000, 9800), Sharing::by_cost);
    EXPECT_EQ(shown_triangles(scene), 20000 * triangles_of_mesh(scene, 0).count() + 4);
    EXPECT_GT(shown_triangles(scene), std::size_t(1) << 27);
    EXPECT_LT(scene.triangles.size(), 10000u);
}

TEST(Sharing, ThinGlassBecomesSolidInASharedMeshAsWell) {
    GltfBuilder builder = test::instanced_spheres(20, 200);
    builder.document["extensionsUsed"].push_back("KHR_materials_transmission");
    builder.document["materials"][0]["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1.0}};
    Scene scene = load(builder, Sharing::always);
    EXPECT_EQ(std::ranges::count_if(diagnose(scene),
                                    [](const std::string& line) {
                                        return line.find("glass without a volume on a closed mesh") != line.npos;
                                    }),
              1);
    make_glass_solid(scene);
    EXPECT_GT(scene.materials[0].thickness, 0.0f);
    EXPECT_TRUE(diagnose(scene).empty());
}

TEST(FlatInstances, EachTriangleAndEachInstanceHasItsPlace) {
    const Scene scene = load(test::instanced_spheres(300, 200), Sharing::always);
    const FlatScene flat = flatten(scene);
    EXPECT_EQ(flat.triangles.size(), scene.triangles.size());
    std::vector<std::uint32_t> order = flat.bvh.order;
    std::ranges::sort(order);
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
    ASSERT_EQ(flat.instances.size(), 300u);
    std::vector<int> found(300);
    for (const gpu::BvhNode& node : flat.bvh.nodes) {
        if (node.exponents & BVH_INSTANCE) ++found.at(node.exponents & ~BVH_INSTANCE);
    }
    EXPECT_EQ(std::ranges::count(found, 1), 300);
    EXPECT_NE(bits_of(flat.features) & FEATURE_INSTANCES, 0u);
    const FlatScene copies = flatten(load(test::instanced_spheres(300, 200), Sharing::never));
    EXPECT_EQ(bits_of(copies.features) & FEATURE_INSTANCES, 0u);
    EXPECT_NEAR(flat.area / copies.area, 1.0, 0.02);
    EXPECT_EQ(flat.frame.scale, copies.frame.scale);
}

}  // namespace
}  // namespace vkcppm
