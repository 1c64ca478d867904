#include "scene/gltf/lights.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <charconv>
#include <numbers>
#include <system_error>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/values.h"

namespace vkcppm {

namespace {

/// KHR_lights_punctual: 0 <= inner < outer <= pi/2. False, with a warning, where nothing is in the cone.
bool read_cone(const tinygltf::SpotLight& spot, const std::string& object, PunctualLight& light, Warnings& warnings) {
    constexpr double right_angle = std::numbers::pi / 2.0;
    constexpr double rounding = 1e-6;            // pi/2 written as float lies above pi/2
    constexpr double widest_inner = 1.0 - 1e-3;  // of outer: a hard edge that is still a falloff
    if (!(spot.outerConeAngle > 0.0)) {
        warnings.add("its light is skipped, the cone must be wider than 0",
                     fmt::format("{}.spot.outerConeAngle = {}", object, spot.outerConeAngle));
        return false;
    }
    const double outer =
        clamped(spot.outerConeAngle, 0.0, right_angle + rounding, object + ".spot.outerConeAngle", warnings);
    light.outer_cone = std::min(outer, right_angle);
    light.inner_cone =
        clamped(spot.innerConeAngle, 0.0, widest_inner * light.outer_cone, object + ".spot.innerConeAngle", warnings);
    return true;
}

/// Whether a file is of Blender's exporter of version 3.4 or later, which multiplies watts by 683 unless it is told not
/// to.
bool is_by_watts_of_blender(const nlohmann::json& generator) {
    constexpr std::string_view name = "Khronos glTF Blender I/O v";
    if (!generator.is_string() || !generator.get_ref<const std::string&>().starts_with(name)) return false;
    std::string_view version = std::string_view(generator.get_ref<const std::string&>()).substr(name.size());
    std::array<int, 2> numbers{};
    for (int& number : numbers) {
        const auto [end, error] = std::from_chars(version.data(), version.data() + version.size(), number);
        if (error != std::errc()) return false;
        version.remove_prefix(std::min<std::size_t>(version.size(), std::size_t(end - version.data()) + 1));
    }
    return numbers >= std::array{3, 4};
}

}  // namespace

std::string_view name_of(PunctualUnits units) {
    return units == PunctualUnits::radiometric   ? "radiometric"
           : units == PunctualUnits::photometric ? "photometric"
                                                 : "auto";
}

double lumens_per_watt(const GltfFile& file, PunctualUnits units, Warnings& warnings) {
    constexpr double luminous_efficacy = 683.0;  // lm/W: of green of 555 nm, and the exporter's of any light
    if (units == PunctualUnits::radiometric) return 1.0;
    if (units == PunctualUnits::photometric) return luminous_efficacy;
    if (!is_by_watts_of_blender(file.document["asset"].value("generator", nlohmann::json()))) return 1.0;
    warnings.add(fmt::format("taken for candela and lux, as Blender's exporter makes them of watts, and divided by {}; "
                             "--punctual-units says otherwise",
                             luminous_efficacy),
                 "the intensities of its punctual lights");
    return luminous_efficacy;
}

std::optional<PunctualLight> read_light(const GltfFile& file, const tinygltf::Model& model, const PlacedNode& placed,
                                        double per_watt, Warnings& warnings) {
    const int index = placed.index;
    const glm::dmat4& to_world = placed.to_world;
    const tinygltf::Node& node = model.nodes[index];
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end()) return std::nullopt;
    const int light_index = extension->second.Get("light").GetNumberAsInt();
    const tinygltf::Light& source = model.lights[light_index];
    const std::string object = fmt::format("lights[{}]", light_index);
    PunctualLight light;
    light.kind = source.type == "point"  ? PunctualLight::Kind::point
                 : source.type == "spot" ? PunctualLight::Kind::spot
                                         : PunctualLight::Kind::directional;
    light.name = source.name.empty() ? node.name : source.name;
    if (source.intensity < 0.0) {
        warnings.add("its light is skipped, none takes light away",
                     fmt::format("{}.intensity = {}", object, source.intensity));
        return std::nullopt;
    }
    const glm::dvec3 color = source.color.empty() ? glm::dvec3(1.0) : glm::make_vec3(source.color.data());
    light.intensity =
        emitted(color, source.intensity / per_watt, object + ".color", object + ".intensity", file.name, warnings);
    light.position = glm::dvec3(to_world[3]);
    if (light.kind != PunctualLight::Kind::point) {
        light.direction = unit_or_zero(-glm::dvec3(to_world[2]));
        if (light.direction == glm::dvec3(0.0)) {
            warnings.add("its light is skipped, the transform is singular", fmt::format("nodes[{}]", index));
            return std::nullopt;
        }
    }
    const nlohmann::json& json = file.document["extensions"]["KHR_lights_punctual"]["lights"][light_index];
    if (light.kind == PunctualLight::Kind::spot) {
        if (!json.contains("spot")) warnings.add("missing, its cone is the default", object + ".spot");
        if (!read_cone(source.spot, object, light, warnings)) return std::nullopt;
    }
    if (light.kind != PunctualLight::Kind::directional && json.contains("range")) {
        if (!(source.range > 0.0)) {
            warnings.add("ignored, it must be greater than 0", fmt::format("{}.range = {}", object, source.range));
        } else if (source.range <= FLT_MAX) {
            light.range = source.range;
        }
    }
    return light;
}

}  // namespace vkcppm
