// Skins: vertices stand where their joints put them, worked out by hand (glTF 2.0, section 3.7.3).

#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "support/scenes/loading.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::expect_bad_scene;
using test::Float3;
using test::GltfBuilder;
using test::load;

using Joints = std::vector<std::array<std::uint8_t, 4>>;
using Weights = std::vector<std::array<float, 4>>;

/// The triangle (0,0,0), (1,0,0), (0,1,0) of node 0, bound to nodes 1 and 2.
GltfBuilder bound(const Joints& joints, const Weights& weights) {
    GltfBuilder builder = test::one_triangle();
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = builder.accessor(builder.view(joints), "VEC4", 5121, joints.size());
    attributes["WEIGHTS_0"] = builder.accessor(builder.view(weights), "VEC4", 5126, weights.size());
    builder.add("nodes", json::object());
    builder.add("nodes", json::object());
    builder.document["nodes"][0]["skin"] = builder.add("skins", {{"joints", {1, 2}}});
    return builder;
}

GltfBuilder bound_to_first() { return bound(Joints(3, {0, 0, 0, 0}), Weights(3, {1, 0, 0, 0})); }

/// Moves what the joints hold before they move it: inverse bind matrices of pure translation.
void bind_at(GltfBuilder& builder, const std::vector<Float3>& inverse_translations) {
    std::vector<float> matrices;
    for (const Float3& t : inverse_translations) {
        matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t[0], t[1], t[2], 1});
    }
    builder.document["skins"][0]["inverseBindMatrices"] =
        builder.accessor(builder.view(matrices), "MAT4", 5126, inverse_translations.size());
}

void expect_positions(const Scene& scene, const std::vector<glm::dvec3>& expected) {
    ASSERT_EQ(scene.positions.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_LE(glm::length(scene.positions[i] - expected[i]), 1e-6)
            << i << ": " << scene.positions[i].x << ' ' << scene.positions[i].y << ' ' << scene.positions[i].z;
    }
}

TEST(Skins, JointsPlaceTheMeshAndItsNodeDoesNot) {
    GltfBuilder builder = bound_to_first();
    builder.document["nodes"][0]["translation"] = {5, 5, 5};
    builder.document["nodes"][1]["translation"] = {0, 0, 2};
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.warnings.size() == 1) << test::all_warnings(scene);  // there is no camera
    expect_positions(scene, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
}

TEST(Skins, AJointTurnsAboutWhereItIsBound) {
    GltfBuilder builder = bound_to_first();
    bind_at(builder, {{-1, 0, 0}, {0, 0, 0}});
    const double half = std::numbers::sqrt2 / 2.0;
    builder.document["nodes"][1] = {{"translation", {1, 0, 0}}, {"rotation", {0, 0, half, half}}};
    // About (1, 0, 0) by 90 degrees: x becomes y, y becomes -x.
    expect_positions(load(builder), {{1, -1, 0}, {1, 0, 0}, {0, -1, 0}});
}

TEST(Skins, WeightsBlendAndAreTakenInProportion) {
    GltfBuilder builder = bound(Joints(3, {0, 1, 1, 0}), {{1, 1, 0, 0}, {0.25f, 0.75f, 0, 0}, {0, 2, 2, 0}});
    builder.document["nodes"][2]["translation"] = {0, 0, 4};
    expect_positions(load(builder), {{0, 0, 2}, {1, 0, 3}, {0, 1, 4}});
}

TEST(Skins, AllSetsOfJointsCount) {
    GltfBuilder builder = bound_to_first();
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] = builder.accessor(builder.view(Joints(3, {1, 0, 0, 0})), "VEC4", 5121, 3);
    attributes["WEIGHTS_1"] = builder.accessor(builder.view(Weights(3, {1, 0, 0, 0})), "VEC4", 5126, 3);
    builder.document["nodes"][2]["translation"] = {0, 0, 4};
    expect_positions(load(builder), {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}});
}

TEST(Skins, NormalsFollowAndAMirrorTurnsTheCorners) {
    GltfBuilder builder = bound_to_first();
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = builder.float3({{0, 0, 1}, {0, 0, 1}, {0.6f, 0, 0.8f}});
    builder.document["nodes"][1]["scale"] = {2, 1, -1};
    const Scene scene = load(builder);
    // Mirrored in z: the front looks to -z, and so do the normals, by the inverse transpose.
    const Triangle& t = scene.triangles.at(0);
    const glm::dvec3 p0 = scene.positions[t.vertex[0]];
    EXPECT_LT(glm::cross(scene.positions[t.vertex[1]] - p0, scene.positions[t.vertex[2]] - p0).z, 0.0);
    const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, 0, -0.8f));
    EXPECT_LE(glm::length(scene.normals[2] - tilted), 1e-6f);
    EXPECT_LE(glm::length(scene.normals[0] - glm::vec3(0, 0, -1)), 1e-6f);
}

TEST(Skins, NodesOfOneMeshFollowSkinsOfTheirOwn) {
    GltfBuilder builder = bound_to_first();
    builder.add("skins", {{"joints", {2, 1}}});
    builder.add("nodes", {{"mesh", 0}, {"skin", 1}});
    builder.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 9}}});
    builder.document["nodes"][1]["translation"] = {0, 0, 1};
    builder.document["nodes"][2]["translation"] = {0, 0, 2};
    expect_positions(
        load(builder),
        {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}});
}

TEST(Skins, WhatIsOddIsTold) {
    GltfBuilder outside = bound_to_first();
    outside.add("scenes", {{"nodes", {0}}});
    outside.document["nodes"][0]["translation"] = {0, 0, 3};
    const Scene ignored = load(outside);
    EXPECT_ONE_WARNING(ignored, "skins[0] (nodes[1])", "not in the scene");
    expect_positions(ignored, {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}});

    GltfBuilder weightless = bound(Joints(3, {1, 0, 0, 0}), Weights(3, {0, 0, 0, 0}));
    weightless.document["nodes"][1]["translation"] = {0, 0, 1};
    const Scene first = load(weightless);
    EXPECT_ONE_WARNING(first, "without weights");
    expect_positions(first, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});

    GltfBuilder bare = bound_to_first();
    bare.document["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
    bare.document["nodes"][0]["translation"] = {0, 0, 3};
    const Scene unbound = load(bare);
    EXPECT_ONE_WARNING(unbound, "no joints and weights");
    expect_positions(unbound, {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}});
}

TEST(Skins, WhatCannotBeIsRefused) {
    expect_bad_scene(bound(Joints(3, {2, 0, 0, 0}), Weights(3, {1, 0, 0, 0})).gltf(),
                     {"joint 0 of vertex 0", "is 2", "its skin has 2"});
    GltfBuilder few = bound_to_first();
    bind_at(few, {{0, 0, 0}});
    expect_bad_scene(few.gltf(), {"inverseBindMatrices of skins[0]", "is 1", "2 joints"});
    GltfBuilder nowhere = bound_to_first();
    nowhere.document["skins"][0]["joints"] = {1, 9};
    expect_bad_scene(nowhere.gltf(), {"skins[0].joints[1] is 9", "nodes has 3"});
    GltfBuilder vast = bound_to_first();
    bind_at(vast, {{1e38f, 0, 0}, {0, 0, 0}});
    vast.document["nodes"][1]["scale"] = {1e30, 1, 1};
    expect_bad_scene(vast.gltf(), {"position of a vertex of nodes[0]"});
}

}  // namespace
}  // namespace vkcppm
