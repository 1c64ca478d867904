#include "scene/diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "scene/diagnosis/alpha.h"
#include "scene/diagnosis/glass.h"
#include "scene/diagnosis/shell.h"
#include "scene/instances.h"
#include "scene/warnings.h"

namespace vkcppm {
namespace {

// What common sources of light have, with a wide margin on either side: what lies outside was most likely meant in
// lumen, candela or lux, of which a watt of green light has 683. A searchlight's beam can be meant as it is.
constexpr double most_intensity = 1e4;     // W/sr; a floodlight of 100 kW has 8e3 in every direction
constexpr double most_irradiance = 1e4;    // W/m^2; the sun has 1361 above the air and 1e5 lux on the ground
constexpr double most_radiance = 1e8;      // W m^-2 sr^-1; the sun's surface has 2e7
constexpr double least_intensity = 1e-6;   // W/sr; an indicator lamp has 1e-4
constexpr double least_irradiance = 1e-6;  // W/m^2; a clear night without a moon
constexpr double least_radiance = 1e-8;    // W m^-2 sr^-1; the night sky has 1e-7

// Discs of photons do not shrink below 10^-6 of the scene's radius, and rays start as far off a surface that is as
// large.
constexpr double least_extent = 2e-5;  // of the scene's, for ten such discs across

constexpr std::size_t most_solid_angles = std::size_t(1) << 22;  // a quarter of a second

std::string text(const glm::dvec3& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z); }

double largest(const glm::vec3& v) { return std::max({v.r, v.g, v.b}); }

std::string name_of(std::string_view array, std::size_t index, std::string_view name) {
    return name.empty() ? fmt::format("{}[{}]", array, index) : fmt::format("{}[{}] '{}'", array, index, name);
}

bool contains(const Shell& shell, const glm::dvec3& p) {
    return glm::all(glm::lessThanEqual(shell.low, p)) && glm::all(glm::lessThanEqual(p, shell.high));
}

/// The closed shells of solid glass in one space: in the world, or of one shared mesh. Their solid angles are limited
/// in number: past the limit nothing is found.
class SolidGlass {
public:
    SolidGlass(const Scene& scene, std::span<const Shell> shells, std::optional<std::uint32_t> mesh) : scene_(scene) {
        for (const Shell& shell : shells) {
            if (!shell.is_closed() || mesh_of(scene, shell.triangles.front()) != mesh) continue;
            low_ = closed_.empty() ? shell.low : glm::min(low_, shell.low);
            high_ = closed_.empty() ? shell.high : glm::max(high_, shell.high);
            closed_.push_back(&shell);
        }
    }

    bool empty() const { return closed_.empty(); }
    bool exhausted() const { return work_left_ == 0; }

    /// Whether the point may be inside: it is in the box round all.
    bool may_hold(const glm::dvec3& p) const {
        return !empty() && glm::all(glm::lessThanEqual(low_, p)) && glm::all(glm::lessThanEqual(p, high_));
    }

    /// The shell in whose glass the point lies, leaving out one; none where it is in the air, as in a cavity.
    const Shell* holder(const glm::dvec3& p, const Shell* left_out = nullptr) {
        const Shell* holder = nullptr;
        double turns = 0.0;
        for (const Shell* shell : closed_) {
            const std::size_t work = contains(*shell, p) ? 1 + shell->triangles.size() : 1;
            if (work > work_left_) {
                work_left_ = 0;
                return nullptr;
            }
            work_left_ -= work;
            if (shell == left_out || work == 1) continue;
            const double winding = winding_number(scene_, *shell, p);
            if (winding > inside_turns) holder = shell;
            turns += winding;
        }
        return turns > inside_turns ? holder : nullptr;
    }

private:
    const Scene& scene_;
    std::vector<const Shell*> closed_;
    glm::dvec3 low_{0.0}, high_{0.0};
    std::size_t work_left_ = most_solid_angles;
};

class Diagnosis {
public:
    explicit Diagnosis(const Scene& scene) : scene_(scene) {}

    std::vector<std::string> lines() {
        check_thin_glass();
        check_solid_glass();
        check_alpha();
        check_extents();
        check_presence();
        check_intensities();
        return warnings_.lines(scene_.file.string());
    }

private:
    // ---- names ----

    std::string material_name(std::uint32_t material) const {
        return name_of("materials", material, scene_.materials[material].name);
    }

    /// "nodes[3] 'bottle', materials[0] 'glass'"
    std::string triangle_name(std::uint32_t triangle) const {
        const std::string material = material_name(scene_.triangles[triangle].material);
        if (const auto mesh = mesh_of(scene_, triangle)) {
            const MeshNode& node = scene_.mesh_nodes[scene_.meshes[*mesh].node];
            return fmt::format("the mesh of {}, {}", name_of("nodes", node.index, node.name), material);
        }
        const auto next = std::ranges::upper_bound(scene_.mesh_nodes, triangle, {}, &MeshNode::first_triangle);
        if (next == scene_.mesh_nodes.begin()) return material;
        const MeshNode& node = *(next - 1);
        return fmt::format("{}, {}", name_of("nodes", node.index, node.name), material);
    }

    std::string shell_name(const Shell& shell) const {
        const glm::dvec3 centre = 0.5 * (shell.low + shell.high);
        return fmt::format("{}, about {}", triangle_name(shell.triangles.front()), text(centre));
    }

    // ---- glass ----

    void check_thin_glass() {
        const auto is_thin = [](const Material& material) { return is_glass(material) && !is_solid_glass(material); };
        for (const Shell& shell : find_shells(scene_, triangles_of(scene_, is_thin))) {
            if (!shell.is_closed()) continue;
            warnings_.add(
                "glass without a volume on a closed mesh: light passes straight on and makes no caustic; "
                "--thin-glass solid makes it refract, as does a thicknessFactor",
                shell_name(shell));
        }
    }

    void check_solid_glass() {
        const std::vector<Shell> shells = find_shells(scene_, triangles_of(scene_, is_solid_glass));
        for (const std::span<const Shell> here : by_space(scene_, shells)) {
            const auto mesh = mesh_of(scene_, here.front().triangles.front());
            SolidGlass glass(scene_, here, mesh);
            for (const Shell& shell : here) check_solid(shell, glass);
            if (!mesh && !glass.empty()) check_lights_inside(glass);
        }
    }

    void check_solid(const Shell& shell, SolidGlass& glass) {
        if (shell.open_edges > 0) {
            warnings_.add(
                "glass with a volume on an open mesh: light that enters is not sure to leave",
                fmt::format("{}, {} edges with an odd number of triangles", shell_name(shell), shell.open_edges));
        } else if (shell.twisted_edges > 0) {
            warnings_.add(
                "glass with a volume on a mesh whose triangles disagree about the front: inside and outside "
                "change places",
                fmt::format("{}, {} edges", shell_name(shell), shell.twisted_edges));
        } else if (shell.is_flat()) {
            warnings_.add("glass with a volume on a mesh that encloses none", shell_name(shell));
        } else if (shell.volume < 0.0) {
            const Triangle& triangle = scene_.triangles[shell.triangles.front()];
            const bool is_cavity = glass.holder(scene_.positions[triangle.vertex[0]], &shell) != nullptr;
            if (is_cavity || glass.exhausted()) return;
            warnings_.add("glass with a volume on a mesh that is inside out: light refracts the wrong way",
                          fmt::format("{}, volume {:.4g} m^3", shell_name(shell), shell.volume));
        }
    }

    void check_alpha() {
        std::vector<std::optional<std::uint32_t>> first(scene_.materials.size());
        for (std::size_t i = scene_.triangles.size(); i-- > 0;) first[scene_.triangles[i].material] = std::uint32_t(i);
        const std::vector<float> alphas = least_alphas(scene_);
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const Material& material = scene_.materials[i];
            if (!first[i] || !is_glass(material) || !is_partly_there(material, alphas[i])) continue;
            warnings_.add(
                "glass with alpha: where alpha takes it away, light passes straight on; transmission alone "
                "makes it clear",
                fmt::format("{}, alphaMode {}, alpha down to {:.3g}", triangle_name(*first[i]),
                            material.alpha == Material::Alpha::blend ? "BLEND" : "MASK", alphas[i]));
        }
    }

    // ---- sizes ----

    static double extent(const SceneBox& box) { return box.is_empty() ? 0.0 : glm::length(box.high - box.low); }

    void check_extent(std::uint32_t first, double part, double whole) {
        if (part >= least_extent * whole || emits(scene_.materials[scene_.triangles[first].material])) return;
        warnings_.add("too small beside the scene: the light on it is blurred over all of it",
                      fmt::format("{} is {:.3g} m across, the scene {:.3g} m", triangle_name(first), part, whole));
    }

    void check_extents() {
        const TriangleRange world = world_triangles(scene_);
        const std::vector<SceneBox> boxes = instance_boxes(scene_);
        SceneBox all = box_of(scene_, world);
        for (const SceneBox& box : boxes) all.grow(box);
        const double whole = extent(all);
        for (std::size_t i = 0; i < scene_.mesh_nodes.size(); ++i) {
            const std::uint32_t first = scene_.mesh_nodes[i].first_triangle;
            const std::uint32_t last =
                i + 1 < scene_.mesh_nodes.size() ? scene_.mesh_nodes[i + 1].first_triangle : world.last;
            if (first < last) check_extent(first, extent(box_of(scene_, {first, last})), whole);
        }
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            check_extent(scene_.meshes[scene_.instances[i].mesh].first_triangle, extent(boxes[i]), whole);
        }
    }

    // ---- lights ----

    void check_lights_inside(SolidGlass& glass) {
        const auto check = [&](const std::string& light, const glm::dvec3& p) {
            const Shell* holder = glass.holder(p);
            if (!holder) return;
            warnings_.add("a light inside solid glass, as if cast into it; the glass of a bulb must be hollow",
                          fmt::format("{} at {} inside {}", light, text(p), shell_name(*holder)));
        };
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const PunctualLight& light = scene_.lights[i];
            if (light.kind == PunctualLight::Kind::directional) continue;
            check(fmt::format("light {} '{}'", i, light.name), light.position);
        }
        // Emitters in one piece are inside or not as one, but where they pass through the glass: one test each.
        std::vector<std::uint32_t> emitters = triangles_of(scene_, emits);
        std::erase_if(emitters, [&](std::uint32_t i) { return !glass.may_hold(centre_of(i)); });
        for (const Shell& emitter : find_shells(scene_, emitters)) {
            check(triangle_name(emitter.triangles.front()), centre_of(emitter.triangles.front()));
        }
    }

    static bool emits(const Material& material) { return material.emission != glm::vec3(0.0f); }

    glm::dvec3 centre_of(std::uint32_t triangle) const {
        const auto& vertex = scene_.triangles[triangle].vertex;
        return (scene_.positions[vertex[0]] + scene_.positions[vertex[1]] + scene_.positions[vertex[2]]) / 3.0;
    }

    /// Unlit surfaces need no light: where nothing else is there, its absence is no fault.
    void check_presence() {
        const auto shines = [](const PunctualLight& light) { return light.intensity != glm::vec3(0.0f); };
        if (std::ranges::any_of(scene_.lights, shines) || environment_radiance() > 0.0) return;
        const auto material = [&](const Triangle& triangle) -> const Material& {
            return scene_.materials[triangle.material];
        };
        if (std::ranges::any_of(scene_.triangles, emits, material)) return;
        if (!scene_.triangles.empty() && std::ranges::all_of(scene_.triangles, &Material::unlit, material)) return;
        const bool has_unlit = std::ranges::any_of(scene_.triangles, &Material::unlit, material);
        warnings_.add(fmt::format("there is no light, {} black: it needs a light, an emissiveFactor or --environment",
                                  has_unlit ? "all but what is unlit is" : "it is"),
                      "the scene");
    }

    void check_intensities() {
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            const PunctualLight& light = scene_.lights[i];
            const std::string name = fmt::format("light {} '{}'", i, light.name);
            if (light.kind == PunctualLight::Kind::directional) {
                check_intensity(name, largest(light.intensity), "W/m^2", least_irradiance, most_irradiance);
            } else {
                check_intensity(name, largest(light.intensity), "W/sr", least_intensity, most_intensity);
            }
        }
        std::vector<bool> seen(scene_.materials.size());
        for (const Triangle& triangle : scene_.triangles) {
            if (seen[triangle.material]) continue;
            seen[triangle.material] = true;
            check_intensity(material_name(triangle.material), largest(scene_.materials[triangle.material].emission),
                            "W m^-2 sr^-1", least_radiance, most_radiance);
        }
        check_intensity("the environment", environment_radiance(), "W m^-2 sr^-1", least_radiance, most_radiance);
    }

    void check_intensity(const std::string& name, double value, const char* unit, double least, double most) {
        if (value == 0.0 || (value >= least && value <= most)) return;
        warnings_.add(
            "of the order of no common source of light: intensities are in W/sr, W/m^2 and W m^-2 sr^-1, "
            "not in candela, lux or nits",
            fmt::format("{} has {:.4g} {}", name, value, unit));
    }

    /// Of the brightest pixel and channel.
    double environment_radiance() const {
        double brightest = 0.0;
        if (!scene_.environment) return brightest;
        for (const glm::vec3& radiance : scene_.environment->radiance) {
            brightest = std::max(brightest, largest(radiance));
        }
        return brightest;
    }

    const Scene& scene_;
    Warnings warnings_;
};

}  // namespace

std::vector<std::string> diagnose(const Scene& scene) { return Diagnosis(scene).lines(); }

}  // namespace vkcppm
