#include "render/scene_buffers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "flat/features.h"
#include "render/kernel_choice.h"
#include "flat/lights.h"
#include "shared/bindings.h"

namespace vkcppm {
namespace {

/// Depth in front of which there is nothing, for an eye that is far from a scene of radius 1; 0 for others.
double empty_depth(const glm::dvec3& eye, const glm::dvec3& forward) {
    constexpr double far = 8.0;
    return std::max(0.0, -glm::dot(eye, forward) - far);
}

void set_camera(gpu::Params& params, const Camera& camera, const SceneFrame& frame, Extent size) {
    const double half_height = std::tan(0.5 * camera.yfov);
    const double half_width = half_height * double(size.width) / double(size.height);
    const glm::dvec3 eye = frame.point(glm::dvec3(camera.to_world[3])), forward = -glm::dvec3(camera.to_world[2]);
    const double start = empty_depth(eye, forward);
    params.start = float(start);
    params.eye = glm::vec3(eye + double(params.start) * forward);
    params.right = glm::vec3(glm::dvec3(camera.to_world[0]) * half_width);
    params.up = glm::vec3(glm::dvec3(camera.to_world[1]) * half_height);
    params.forward = glm::vec3(forward);
    params.width = size.width;
    params.height = size.height;
    params.pixel_radius = float(2.0 * half_height / double(size.height) / std::sqrt(std::numbers::pi));
}

}  // namespace

SceneBuffers::SceneBuffers(Device& device, Bindings& bindings, const FlatScene& scene)
    : device_(device), bindings_(bindings) {
    if (scene.bvh.nodes.size() > std::size_t(1) << BVH_MAX_NODE_BITS) {
        throw Error(ExitCode::out_of_device_memory,
                    fmt::format("the scene's {} triangles need {} nodes of a BVH, the kernels hold {}",
                                scene.triangles.size(), scene.bvh.nodes.size(), 1u << BVH_MAX_NODE_BITS));
    }
    using Kind = Buffer::Kind;
    upload(BIND_NODES, "bvh nodes", scene.bvh.nodes, Kind::uint_texels);
    upload(BIND_TRIANGLES, "triangles", scene.triangles, Kind::float_texels);
    upload(BIND_SHADING, "shading", scene.shading, Kind::uint_texels);
    upload(BIND_MATERIALS, "materials", scene.materials, Kind::uint_texels);
    upload(BIND_LIGHTS, "lights", scene.lights, Kind::uint_texels);
    upload(BIND_TEXCOORDS, "texture coordinates", scene.texcoords, Kind::float_texels);
    upload(BIND_VERTEX_COLORS, "vertex colours", scene.vertex_colors, Kind::uint_texels);
    upload(BIND_TANGENTS, "tangents", scene.tangents, Kind::uint_texels);
    upload(BIND_TEXTURES, "textures", scene.textures, Kind::uint_texels);
    upload(BIND_TEXELS, "texels", scene.texels, Kind::word_texels);
    upload(BIND_ENVIRONMENT, "environment", scene.environment, Kind::float_texels);
    upload(BIND_ENVIRONMENT_ALIAS, "environment alias table", scene.environment_alias, Kind::word_texels);
}

void SceneBuffers::allocate(std::uint32_t binding, const std::string& name, std::uint64_t bytes, Buffer::Kind kind) {
    buffers_.erase(binding);
    buffers_.emplace(binding, Buffer(device_, name, bytes, kind));
    bindings_.bind(binding, buffers_.at(binding));
    if (const auto texels = texels_over(binding)) bindings_.bind(*texels, buffers_.at(binding));
}

std::map<std::uint32_t, std::uint64_t> SceneBuffers::bytes() const {
    std::map<std::uint32_t, std::uint64_t> all;
    for (const auto& [binding, buffer] : buffers_) all[binding] = buffer.bytes();
    return all;
}

std::optional<std::uint32_t> texels_over(std::uint32_t binding) {
    switch (binding) {
        case BIND_HIT_POSITION: return BIND_HIT_POSITION_TEXELS;
        case BIND_HIT_WEIGHT: return BIND_HIT_WEIGHT_TEXELS;
        case BIND_HIT_EMISSION: return BIND_HIT_EMISSION_TEXELS;
        case BIND_HIT_SURFACE: return BIND_HIT_SURFACE_TEXELS;
        case BIND_GATHERED: return BIND_GATHERED_TEXELS;
        case BIND_PIXELS: return BIND_PIXEL_TEXELS;
        case BIND_TALLY: return BIND_TALLY_TEXELS;
        case BIND_MOMENTS: return BIND_MOMENT_TEXELS;
        case BIND_FILM: return BIND_FILM_TEXELS;
        case BIND_PHOTONS: return BIND_PHOTON_TEXELS;
        case BIND_PHOTON_FLUX: return BIND_PHOTON_FLUX_TEXELS;
        case BIND_SORTED: return BIND_SORTED_TEXELS;
        case BIND_SORTED_FLUX: return BIND_SORTED_FLUX_TEXELS;
        case BIND_COUNTERS: return BIND_COUNTER_TEXELS;
        default: return std::nullopt;
    }
}

Specialization scene_specialization(const Bvh& bvh, std::uint32_t features) {
    return {{SPEC_WORKGROUP, workgroup},
            {SPEC_STACK, bvh.stack},
            {SPEC_NODE_BITS, std::uint32_t(std::bit_width(bvh.nodes.size() - 1))},
            {SPEC_FEATURES, features}};
}

bool splits_near_lamps(const FlatScene& scene) {
    // Photons that pass a surface do not remember how far they have come.
    const std::uint32_t features = bits_of(scene.features);
    return (features & FEATURE_AREA_LIGHTS) != 0 && (features & FEATURE_ALPHA) == 0;
}

gpu::Params scene_params(const Device& device, const FlatScene& scene, const Camera& camera, const Settings& settings,
                         bool split) {
    gpu::Params params{};
    set_camera(params, camera, scene.frame, *settings.size);
    params.seed = settings.seed;
    params.bounds_low = scene.low;
    params.bounds_high = scene.high;
    params.bounds_radius = float(bounds_radius(scene));
    params.max_depth = settings.max_depth;
    params.light_count = std::uint32_t(scene.lights.size());
    if (split && splits_near_lamps(scene)) params.near_lights = float(near_lamp * scene.radius);
    params.light_power = float(scene.light_power);
    params.environment = {scene.environment_size.width, scene.environment_size.height};
    params.lens_radius = float(0.5 * settings.aperture * scene.frame.scale);
    params.focus_distance = float(settings.focus_distance.value_or(1.0) * scene.frame.scale);
    params.step_budget = device.step_budget();
    return params;
}

}  // namespace vkcppm
