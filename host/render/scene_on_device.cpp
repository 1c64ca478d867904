#include "render/scene_on_device.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "flat/bounds.h"
#include "flat/features.h"
#include "render/kernel_choice.h"
#include "render/memory.h"

namespace vkcppm {
namespace {

/// Depth in front of which there is nothing, for an eye that is far from a scene of radius 1; 0 for others.
double empty_depth(const glm::dvec3& eye, const glm::dvec3& forward) {
    constexpr double far = 8.0;
    return std::max(0.0, -glm::dot(eye, forward) - far);
}

void set_camera(gpu::Params& params, const Camera& camera, const SceneFrame& frame, Extent size) {
    const double half_height = camera.ymag ? *camera.ymag * frame.scale : std::tan(0.5 * camera.yfov);
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
    params.orthographic = camera.ymag ? 1 : 0;
    params.pixel_radius = float(2.0 * half_height / double(size.height) / std::sqrt(std::numbers::pi));
}

/// Empties it and gives back its memory, which an assignment of {} keeps.
template <typename T> void release(std::vector<T>& values) { std::vector<T>().swap(values); }

}  // namespace

SceneOnDevice::SceneOnDevice(Device& device, const FlatScene& scene) : device_(device), scene_(scene) {
    put(Binding::nodes, scene.bvh.nodes);
#define UPLOAD(number, name, Element, per, entries, access, life, hashed) put(Binding::name, scene.name);
    SCENE_BUFFERS(UPLOAD)
#undef UPLOAD
}

SceneOnDevice::SceneOnDevice(Device& device, FlatScene&& scene)
    : device_(device), own_(std::move(scene)), scene_(own_) {
    release(own_.bvh.order);
    release(own_.first_corner);
#define UPLOAD(number, name, Element, per, entries, access, life, hashed) \
    put(Binding::name, own_.name);                                        \
    if (Per::per == Per::triangle || Per::per == Per::texel || Per::per == Per::sky_pixel) release(own_.name);
    SCENE_BUFFERS(UPLOAD)
#undef UPLOAD
    put(Binding::nodes, own_.bvh.nodes);
}

template <typename T> void SceneOnDevice::put(Binding binding, const std::vector<T>& data) {
    if (binding == Binding::nodes && data.size() > std::size_t(1) << BVH_MAX_NODE_BITS) {
        throw Error(ExitCode::out_of_device_memory,
                    fmt::format("the scene needs {} nodes of a BVH, the kernels hold {}", data.size(),
                                1u << BVH_MAX_NODE_BITS));
    }
    buffers_.emplace(binding, Buffer(device_, binding, data.size() * sizeof(T))).first->second.upload(data);
}

void SceneOnDevice::lend(Buffers& buffers) const {
    for (const auto& [binding, buffer] : buffers_) buffers.lend(binding, buffer);
}

SceneOnDevice put_on_device(const Scene& scene, const Settings& settings, Device& device) {
    check_memory(scene, settings, device);
    return SceneOnDevice(device, flatten(scene));
}

Specialization scene_specialization(const FlatScene& scene, std::uint32_t features) {
    const bool is_fine = std::ranges::any_of(scene.textures, [](const gpu::TextureLookup& t) { return t.fine != 0; });
    return {
        {SPEC_WORKGROUP, workgroup},      {SPEC_STACK, scene.bvh.stack},
        {SPEC_PLANES, is_fine ? 2u : 1u}, {SPEC_NODE_BITS, std::uint32_t(std::bit_width(scene.bvh.nodes.size() - 1))},
        {SPEC_FEATURES, features},        {SPEC_LIGHT_TREE, scene.light_tree.empty() ? 0u : 1u}};
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
    const Media media = media_at(scene.solids, scene.frame.point(glm::dvec3(camera.to_world[3])));
    params.eye_medium = media.first;
    params.eye_media = media.others;
    params.light_count = std::uint32_t(scene.lights.size());
    if (split && splits_near_lamps(scene)) params.near_lights = float(near_lamp * scene.radius);
    params.light_power = float(scene.light_power);
    assert(scene.asked.size() <= GROUPS_ASKED(bits_of(scene.features)));
    std::ranges::copy(scene.asked, params.asked);
    params.local_power = float(scene.local_power);
    params.environment_power = float(scene.environment_power);
    params.environment = {scene.environment_size.width, scene.environment_size.height};
    params.lens_radius = float(0.5 * lens_diameter(settings, camera) * scene.frame.scale);
    params.focus_distance = float(settings.focus_distance.value_or(1.0) * scene.frame.scale);
    params.step_budget = device.policy().step_budget;
    return params;
}

}  // namespace vkcppm
