// Every reason for which a caustic may be missing is told where it is there, and is not where it is not.

#include "scene/diagnosis/diagnosis.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "scene/diagnosis/glass.h"
#include "support/files/places.h"
#include "support/scenes/scenes.h"
#include "support/scenes/shapes.h"

namespace vkcppm {
namespace {

/// The one line of the diagnosis holds all of the parts; without parts there is none.
void expect_told(const Scene& scene, const std::vector<std::string>& parts) {
    const std::vector<std::string> lines = diagnose(scene);
    const std::string all = fmt::format("{}", fmt::join(lines, "\n"));
    ASSERT_EQ(lines.size(), parts.empty() ? 0u : 1u) << all;
    for (const std::string& part : parts) EXPECT_NE(all.find(part), all.npos) << "'" << part << "' is not in\n" << all;
}

/// A lamp above the origin, out of the way of everything, and the material 0: glass with a volume named 'crystal'.
Scene lit_scene() {
    Scene scene;
    scene.file = "test.gltf";
    test::add_material(scene, test::glass(1.5f));
    scene.materials[0].name = "crystal";
    test::add_quad(scene, {0, 9, 0}, {1, 0, 0}, {0, 0, 1}, test::add_material(scene, test::emitter(glm::vec3(10.0f))));
    return scene;
}

Scene glass_box(bool inwards = false) {
    Scene scene = lit_scene();
    scene.mesh_nodes.push_back({4, "lamp", 0});
    scene.mesh_nodes.push_back({7, "cube", std::uint32_t(scene.triangles.size())});
    test::add_box(scene, {0, 0, 0}, {1, 2, 3}, 0, inwards);
    return scene;
}

TEST(Diagnosis, FindsWhatIsTooSmallBesideTheScene) {
    const auto beside = [](double size) {
        Scene scene = glass_box();
        const std::uint32_t grey = test::add_material(scene, test::lambert(glm::vec3(0.5f)));
        scene.mesh_nodes.push_back({9, "plain", std::uint32_t(scene.triangles.size())});
        test::add_quad(scene, {0, -1, 0}, {0, 0, size}, {size, 0, 0}, grey);
        return scene;
    };
    expect_told(beside(1e4), {});
    expect_told(beside(1e6),
                {"nodes[7] 'cube', materials[0] 'crystal' is 3.74 m across", "too small beside the scene"});
}

TEST(Diagnosis, FindsNothingInGoodScenes) {
    expect_told(test::room(), {});
    expect_told(test::bare_room(0.5f), {});
    expect_told(glass_box(), {});
}

TEST(Diagnosis, FindsNothingInTheScenesOfTheProject) {
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / "scenes")) {
        if (entry.path().extension() != ".gltf") continue;
        SCOPED_TRACE(entry.path());
        expect_told(test::project_scene(entry.path().stem()), {});
        ++scenes;
    }
    EXPECT_GT(scenes, 0u);
}

TEST(Diagnosis, FindsNothingInTheSharedScenes) {
    for (const char* name : {"cornell_glass.glb", "cornell-box.glb", "dining-room.glb"}) {
        const auto file = test::shared_file(name);
        if (!file) GTEST_SKIP() << test::no_collections;
        SCOPED_TRACE(name);
        expect_told(load_gltf(*file), {});
    }
}

// ---- glass ----

TEST(Diagnosis, NamesThinGlassThatWillNotRefract) {
    Scene scene = glass_box();
    scene.materials[0].thickness = 0.0f;
    expect_told(scene, {"test.gltf: nodes[7] 'cube', materials[0] 'crystal', about (0.5, 1, 1.5): ", "without a volume",
                        "closed", "--thin-glass solid"});
    make_glass_solid(scene);
    expect_told(scene, {});
}

TEST(Diagnosis, LetsThinGlassBeOnAnOpenMesh) {
    Scene scene = glass_box();
    scene.materials[0].thickness = 0.0f;
    scene.triangles.pop_back();
    expect_told(scene, {});
}

TEST(Diagnosis, CountsTheMeshesOfAKind) {
    Scene scene = glass_box();
    scene.materials[0].thickness = 0.0f;
    test::add_box(scene, {5, 0, 0}, {6, 1, 1}, 0, false);
    test::add_box(scene, {7, 0, 0}, {8, 1, 1}, 0, false);
    expect_told(scene, {"nodes[7] 'cube'", "(and 2 more)"});
}

TEST(Diagnosis, NamesOpenSolidGlassAndItsEdges) {
    Scene scene = glass_box();
    scene.triangles.resize(scene.triangles.size() - 2);
    expect_told(scene, {"nodes[7] 'cube', materials[0] 'crystal'", "4 edges", "open"});
}

TEST(Diagnosis, NamesSolidGlassWhoseTrianglesDisagree) {
    Scene scene = glass_box();
    for (std::size_t i = scene.triangles.size() - 2; i < scene.triangles.size(); ++i) {
        std::swap(scene.triangles[i].vertex[1], scene.triangles[i].vertex[2]);
    }
    expect_told(scene, {"'cube'", "'crystal'", "4 edges", "disagree about the front"});
}

TEST(Diagnosis, NamesSolidGlassThatEnclosesNothing) {
    Scene scene = lit_scene();
    test::add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    test::add_triangle(scene, {0, 0, 0}, {1, 1, 0}, {1, 0, 0}, 0);
    test::add_triangle(scene, {0, 0, 0}, {0, 1, 0}, {1, 1, 0}, 0);
    expect_told(scene, {"'crystal'", "encloses none"});
}

TEST(Diagnosis, NamesSolidGlassThatIsInsideOut) {
    expect_told(glass_box(true), {"'cube'", "'crystal'", "volume -6 m^3", "inside out"});
}

TEST(Diagnosis, LetsACavityBeInsideOut) {
    Scene scene = glass_box();
    test::add_box(scene, {0.25, 0.25, 0.25}, {0.75, 1.75, 2.75}, 0, true);
    expect_told(scene, {});
}

TEST(Diagnosis, LetsABubbleBeInsideOut) {
    Scene scene = glass_box();
    const std::size_t first = scene.triangles.size();
    test::add_sphere(scene, {0.5, 1.0, 1.5}, 0.3, 2, 0, true);
    for (std::size_t i = first; i < scene.triangles.size(); ++i) {
        std::swap(scene.triangles[i].vertex[1], scene.triangles[i].vertex[2]);
    }
    expect_told(scene, {});
}

TEST(Diagnosis, TellsOfAnInvertedMeshBesideOthers) {
    Scene scene = glass_box();
    test::add_box(scene, {5, 0, 0}, {6, 1, 1}, 0, true);
    expect_told(scene, {"about (5.5, 0.5, 0.5)", "volume -1 m^3", "inside out"});
}

TEST(Diagnosis, TakesTheMaterialsOfOneMeshTogether) {
    Scene scene = glass_box();
    scene.materials.push_back(scene.materials[0]);
    scene.triangles.back().material = std::uint32_t(scene.materials.size() - 1);
    expect_told(scene, {});
}

// ---- alpha ----

TEST(Diagnosis, NamesGlassThatAlphaTakesAway) {
    Scene scene = glass_box();
    scene.materials[0].alpha = Material::Alpha::blend;
    scene.materials[0].opacity = 0.25f;
    expect_told(scene, {"nodes[7] 'cube', materials[0] 'crystal'", "alphaMode BLEND", "alpha down to 0.25"});
    scene.materials[0].alpha = Material::Alpha::mask;
    expect_told(scene, {"alphaMode MASK"});
    scene.materials[0].alpha = Material::Alpha::opaque;
    expect_told(scene, {});
}

TEST(Diagnosis, LetsAlphaBeThatTakesNothingAway) {
    Scene scene = glass_box();
    scene.materials[0].alpha = Material::Alpha::blend;
    expect_told(scene, {});
    scene.materials[0].alpha = Material::Alpha::mask;
    scene.materials[0].opacity = 0.5f;  // the cutoff itself
    expect_told(scene, {});
    scene.materials[0].alpha = Material::Alpha::blend;
    scene.materials[0].transmission = 0.0f;  // no glass
    expect_told(scene, {});
}

TEST(Diagnosis, LooksForAlphaInTexturesAndVertexColours) {
    Scene scene = glass_box();
    scene.materials[0].alpha = Material::Alpha::blend;
    scene.images.push_back({"leaf", {2, 1}, {0, 0, 0, 255, 0, 0, 0, 255}});
    scene.materials[0].base_color_texture = Texture{};
    expect_told(scene, {});
    scene.images[0].rgba[7] = 51;
    expect_told(scene, {"alpha down to 0.2:"});
    scene.images[0].rgba[7] = 255;
    scene.colors.assign(scene.positions.size(), glm::vec4(1.0f));
    expect_told(scene, {});
    scene.colors[0].a = 0.0f;  // of the lamp
    expect_told(scene, {});
    scene.colors.back().a = 0.5f;
    expect_told(scene, {"alpha down to 0.5:"});
}

// ---- lights ----

PunctualLight point_light(const glm::dvec3& position, float intensity = 1.0f) {
    PunctualLight light;
    light.name = "bulb";
    light.intensity = glm::vec3(intensity);
    light.position = position;
    return light;
}

TEST(Diagnosis, NamesALightInsideSolidGlass) {
    Scene scene = glass_box();
    scene.lights.push_back(point_light({2.0, 1.0, 1.0}));
    expect_told(scene, {});
    scene.lights.push_back(point_light({0.5, 1.0, 1.0}));
    expect_told(scene, {"light 1 'bulb' at (0.5, 1, 1) inside nodes[7] 'cube', materials[0] 'crystal'"});
    scene.lights[1].kind = PunctualLight::Kind::directional;  // from infinitely far away
    expect_told(scene, {});
}

TEST(Diagnosis, LetsALightBeInACavityOrInThinGlass) {
    Scene hollow = glass_box();
    test::add_box(hollow, {0.25, 0.25, 0.25}, {0.75, 1.75, 2.75}, 0, true);
    hollow.lights.push_back(point_light({0.5, 1.0, 1.0}));
    expect_told(hollow, {});
    hollow.lights[0].position = {0.1, 1.0, 1.0};  // in the wall
    expect_told(hollow, {"light 0 'bulb' at (0.1, 1, 1) inside"});

    Scene thin = glass_box();
    thin.materials[0].thickness = 0.0f;
    thin.triangles.pop_back();
    thin.lights.push_back(point_light({0.5, 1.0, 1.0}));
    expect_told(thin, {});
}

TEST(Diagnosis, NamesAnEmitterInsideSolidGlass) {
    Scene scene = glass_box();
    const std::uint32_t filament = test::add_material(scene, test::emitter(glm::vec3(1.0f)));
    scene.materials[filament].name = "filament";
    test::add_box(scene, {0.4, 0.9, 0.9}, {0.6, 1.1, 1.1}, filament, false);
    test::add_box(scene, {0.4, 0.3, 0.3}, {0.6, 0.5, 0.5}, filament, false);
    expect_told(scene, {"materials[2] 'filament' at (", "inside nodes[7] 'cube'", "(and 1 more)", "hollow"});
    scene.materials[filament].emission = glm::vec3(0.0f);
    expect_told(scene, {});
}

TEST(Diagnosis, LetsGlassTouchALampOrGlow) {
    Scene scene = glass_box();
    test::add_quad(scene, {0.2, 0.0, 0.2}, {0.5, 0, 0}, {0, 0, 0.5}, 1);  // in the plane of the lower face
    test::add_box(scene, {0.25, 0.25, 0.25}, {0.75, 1.75, 2.75}, 0, true);
    test::add_quad(scene, {0.25, 0.5, 0.5}, {0, 1, 0}, {0, 0, 1}, 1);  // on the wall of a cavity
    expect_told(scene, {});
    scene.materials[0].emission = glm::vec3(1.0f);
    expect_told(scene, {});
}

TEST(Diagnosis, SaysThatThereIsNoLight) {
    Scene scene = glass_box();
    scene.materials[1].emission = glm::vec3(0.0f);
    expect_told(scene, {"test.gltf: the scene: there is no light", "--environment"});
    scene.lights.push_back(point_light({5, 5, 5}, 0.0f));
    expect_told(scene, {"no light, it is black"});
    scene.materials[1].unlit = true;
    expect_told(scene, {"no light, all but what is unlit is black"});
    scene.materials[1].unlit = false;
    scene.environment = Environment{{1, 1}, {glm::vec3(0.0f)}};
    expect_told(scene, {"no light"});
    scene.environment->radiance[0].g = 1.0f;
    expect_told(scene, {});
    scene.environment.reset();
    scene.lights[0].intensity.b = 1.0f;
    expect_told(scene, {});
    scene.lights.clear();
    for (Material& material : scene.materials) material.unlit = true;
    expect_told(scene, {});
    expect_told(Scene{}, {"no light"});
}

TEST(Diagnosis, NamesIntensitiesThatNoSourceHas) {
    Scene scene = glass_box();
    scene.lights.push_back(point_light({5, 5, 5}, 9e3f));
    expect_told(scene, {});
    scene.lights[0].intensity.g = 54351.4f;
    expect_told(scene, {"light 0 'bulb' has 5.435e+04 W/sr", "candela"});
    scene.lights[0].intensity = glm::vec3(1e-7f);
    expect_told(scene, {"light 0 'bulb' has 1e-07 W/sr"});
    scene.lights[0].kind = PunctualLight::Kind::directional;
    scene.lights[0].intensity = glm::vec3(1361.0f);
    expect_told(scene, {});
    scene.lights[0].intensity = glm::vec3(1e5f);
    expect_told(scene, {"light 0 'bulb' has 1e+05 W/m^2"});
    scene.lights.clear();
    scene.materials[1].emission = glm::vec3(0.0f, 2e8f, 0.0f);
    expect_told(scene, {"materials[1] has 2e+08 W m^-2 sr^-1"});
    scene.materials[1].emission = glm::vec3(2e7f);  // the sun
    expect_told(scene, {});
    scene.environment = Environment{{2, 1}, {glm::vec3(1.0f), glm::vec3(1e9f)}};
    expect_told(scene, {"the environment has 1e+09 W m^-2 sr^-1"});
}

TEST(Diagnosis, LooksAtMaterialsInUseOnly) {
    Scene scene = glass_box();
    test::add_material(scene, test::emitter(glm::vec3(1e12f)));
    scene.materials[0].alpha = Material::Alpha::blend;
    scene.materials[0].opacity = 0.5f;
    scene.triangles.resize(2);
    expect_told(scene, {});
}

TEST(Diagnosis, EndsOnVeryManyLightsInsideVeryMuchGlass) {
    Scene scene = lit_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 5, 0, true);
    const std::size_t triangles = scene.triangles.size() - 2;
    for (int i = 0; i < 100000; ++i) scene.lights.push_back(point_light({0.0, 0.0, 1e-6 * i}));
    const std::size_t asked = (std::size_t(1) << 22) / (triangles + 1);
    expect_told(scene, {"light 0 'bulb'", fmt::format("(and {} more)", asked - 1)});
}

}  // namespace
}  // namespace vkcppm
