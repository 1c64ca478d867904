#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/load.h"
#include "app/provenance.h"
#include "core/fnv1a.h"
#include "flat/features.h"
#include "flat/flatten.h"
#include "flat/material.h"
#include "render/memory.h"
#include "scene/instances.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

/// The rule by which an eye path gathers photons on a surface or goes on from it.
constexpr const char* gathering_rule =
    R"(Eye paths gather photons on diffuse lobes and follow lobes without roughness. A rough lobe is both
followed, with its own density p, and gathered on, as by k photons (--knn) of density cos/pi, weighed by
the balance heuristic: of its light p / (p + k cos/pi) is found by following and the rest by photons. Light
that comes straight from its source, or through panes (thin smooth glass), is asked for on every surface
that is not perfectly smooth: a point of a light of each kind (local, directional, environment) at a time,
weighed against meeting it by the same heuristic; photons bring it next to lamps alone, or everywhere with
--direct gathered. What of a punctual light comes by way of mirrors or other smooth glass is brought by
photons alone.
)";

std::vector<std::size_t> triangles_by_material(const Scene& scene) {
    std::vector<std::size_t> counts(scene.materials.size());
    for (const Triangle& triangle : scene.triangles) ++counts[triangle.material];
    return counts;
}

/// What the vertices carry, by glTF's names.
std::vector<std::string> vertex_attributes(const Scene& scene) {
    std::vector<std::string> names{"POSITION", "NORMAL"};
    if (!scene.tangents.empty()) names.push_back("TANGENT");
    for (std::size_t set = 0; set < scene.uv.size(); ++set) {
        if (!scene.uv[set].empty()) {
            names.push_back(fmt::format("TEXCOORD_{}", set));
        }
    }
    if (!scene.colors.empty()) names.push_back("COLOR_0");
    return names;
}

/// The mean over all directions: pixels weighted by their solid angles.
glm::dvec3 mean_radiance(const Environment& environment) {
    const auto [width, height] = environment.size;
    glm::dvec3 mean(0.0);
    for (std::uint32_t y = 0; y < height; ++y) {
        glm::dvec3 row(0.0);
        for (std::uint32_t x = 0; x < width; ++x) row += glm::dvec3(environment.radiance[std::size_t(y) * width + x]);
        const double of_sphere =
            0.5 * (std::cos(std::numbers::pi * y / height) - std::cos(std::numbers::pi * (y + 1.0) / height));
        mean += of_sphere / width * row;
    }
    return mean;
}

const char* kind_name(PunctualLight::Kind kind) {
    switch (kind) {
        case PunctualLight::Kind::point: return "point";
        case PunctualLight::Kind::spot: return "spot";
        case PunctualLight::Kind::directional: return "directional";
    }
    return "";
}

const char* unit(PunctualLight::Kind kind) { return kind == PunctualLight::Kind::directional ? "W/m^2" : "W/sr"; }

double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

template <typename Vector> Json json_of_vector(const Vector& v) { return {v[0], v[1], v[2]}; }

template <typename Vector> std::string text_of_vector(const Vector& v) {
    return fmt::format("({:g}, {:g}, {:g})", v[0], v[1], v[2]);
}

Json json_of(const PunctualLight& light) {
    Json json{{"name", light.name}, {"kind", kind_name(light.kind)}, {"intensity", json_of_vector(light.intensity)}};
    if (light.kind != PunctualLight::Kind::directional) json["position"] = json_of_vector(light.position);
    if (light.kind != PunctualLight::Kind::point) json["direction"] = json_of_vector(light.direction);
    if (light.range > 0.0) json["range"] = light.range;
    if (light.kind == PunctualLight::Kind::spot) {
        json["inner_cone_degrees"] = degrees(light.inner_cone);
        json["outer_cone_degrees"] = degrees(light.outer_cone);
    }
    return json;
}

std::string text_of(const PunctualLight& light) {
    std::string text = fmt::format("  {} '{}': {} {}", kind_name(light.kind), light.name,
                                   text_of_vector(light.intensity), unit(light.kind));
    if (light.kind != PunctualLight::Kind::directional) text += " at " + text_of_vector(light.position);
    if (light.kind != PunctualLight::Kind::point) text += " towards " + text_of_vector(light.direction);
    if (light.range > 0.0) text += fmt::format(", as far as {:g} m", light.range);
    if (light.kind == PunctualLight::Kind::spot) {
        text += fmt::format(", cone {:g} to {:g} degrees", degrees(light.inner_cone), degrees(light.outer_cone));
    }
    return text + "\n";
}

Json json_of(const Environment& environment) {
    return {{"width", environment.size.width},
            {"height", environment.size.height},
            {"mean_radiance", json_of_vector(mean_radiance(environment))}};
}

/// What a render takes.
struct Memory {
    std::string device;
    std::uint64_t device_bytes = 0;  // that it has
    Extent size;
    std::vector<MemoryReport> needed;
};

std::optional<Memory> memory_of(const InfoOptions& options, const Scene& scene, const FlatScene& flat) {
    if (!options.memory) return std::nullopt;
    const Settings settings = resolve_settings(options.settings, scene);
    const Device device(options.device);
    return Memory{device.info().name, device.info().memory_bytes, *settings.size,
                  memory_needed(flat, settings, device)};
}

std::uint64_t sum_of(const std::vector<MemoryReport>& memory) {
    std::uint64_t sum = 0;
    for (const MemoryReport& row : memory) sum += row.bytes;
    return sum;
}

Json json_of(const Memory& memory) {
    Json json{{"device", memory.device},        {"device_memory_bytes", memory.device_bytes},
              {"width", memory.size.width},     {"height", memory.size.height},
              {"bytes", sum_of(memory.needed)}, {"of", Json::array()}};
    for (const MemoryReport& row : memory.needed) {
        json["of"].push_back(
            {{"of", row.of}, {"count", row.count}, {"bytes_each", row.bytes_each()}, {"bytes", row.bytes}});
    }
    return json;
}

std::string text_of(const Memory& memory) {
    std::string text =
        fmt::format("a render of {}x{} takes {:.1f} MB of the {:.0f} MB of {}\n", memory.size.width, memory.size.height,
                    double(sum_of(memory.needed)) * 1e-6, double(memory.device_bytes) * 1e-6, memory.device);
    for (const MemoryReport& row : memory.needed) {
        fmt::format_to(std::back_inserter(text), "  {}: {} times {:.1f} bytes, {:.1f} MB\n", row.of, row.count,
                       row.bytes_each(), double(row.bytes) * 1e-6);
    }
    return text;
}

Json json_of(const Scene& scene, const std::vector<Feature>& features) {
    Json json;
    json["scene"] = scene.file.string();
    json["hash"] = hash_text(scene.hash);
    json["vertices"] = scene.positions.size();
    json["triangles"] = scene.triangles.size();
    json["vertex_attributes"] = vertex_attributes(scene);
    json["instances"] = scene.instances.size();
    json["shown_triangles"] = shown_triangles(scene);
    const SceneBox box = world_box(scene);
    json["bounds"] =
        box.is_empty() ? Json() : Json{{"min", json_of_vector(box.low)}, {"max", json_of_vector(box.high)}};
    json["materials"] = Json::array();
    const std::vector<std::size_t> triangles = triangles_by_material(scene);
    const std::vector<MaterialTraits> traits = traits_of(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        json["materials"].push_back({{"name", material.name},
                                     {"triangles", triangles[i]},
                                     {"emission", json_of_vector(material.emission)},
                                     {"treatment", describe_material(material, traits[i])}});
    }
    json["images"] = Json::array();
    for (const TextureImage& image : scene.images) {
        json["images"].push_back({{"name", image.name}, {"width", image.size.width}, {"height", image.size.height}});
    }
    json["lights"] = Json::array();
    for (const PunctualLight& light : scene.lights) json["lights"].push_back(json_of(light));
    json["environment"] = scene.environment ? json_of(*scene.environment) : Json();
    json["cameras"] = Json::array();
    for (const Camera& camera : scene.cameras) {
        json["cameras"].push_back({{"name", camera.name},
                                   {"node", camera.node},
                                   {"yfov_degrees", camera.ymag ? Json() : Json(degrees(camera.yfov))},
                                   {"height", camera.ymag ? Json(2.0 * *camera.ymag) : Json()},
                                   {"aspect", camera.aspect ? Json(*camera.aspect) : Json()},
                                   {"position", json_of_vector(camera.to_world[3])}});
    }
    json["features"] = Json::array();
    for (const Feature& feature : features) {
        json["features"].push_back({{"name", feature.name}, {"reason", feature.reason}});
    }
    json["warnings"] = scene.warnings;
    return json;
}

std::string plain_text(const Scene& scene, const std::vector<Feature>& features) {
    std::string text = fmt::format("{}: {} triangles, {} vertices, hash {}\n", scene.file.string(),
                                   scene.triangles.size(), scene.positions.size(), hash_text(scene.hash));
    const auto out = std::back_inserter(text);
    if (!scene.instances.empty()) {
        fmt::format_to(out, "{} instances of {} meshes: {} triangles are shown\n", scene.instances.size(),
                       scene.meshes.size(), shown_triangles(scene));
    }
    if (const SceneBox box = world_box(scene); !box.is_empty()) {
        fmt::format_to(out, "bounds {} to {} m\n", text_of_vector(box.low), text_of_vector(box.high));
    }
    fmt::format_to(out, "vertices with {}\n", fmt::join(vertex_attributes(scene), ", "));
    fmt::format_to(out, "{} materials\n", scene.materials.size());
    const std::vector<std::size_t> triangles = triangles_by_material(scene);
    const std::vector<MaterialTraits> traits = traits_of(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        fmt::format_to(out, "  {} '{}', {} triangles: {}\n", i, material.name, triangles[i],
                       describe_material(material, traits[i]));
    }
    fmt::format_to(out, "{} images\n", scene.images.size());
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        const TextureImage& image = scene.images[i];
        fmt::format_to(out, "  {} '{}', {}x{}\n", i, image.name, image.size.width, image.size.height);
    }
    if (scene.environment) {
        const Extent size = scene.environment->size;
        fmt::format_to(out, "environment of {}x{}, mean radiance {} W m^-2 sr^-1\n", size.width, size.height,
                       text_of_vector(mean_radiance(*scene.environment)));
    }
    fmt::format_to(out, "{} punctual lights\n", scene.lights.size());
    for (const PunctualLight& light : scene.lights) text += text_of(light);
    fmt::format_to(out, "{} cameras\n", scene.cameras.size());
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        const std::string height = camera.ymag ? fmt::format("orthographic, {:g} m high", 2.0 * *camera.ymag)
                                               : fmt::format("{:g} degrees high", degrees(camera.yfov));
        fmt::format_to(
            out, "  {} '{}'{}: {}{} at {}\n", i, camera.name,
            camera.node.empty() || camera.node == camera.name ? "" : fmt::format(" of node '{}'", camera.node), height,
            camera.aspect ? fmt::format(", aspect {:g},", *camera.aspect) : "", text_of_vector(camera.to_world[3]));
    }
    fmt::format_to(out, "{} features, which its kernels are specialised to\n", features.size());
    for (const Feature& feature : features) fmt::format_to(out, "  {}: {}\n", feature.name, feature.reason);
    text += gathering_rule;
    return text;
}

}  // namespace

void execute(const InfoOptions& options) {
    const Scene scene = load_scene(options.scene);
    tell_warnings(scene, options.scene);
    const FlatScene flat = flatten(scene);
    const std::optional<Memory> memory = memory_of(options, scene, flat);
    if (options.json) {
        Json json = json_of(scene, flat.features);
        if (memory) json["memory"] = json_of(*memory);
        print_result(json_text(json, 2) + "\n");
    } else {
        print_result(plain_text(scene, flat.features) + (memory ? text_of(*memory) : ""));
    }
}

}  // namespace vkcppm
