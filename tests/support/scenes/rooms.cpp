#include "support/scenes/rooms.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

/// Materials of the room, in the order in which it adds them.
enum : std::size_t { walls, floor_, ball, pane, lamp };

}  // namespace

Scene make_room() {
    Scene scene;
    add_material(scene, lambert(glm::vec3(0.6f, 0.55f, 0.5f)));
    add_material(scene, lambert(glm::vec3(0.5f, 0.6f, 0.4f)));
    add_material(scene, lambert(glm::vec3(0.7f, 0.3f, 0.2f)));
    add_material(scene, lambert(glm::vec3(0.3f, 0.4f, 0.7f)));
    add_material(scene, emitter(glm::vec3(6.0f, 5.0f, 4.0f)));
    add_quad(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 2}, walls);
    add_quad(scene, {2, 0, 0}, {0, 0, 2}, {0, 2, 0}, walls);
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, walls);
    add_quad(scene, {0, 0, 2}, {0, 2, 0}, {2, 0, 0}, walls);
    add_quad(scene, {0, 2, 0}, {2, 0, 0}, {0, 0, 2}, walls);
    add_quad(scene, {0, 0, 0}, {0, 0, 2}, {2, 0, 0}, floor_);
    add_quad(scene, {0.4, 1.99, 0.4}, {1.2, 0, 0}, {0, 0, 1.2}, lamp);
    add_sphere(scene, {0.65, 0.5, 0.8}, 0.45, 4, ball, true);
    add_quad(scene, {1.15, 0.05, 0.9}, {0.7, 0, -0.3}, {0, 1.2, 0}, pane);
    add_camera(scene, {1.0, 1.1, 1.95}, {1.0, 0.75, 0.0}, 1.25);
    return scene;
}

namespace {

Texture add_image(Scene& scene, std::uint32_t width, std::uint32_t height,
                  const std::function<glm::vec4(std::uint32_t, std::uint32_t)>& pixel) {
    TextureImage image;
    image.size = {width, height};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const glm::vec4 value = pixel(x, y);
            for (int c = 0; c < 4; ++c) image.rgba.push_back(std::uint8_t(std::lround(255.0f * value[c])));
        }
    }
    scene.images.push_back(image);
    // Coordinates for whatever wants them, by place.
    scene.uv[0].clear();
    for (const glm::dvec3& p : scene.positions) scene.uv[0].emplace_back(p.x + 0.3 * p.y, p.z - p.y);
    Texture texture;
    texture.image = std::uint32_t(scene.images.size() - 1);
    return texture;
}

void make_glass(Material& material, float roughness, float thickness) {
    material.base_color = {0.95f, 0.9f, 0.98f};
    material.transmission = 1.0f;
    material.thickness = thickness;
    material.roughness = roughness;
    material.ior = 1.5f;
    material.specular = 1.0f;
}

/// Of the ball and the floor.
Case on_surfaces(const char* name, std::function<void(Material&)> change) {
    return {name, [change](Scene& scene, Settings&) {
                change(scene.materials[ball]);
                change(scene.materials[floor_]);
            }};
}

/// Floor and ball of that roughness: a coat over the floor, the ball of metal.
void make_glossy(Scene& scene, float roughness) {
    for (const auto i : {floor_, ball}) {
        scene.materials[i].roughness = roughness;
        scene.materials[i].specular = 1.0f;
    }
    scene.materials[ball].metallic = 1.0f;
}

}  // namespace

const std::vector<Case>& material_cases() {
    static const std::vector<Case> cases = {
        on_surfaces("metal_02",
                    [](Material& m) {
                        m.metallic = 1.0f;
                        m.roughness = 0.2f;
                    }),
        on_surfaces("metal_05",
                    [](Material& m) {
                        m.metallic = 1.0f;
                        m.roughness = 0.5f;
                    }),
        on_surfaces("metal_10",
                    [](Material& m) {
                        m.metallic = 1.0f;
                        m.roughness = 1.0f;
                    }),
        on_surfaces("coat_smooth",
                    [](Material& m) {
                        m.specular = 1.0f;
                        m.roughness = 0.0f;
                    }),
        on_surfaces("coat_03",
                    [](Material& m) {
                        m.specular = 1.0f;
                        m.roughness = 0.3f;
                        m.ior = 1.8f;
                    }),
        on_surfaces("coat_10",
                    [](Material& m) {
                        m.specular = 1.0f;
                        m.roughness = 1.0f;
                    }),
        on_surfaces("coat_coloured",
                    [](Material& m) {
                        m.specular = 0.8f;
                        m.specular_color = {3.0f, 1.0f, 0.2f};
                        m.roughness = 0.4f;
                    }),
        on_surfaces("half_metal",
                    [](Material& m) {
                        m.metallic = 0.5f;
                        m.specular = 1.0f;
                        m.roughness = 0.4f;
                    }),
        on_surfaces("clearcoat_smooth",
                    [](Material& m) {
                        m.clearcoat = 1.0f;
                        m.specular = 1.0f;
                        m.roughness = 0.6f;
                    }),
        on_surfaces("clearcoat_04",
                    [](Material& m) {
                        m.clearcoat = 0.7f;
                        m.clearcoat_roughness = 0.4f;
                        m.metallic = 1.0f;
                        m.roughness = 0.5f;
                    }),
        {"glass", [](Scene& s, Settings&) { make_glass(s.materials[ball], 0.0f, 1.0f); }},
        {"glass_rough", [](Scene& s, Settings&) { make_glass(s.materials[ball], 0.4f, 1.0f); }},
        {"glass_part",
         [](Scene& s, Settings&) {
             make_glass(s.materials[ball], 0.2f, 1.0f);
             s.materials[ball].transmission = 0.5f;
         }},
        {"absorption",
         [](Scene& s, Settings&) {
             make_glass(s.materials[ball], 0.0f, 1.0f);
             s.materials[ball].attenuation_color = {0.8f, 0.3f, 0.1f};
             s.materials[ball].attenuation_distance = 0.5f;
         }},
        {"thin", [](Scene& s, Settings&) { make_glass(s.materials[pane], 0.0f, 0.0f); }},
        {"thin_rough", [](Scene& s, Settings&) { make_glass(s.materials[pane], 0.5f, 0.0f); }},
        {"dispersion",
         [](Scene& s, Settings&) {
             make_glass(s.materials[ball], 0.0f, 1.0f);
             s.materials[ball].dispersion = 2.0f;
         }},
        {"blend",
         [](Scene& s, Settings&) {
             for (const auto i : {ball, pane}) {
                 s.materials[i].alpha = Material::Alpha::blend;
                 s.materials[i].opacity = 0.4f;
             }
         }},
        {"mask",
         [](Scene& s, Settings&) {
             s.materials[pane].base_color_texture = add_image(
                 s, 8, 8, [](auto x, auto y) { return glm::vec4(0.9f, 0.5f, 0.7f, (x + y) % 3 == 0 ? 0.2f : 0.8f); });
             s.materials[pane].alpha = Material::Alpha::mask;
         }},
        {"textures",
         [](Scene& s, Settings&) {
             s.materials[floor_].base_color_texture = add_image(
                 s, 16, 4, [](auto x, auto y) { return glm::vec4(float(x % 4) / 3.0f, float(y) / 3.0f, 0.5f, 1.0f); });
             s.materials[ball].metallic_roughness_texture = add_image(s, 4, 4, [](auto x, auto y) {
                 return glm::vec4(0.0f, 0.25f * float(x) + 0.2f, float(y) / 3.0f, 1.0f);
             });
             s.materials[ball].metallic = 1.0f;
             s.materials[ball].specular = 1.0f;
             s.colors.clear();
             for (const glm::dvec3& p : s.positions) s.colors.emplace_back(0.5 + 0.25 * p.x, 0.9, 1.0 - 0.2 * p.z, 1.0);
         }},
        {"normal_map",
         [](Scene& s, Settings&) {
             const Texture bumps = add_image(s, 8, 8, [](auto x, auto y) {
                 return glm::vec4(0.5f + 0.2f * float(int(x % 3) - 1), 0.5f + 0.2f * float(int(y % 3) - 1), 0.95f,
                                  1.0f);
             });
             for (const auto i : {floor_, ball}) s.materials[i].normal_texture = bumps;
             s.materials[ball].specular = 1.0f;
             s.materials[ball].roughness = 0.4f;
         }},
        {"anisotropy",
         [](Scene& s, Settings&) {
             const Texture turns = add_image(s, 4, 4, [](auto x, auto y) {
                 const float angle = 1.5f * float(x) + 0.7f * float(y);
                 return glm::vec4(0.5f + 0.5f * std::cos(angle), 0.5f + 0.5f * std::sin(angle), 0.9f, 1.0f);
             });
             s.materials[ball].anisotropy_texture = turns;
             s.materials[floor_].anisotropy_rotation = 0.6f;
             for (const auto i : {floor_, ball}) s.materials[i].anisotropy = 0.8f;
             make_glossy(s, 0.25f);
         }},
        {"iridescence",
         [](Scene& s, Settings&) {
             s.materials[ball].iridescence_texture =
                 add_image(s, 4, 1, [](auto x, auto) { return glm::vec4(float(x) / 3.0f, 1.0f, 1.0f, 1.0f); });
             s.materials[floor_].iridescence_thickness_texture =
                 add_image(s, 1, 4, [](auto, auto y) { return glm::vec4(1.0f, float(y) / 3.0f, 1.0f, 1.0f); });
             for (const auto i : {floor_, ball}) s.materials[i].iridescence = 1.0f;
             make_glossy(s, 0.3f);
         }},
        {"iridescence_glass",
         [](Scene& s, Settings&) {
             make_glass(s.materials[ball], 0.0f, 1.0f);
             make_glass(s.materials[pane], 0.3f, 0.0f);
             for (const auto i : {ball, pane}) s.materials[i].iridescence = 1.0f;
             s.materials[pane].iridescence_ior = 1.9f;
         }},
        {"anisotropy_glass",
         [](Scene& s, Settings&) {
             add_image(s, 1, 1, [](auto, auto) { return glm::vec4(1.0f); });  // for the coordinates
             make_glass(s.materials[ball], 0.2f, 1.0f);
             make_glass(s.materials[pane], 0.3f, 0.0f);
             for (const auto i : {ball, pane}) s.materials[i].anisotropy = 0.7f;
         }},
        {"sheen",
         [](Scene& s, Settings&) {
             // Of few widths: the oracle integrates for each.
             Texture widths = add_image(s, 2, 1, [](auto x, auto) { return glm::vec4(0, 0, 0, x == 0 ? 0.4f : 1.0f); });
             widths.nearest = true;
             s.materials[ball].sheen_roughness_texture = widths;
             s.materials[floor_].sheen_color_texture =
                 add_image(s, 1, 4, [](auto, auto y) { return glm::vec4(1.0f, 0.3f * float(y), 0.5f, 1.0f); });
             make_glossy(s, 0.4f);
             make_glass(s.materials[pane], 0.0f, 0.0f);
             for (const auto i : {floor_, ball, walls, pane}) {
                 s.materials[i].sheen_color = {0.9f, 0.7f, 0.8f};
                 s.materials[i].sheen_roughness = i == ball ? 0.8f : 0.3f;
             }
             s.materials[ball].clearcoat = 0.5f;
         }},
        {"textured_lamp",
         [](Scene& s, Settings&) {
             s.materials[lamp].emissive_texture = add_image(s, 8, 8, [](auto x, auto y) {
                 return x < 3 && y > 2 ? glm::vec4(1.0f) : glm::vec4(0.3f, 0.1f, 0.05f, 1.0f);
             });
         }},
        {"clearcoat_lamp",
         [](Scene& s, Settings&) {
             s.materials[lamp].clearcoat = 1.0f;
             s.materials[lamp].clearcoat_texture =
                 add_image(s, 4, 4, [](auto x, auto) { return glm::vec4(x < 2 ? 1.0f : 0.25f, 0.0f, 0.0f, 1.0f); });
             s.materials[lamp].clearcoat_normal_texture =
                 add_image(s, 2, 2, [](auto x, auto) { return glm::vec4(x == 0 ? 0.8f : 0.3f, 0.5f, 0.9f, 1.0f); });
         }},
        {"unlit", [](Scene& s, Settings&) { s.materials[pane].unlit = true; }},
        {"lens",
         [](Scene&, Settings& settings) {
             settings.aperture = 0.2;
             settings.focus_distance = 1.2;
         }},
        {"environment",
         [](Scene& s, Settings&) {
             s.materials[lamp].emission = glm::vec3(0.0f);
             s.triangles.erase(s.triangles.begin(), s.triangles.begin() + 10);  // the walls, not the floor
             s.materials[ball].metallic = 1.0f;
             s.materials[ball].roughness = 0.3f;
             s.environment = Environment{{16, 8}, {}};
             for (int i = 0; i < 128; ++i)
                 s.environment->radiance.push_back(i / 16 < 2 && i % 16 < 5 ? glm::vec3(4.0f, 3.0f, 2.0f)
                                                                            : glm::vec3(0.2f, 0.3f, 0.5f));
         }},
        {"punctual_on_gloss",
         [](Scene& s, Settings&) {
             for (const auto i : {ball, pane}) {
                 s.materials[i].metallic = 1.0f;
                 s.materials[i].roughness = 0.35f;
             }
             s.materials[floor_].specular = 1.0f;
             s.materials[floor_].roughness = 0.5f;
             PunctualLight point;
             point.intensity = {1.5f, 2.0f, 2.5f};
             point.position = {1.6, 1.5, 1.6};
             s.lights.push_back(point);
             PunctualLight sun;
             sun.kind = PunctualLight::Kind::spot;
             sun.intensity = {4.0f, 3.0f, 1.0f};
             sun.position = {0.2, 1.8, 1.7};
             sun.direction = glm::normalize(glm::dvec3(0.45, -1.3, -0.9));
             sun.inner_cone = 0.2;
             sun.outer_cone = 0.5;
             s.lights.push_back(sun);
         }},
    };
    return cases;
}

namespace {

void make_rough(Scene& scene) {
    for (const auto i : {walls, floor_, pane}) {
        scene.materials[i].specular = 1.0f;
        scene.materials[i].roughness = 0.2f;
    }
    scene.materials[ball].metallic = 1.0f;
    scene.materials[ball].roughness = 0.4f;
    scene.materials[pane].alpha = Material::Alpha::blend;
    scene.materials[pane].opacity = 0.6f;
}

}  // namespace

const std::vector<Case>& small_light_cases() {
    static const std::vector<Case> cases = {
        {"lamp",
         [](Scene& s, Settings&) {
             make_rough(s);
             std::erase_if(s.triangles, [](const Triangle& t) { return t.material == lamp; });
             add_quad(s, {0.98, 1.99, 0.98}, {0.04, 0, 0}, {0, 0, 0.04}, lamp);
             s.materials[lamp].emission *= 900.0f;
         }},
        {"sun",
         [](Scene& s, Settings&) {
             make_rough(s);
             s.materials[lamp].emission = glm::vec3(0.0f);
             s.triangles.erase(s.triangles.begin(), s.triangles.begin() + 10);  // the walls, not the floor
             s.environment = Environment{{64, 32}, std::vector<glm::vec3>(64 * 32, glm::vec3(0.2f, 0.3f, 0.5f))};
             s.environment->radiance[8 * 64 + 40] = glm::vec3(700.0f, 600.0f, 500.0f);
         }},
        {"point",
         [](Scene& s, Settings&) {
             make_rough(s);
             s.materials[lamp].emission = glm::vec3(0.0f);
             PunctualLight point;
             point.intensity = {1.5f, 2.0f, 2.5f};
             point.position = {1.0, 1.9, 1.3};
             s.lights.push_back(point);
         }},
    };
    return cases;
}

}  // namespace vkcppm::test
