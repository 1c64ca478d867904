// What every feature of a scene costs: one room, as it is (off), with the feature compiled in though nothing uses it
// (idle), and changed so that it is used (on). Device seconds an iteration, the least of several runs that take turns,
// so that a busy machine is fair to all; printed as a Markdown table. By hand, on an idle machine:
//   cmake --build build --target bench_features && LP_NUM_THREADS=1 build/tests/bench_features [--runs N]
// A scene without a feature has the pipelines of `off`: the difference between idle and off is what specialising saves.

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "flat/features.h"
#include "support/pass_report.h"
#include "support/device/rig.h"
#include "support/scenes/instanced.h"
#include "support/scenes/shapes.h"

using namespace vkcppm;
using namespace vkcppm::test;

namespace {

/// The room under its lamp alone.
Scene plain_room() {
    Scene scene = room();
    scene.lights.clear();
    return scene;
}

Texture checker(Scene& scene) {
    TextureImage image;
    image.size = {64, 64};
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        const std::uint8_t value = (i / 8 + i / 512) % 2 == 0 ? 255 : 128;
        for (const std::uint8_t c : {value, value, value, std::uint8_t(255)}) image.rgba.push_back(c);
    }
    scene.images.push_back(image);
    scene.uv[0].clear();
    for (const glm::dvec3& p : scene.positions) scene.uv[0].emplace_back(p.x + p.y, p.z - p.y);
    Texture texture;
    texture.image = std::uint32_t(scene.images.size() - 1);
    return texture;
}

/// Every diffuse material that reflects.
void for_diffuse(Scene& scene, const std::function<void(Material&)>& change) {
    for (Material& material : scene.materials) {
        if (material.metallic == 0.0f && material.transmission == 0.0f && material.base_color != glm::vec3(0.0f))
            change(material);
    }
}

void for_glass(Scene& scene, const std::function<void(Material&)>& change) {
    for (Material& material : scene.materials) {
        if (material.transmission > 0.0f) change(material);
    }
}

struct Case {
    std::string name;
    std::uint32_t bits;  // forced for `idle`
    std::function<void(Scene&, Settings&)> use;
};

std::vector<Case> cases() {
    const auto diffuse = [](auto change) { return [change](Scene& s, Settings&) { for_diffuse(s, change); }; };
    const auto glass = [](auto change) { return [change](Scene& s, Settings&) { for_glass(s, change); }; };
    return {
        {"smooth coats", FEATURE_COAT | FEATURE_GLOSS, diffuse([](Material& m) {
             m.specular = 1.0f;
             m.roughness = 0.0f;
         })},
        {"rough coats", FEATURE_COAT | FEATURE_GLOSS | FEATURE_ROUGH, diffuse([](Material& m) {
             m.specular = 1.0f;
             m.roughness = 0.4f;
         })},
        {"rough metal", FEATURE_GLOSS | FEATURE_ROUGH,
         [](Scene& s, Settings&) {
             for (Material& m : s.materials)
                 if (m.metallic > 0.0f) m.roughness = 0.4f;
         }},
        {"rough glass", FEATURE_GLOSS | FEATURE_ROUGH, glass([](Material& m) { m.roughness = 0.3f; })},
        {"thin glass", FEATURE_THIN, glass([](Material& m) { m.thickness = 0.0f; })},
        {"absorption", FEATURE_VOLUME, glass([](Material& m) {
             m.attenuation_color = {0.9f, 0.5f, 0.3f};
             m.attenuation_distance = 0.5f;
         })},
        {"specular factors of glass", FEATURE_SPECULAR_GLASS, glass([](Material& m) { m.specular = 0.5f; })},
        {"solids in solids", FEATURE_NESTED,
         [](Scene& s, Settings&) {
             add_sphere(s, {0.55, 0.45, 0.8}, 0.2, 2, add_material(s, vkcppm::test::glass(1.33f)), true);
         }},
        {"dispersion", FEATURE_DISPERSION, glass([](Material& m) { m.dispersion = 0.5f; })},
        {"clearcoats", FEATURE_CLEARCOAT | FEATURE_GLOSS, diffuse([](Material& m) { m.clearcoat = 1.0f; })},
        {"iridescence", FEATURE_IRIDESCENCE,
         [](Scene& s, Settings&) {
             for (Material& m : s.materials) m.iridescence = 1.0f;
         }},
        {"anisotropy", FEATURE_ANISOTROPY | FEATURE_GLOSS | FEATURE_ROUGH,
         [](Scene& s, Settings&) {
             checker(s);  // for the coordinates
             for (Material& m : s.materials)
                 if (m.metallic > 0.0f) m.roughness = 0.4f, m.anisotropy = 0.7f;
         }},
        {"sheen", FEATURE_SHEEN | FEATURE_GLOSS, diffuse([](Material& m) {
             m.sheen_color = glm::vec3(0.5f);
             m.sheen_roughness = 0.4f;
         })},
        {"base colour textures", FEATURE_TEXTURES,
         [](Scene& s, Settings&) {
             const Texture t = checker(s);
             for_diffuse(s, [&](Material& m) { m.base_color_texture = t; });
         }},
        {"normal maps", FEATURE_TEXTURES | FEATURE_NORMAL_MAPS | FEATURE_SMOOTH,
         [](Scene& s, Settings&) {
             const Texture t = checker(s);
             for_diffuse(s, [&](Material& m) { m.normal_texture = t; });
         }},
        {"vertex colours", FEATURE_VERTEX_COLORS,
         [](Scene& s, Settings&) { s.colors.assign(s.positions.size(), glm::vec4(0.9f, 0.8f, 0.7f, 1.0f)); }},
        {"alpha", FEATURE_ALPHA, diffuse([](Material& m) {
             m.alpha = Material::Alpha::blend;
             m.opacity = 0.9f;
         })},
        {"unlit surfaces", FEATURE_UNLIT,
         [](Scene& s, Settings&) {
             for (Material& m : s.materials) m.unlit = m.metallic > 0.0f;
         }},
        {"textured lights", FEATURE_TEXTURES | FEATURE_TEXTURED_LIGHTS,
         [](Scene& s, Settings&) {
             const Texture t = checker(s);
             for (Material& m : s.materials)
                 if (m.emission != glm::vec3(0.0f)) m.emissive_texture = t;
         }},
        {"point light", FEATURE_POINT_LIGHTS, [](Scene& s, Settings&) { s.lights.push_back(room().lights.at(0)); }},
        {"environment", FEATURE_ENVIRONMENT,
         [](Scene& s, Settings&) {
             s.environment = Environment{{64, 32}, std::vector<glm::vec3>(64 * 32, glm::vec3(0.5f))};
         }},
        {"instances", FEATURE_INSTANCES,
         [](Scene& s, Settings&) {
             std::vector<int> triangles(s.materials.size());
             for (const Triangle& triangle : s.triangles) ++triangles[triangle.material];
             const auto most = std::ranges::max_element(triangles);
             s = shared(s, std::uint32_t(most - triangles.begin()), glm::dmat4(1.0));
         }},
        {"further channels", FEATURE_AOVS, [](Scene&, Settings& settings) { settings.aovs = true; }},
    };
}

/// Device seconds of an iteration by pass, the least so far.
using Times = std::map<std::string, double>;
constexpr std::pair<const char*, Pass> shown[] = {
    {"eye", Pass::eye}, {"photon", Pass::photon}, {"gather", Pass::gather}};

void keep_least(Times& least, const Scene& scene, const Settings& wanted, std::uint32_t forced) {
    constexpr std::uint32_t warm = 2, timed = 4;
    const Settings settings = resolve_settings(wanted, scene);
    FlatScene flat = flatten(scene);
    flat.features.push_back({forced, "forced", "the benchmark"});
    if (forced & FEATURE_VERTEX_COLORS) {
        flat.vertex_colors.assign(2 * flat.triangles.size(), glm::uvec4(0x3c003c00u));  // white, as half floats
    }
    const SceneOnDevice on_device(plain_device(), flat);
    Integrator integrator(on_device, scene.cameras.at(0), settings);
    Report before, after;
    integrator.run(warm);
    integrator.fill(before);
    integrator.run(timed);
    integrator.fill(after);
    Times times;
    const auto add = [&](const Report& report, double sign) {
        for (const PassReport& pass : report.passes) times["all"] += sign * pass.device_seconds / timed;
        for (const auto& [row, pass] : shown) {
            times[row] += sign * test::report_of(report.passes, pass).device_seconds / timed;
        }
    };
    add(after, 1.0);
    add(before, -1.0);
    for (const auto& [row, seconds] : times) {
        const auto [entry, is_new] = least.try_emplace(row, seconds);
        entry->second = std::min(entry->second, seconds);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Costs of the features of a scene.");
    int runs = 5;
    app.add_option("--runs", runs, "Runs of each, of which the least counts");
    CLI11_PARSE(app, argc, argv);
    Settings settings;
    settings.size = Extent{128, 128};
    settings.photons = 16384;

    const std::vector<Case> all = cases();
    Times off;
    std::vector<Times> idle(all.size()), on(all.size());
    for (int run = 0; run < runs; ++run) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            Scene changed = plain_room();
            Settings used = settings;
            all[i].use(changed, used);
            keep_least(off, plain_room(), settings, 0);
            keep_least(idle[i], plain_room(), settings, all[i].bits);
            keep_least(on[i], changed, used, 0);
        }
    }
    fmt::print(
        "Device ms an iteration of a room, {}x{}, {} paths, on {}; in the columns of passes: idle / on, in units of "
        "off.\n\n",
        settings.size->width, settings.size->height, *settings.photons, plain_device().info().driver);
    fmt::print("| feature | off | idle | on | on / off | eye | photon | gather |\n|---|---|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto ratio = [&](const char* pass) {
            return fmt::format("{:.2f} / {:.2f}", idle[i][pass] / off[pass], on[i][pass] / off[pass]);
        };
        fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {} | {} | {} |\n", all[i].name, 1e3 * off["all"],
                   1e3 * idle[i]["all"], 1e3 * on[i]["all"], on[i]["all"] / off["all"], ratio("eye"), ratio("photon"),
                   ratio("gather"));
    }
}
