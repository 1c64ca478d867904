// Animations at a time: transforms, weights and joints against values worked out by hand (glTF 2.0, appendix C).

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scene/gltf/gltf.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/loading.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using nlohmann::json;
using test::Float3;
using test::GltfBuilder;

Scene load_at(const GltfBuilder& builder, const std::string& animation, double seconds) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "scene.gltf", builder.gltf());
    return load_gltf(folder / "scene.gltf", {.animation = animation, .at = seconds});
}

int floats(GltfBuilder& builder, const std::vector<float>& values, const char* type, std::size_t components) {
    return builder.accessor(builder.view(values), type, 5126, values.size() / components);
}

/// Adds an animation of one channel of node 0; `type` is that of the output.
void animate(GltfBuilder& builder, const char* name, const char* path, const std::vector<float>& times,
             const std::vector<float>& values, const char* type, std::size_t components,
             const char* interpolation = "LINEAR") {
    const int input = floats(builder, times, "SCALAR", 1), output = floats(builder, values, type, components);
    builder.add("animations", {{"name", name},
                               {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
}

/// Where the second corner, (1, 0, 0) at rest, stands.
glm::dvec3 corner(const GltfBuilder& builder, double seconds, const std::string& animation = "move") {
    return load_at(builder, animation, seconds).positions.at(1);
}

void expect_near(const glm::dvec3& got, const glm::dvec3& want) {
    EXPECT_LE(glm::length(got - want), 1e-6)
        << got.x << ' ' << got.y << ' ' << got.z << " for " << want.x << ' ' << want.y << ' ' << want.z;
}

TEST(Animation, MovesInAStraightLineAndStandsStillOutside) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "move", "translation", {1, 3}, {0, 0, 0, 4, 0, 2}, "VEC3", 3);
    expect_near(corner(builder, 0), {1, 0, 0});
    expect_near(corner(builder, 1), {1, 0, 0});
    expect_near(corner(builder, 1.5), {2, 0, 0.5});
    expect_near(corner(builder, 3), {5, 0, 2});
    expect_near(corner(builder, 99), {5, 0, 2});
    EXPECT_ONE_WARNING(test::load(builder), "animations: at rest");
    EXPECT_EQ(test::warnings_with(load_at(builder, "move", 1), {"animations"}), 0);
}

// At rest the extension changes nothing; in motion what it moves is told of.
TEST(Animation, OfAnythingElseIsLeftAtRest) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "move", "translation", {0, 1}, {0, 0, 0, 4, 0, 2}, "VEC3", 3);
    const json pointer = {{"pointer", "/nodes/0/translation"}};
    builder.document["animations"][0]["channels"][0]["target"] = {{"path", "pointer"},
                                                                  {"extensions", {{"KHR_animation_pointer", pointer}}}};
    builder.document["extensionsRequired"] = builder.document["extensionsUsed"] = {"KHR_animation_pointer"};
    expect_near(test::load(builder).positions.at(1), {1, 0, 0});
    expect_near(corner(builder, 1), {1, 0, 0});
    EXPECT_EQ(test::warnings_with(load_at(builder, "move", 0), {"animations[0].channels[0]", "nodes alone"}), 1);
}

TEST(Animation, WithoutKeyFramesMovesNothing) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "move", "translation", {}, {}, "VEC3", 3);
    expect_near(corner(builder, 1), {1, 0, 0});
    EXPECT_EQ(test::warnings_with(load_at(builder, "move", 0), {"animations[0].channels[0]", "no key frames"}), 1);
}

TEST(Animation, StepsHoldTheirValue) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "move", "scale", {0, 1}, {1, 1, 1, 3, 1, 1}, "VEC3", 3, "STEP");
    expect_near(corner(builder, 0.999), {1, 0, 0});
    expect_near(corner(builder, 1), {3, 0, 0});
}

TEST(Animation, TurnsAlongTheShorterArcAtAnEvenPace) {
    GltfBuilder builder = test::one_triangle();
    const float half = float(std::numbers::sqrt2 / 2.0);
    // To 90 degrees about z, the second quaternion written with the other sign.
    animate(builder, "move", "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -half, -half}, "VEC4", 4);
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
        const double angle = share * std::numbers::pi / 2.0;
        expect_near(corner(builder, share), {std::cos(angle), std::sin(angle), 0});
    }
}

TEST(Animation, CubicSplinesFollowTheirTangents) {
    GltfBuilder builder = test::one_triangle();
    // Key frames at 0 and 2: into, value, out of.
    animate(builder, "move", "translation", {0, 2}, {0, 0, 0, 0, 0, 0, 3, 0, 0, 1, 0, 0, 8, 0, 0, 0, 0, 0}, "VEC3", 3,
            "CUBICSPLINE");
    // At t = 1/4: h = 10/64 of the value 8, 9/64 of the tangent 3 and -3/64 of 1, both times 2 seconds.
    expect_near(corner(builder, 0.5), {1.0 + (10.0 * 8.0 + 9.0 * 2.0 * 3.0 - 3.0 * 2.0 * 1.0) / 64.0, 0, 0});
    expect_near(corner(builder, 2.0), {9, 0, 0});
}

TEST(Animation, TwoKeyFramesAtOneTimeAreAJump) {
    for (const char* interpolation : {"LINEAR", "STEP"}) {
        GltfBuilder builder = test::one_triangle();
        animate(builder, "move", "translation", {0, 1, 1, 2}, {0, 0, 0, 0, 0, 0, 5, 0, 0, 5, 0, 0}, "VEC3", 3,
                interpolation);
        expect_near(corner(builder, 0.999), {1, 0, 0});
        expect_near(corner(builder, 1), {6, 0, 0});
        expect_near(corner(builder, 1.5), {6, 0, 0});
        const std::string told = "animations[0].channels[0]: two key frames at one time";
        EXPECT_EQ(test::warnings_with(load_at(builder, "move", 0), {told}), 1);
    }
}

TEST(Animation, MovesMorphTargetsAndJoints) {
    GltfBuilder builder = test::one_triangle();
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", builder.float3({{0, 0, 0}, {0, 0, 1}, {0, 0, 0}})}},
                            {{"POSITION", builder.float3({{0, 0, 0}, {0, 5, 0}, {0, 0, 0}})}}};
    builder.document["meshes"][0]["weights"] = {1, 1};
    animate(builder, "move", "weights", {0, 1}, {0, 0, 2, 1}, "SCALAR", 1);
    expect_near(corner(builder, 0.5), {1, 2.5, 1});

    const std::vector<std::array<std::uint8_t, 4>> joints(3);
    const std::vector<std::array<float, 4>> weights(3, {1, 0, 0, 0});
    primitive = builder.document["meshes"][0]["primitives"][0];
    builder.document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
        builder.accessor(builder.view(joints), "VEC4", 5121, 3);
    builder.document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        builder.accessor(builder.view(weights), "VEC4", 5126, 3);
    builder.add("skins", {{"joints", {1}}});
    builder.add("nodes", json::object());
    builder.document["nodes"][0]["skin"] = 0;
    animate(builder, "bone", "translation", {0, 1}, {0, 0, 0, 10, 0, 0}, "VEC3", 3);
    builder.document["animations"][1]["channels"][0]["target"]["node"] = 1;
    expect_near(corner(builder, 0.5, "all"), {6, 2.5, 1});
    expect_near(corner(builder, 0.5, "1"), {6, 5, 1});  // by its number, at the weights of the mesh
}

TEST(Animation, IsAnotherSceneAtAnotherTime) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "move", "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3", 3);
    EXPECT_EQ(load_at(builder, "move", 0.5).hash, load_at(builder, "move", 0.5).hash);
    EXPECT_NE(load_at(builder, "move", 0.5).hash, load_at(builder, "move", 0.25).hash);
    EXPECT_NE(load_at(builder, "move", 0.0).hash, test::load(builder).hash);
}

TEST(Animation, WhatIsNotThereIsToldWithWhatIs) {
    GltfBuilder builder = test::one_triangle();
    animate(builder, "walk", "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3", 3);
    const auto error = test::thrown_by([&] { load_at(builder, "run", 0); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
    EXPECT_NE(std::string(error->what()).find("--animation 'run' is none of the animations"), std::string::npos);
    EXPECT_NE(std::string(error->what()).find("0 'walk'"), std::string::npos);
    const Scene still = load_at(test::one_triangle(), "all", 0);
    EXPECT_EQ(still.triangles.size(), 1u);
    EXPECT_EQ(test::warnings_with(still, {"animations: there are none, --animation all moves nothing"}), 1);
}

/// The one line about an animation that cannot be read.
std::string refusal(const GltfBuilder& builder) {
    const auto error = test::thrown_by([&] { load_at(builder, "all", 0.5); });
    if (!error || error->code() != ExitCode::bad_input) return "no refusal";
    return error->what();
}

TEST(Animation, WhatCannotBeIsRefused) {
    GltfBuilder falling = test::one_triangle();
    animate(falling, "move", "translation", {1, 0}, {0, 0, 0, 1, 0, 0}, "VEC3", 3);
    EXPECT_NE(refusal(falling).find("element 1 (input of animations[0].channels[0]) is 0"), std::string::npos);
    GltfBuilder few = test::one_triangle();
    animate(few, "move", "translation", {0, 1}, {0, 0, 0}, "VEC3", 3);
    EXPECT_NE(refusal(few).find("is 3 numbers; its key frames need 6"), std::string::npos) << refusal(few);
    GltfBuilder none = test::one_triangle();
    animate(none, "move", "rotation", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
    EXPECT_NE(refusal(none).find("nodes[0].rotation"), std::string::npos) << refusal(none);
    GltfBuilder lost = test::one_triangle();
    animate(lost, "move", "translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3", 3);
    lost.document["animations"][0]["channels"][0]["sampler"] = 7;
    EXPECT_NE(refusal(lost).find("animations[0].channels[0].sampler is 7; the animation has 1"), std::string::npos);
}

}  // namespace
}  // namespace vkcppm
