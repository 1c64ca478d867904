#include "render/path_tracer.h"

#include <fmt/format.h>

#include "core/error.h"
#include "flat/features.h"
#include "render/kernels.h"
#include "shared/bindings.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t timed_launches = 64;

Specialization specialize(const FlatScene& scene, const Settings& settings, PathTracer::Light light) {
    std::uint32_t features = bits_of(scene.features) | bits_of(features_of(settings));
    features &= ~(FEATURE_AOVS | FEATURE_SPLIT);
    if (light == PathTracer::Light::split) features |= FEATURE_SPLIT;
    return scene_specialization(scene.bvh, features);
}

}  // namespace

PathTracer::PathTracer(Device& device, const FlatScene& scene, const Camera& camera, const Settings& settings,
                       Light light)
    : device_(device),
      bindings_(device),
      commands_(device, bindings_, timed_launches),
      buffers_(device, bindings_, scene),
      kernel_(device, bindings_, "path", kernel_module("path").spirv, specialize(scene, settings, light)),
      size_(*settings.size) {
    using Kind = Buffer::Kind;
    const gpu::Params params = scene_params(device, scene, camera, settings, light == Light::split);
    buffers_.upload(BIND_PARAMS, "parameters", std::vector{params}, Kind::uniform);
    buffers_.allocate(BIND_STATUS, "status", sizeof(gpu::Status), Kind::storage);
    buffers_.allocate(BIND_PATHS, "traces", size_.pixels() * sizeof(gpu::TraceState), Kind::storage);
    buffers_.allocate(BIND_IMAGE, "image", size_.pixels() * sizeof(gpu::vec3), Kind::storage);
}

Image PathTracer::trace() {
    gpu::Status status{};
    status.completed = batches_;
    for (std::uint32_t first_round = 0; first_round == 0 || status.blocked != 0;) {
        status.blocked = status.rays = status.invalid = 0;
        buffers_.at(BIND_STATUS).upload_value(status);
        commands_.begin();
        for (std::uint32_t r = 0; r < rounds_; ++r) {
            const std::uint32_t last = r + 1 == rounds_ ? 1 : 0;
            commands_.launch(
                kernel_, size_.pixels(),
                {.iteration = batches_, .round = first_round + r, .last_round = last, .offset = 0, .count = batch});
        }
        for (const Timing& timing : commands_.finish()) {
            ++pass_.calls;
            pass_.device_seconds += timing.seconds;
        }
        first_round += rounds_;
        status = buffers_.at(BIND_STATUS).download_value<gpu::Status>();
        if (status.stuck > 0) {
            throw Error(ExitCode::internal,
                        fmt::format("{} rays need more than {} steps of the BVH each, the limit of device '{}'",
                                    status.stuck, device_.step_budget(), device_.info().name));
        }
        rays_ += status.rays;
        invalid_ += status.invalid;
        if (status.blocked != 0 && rounds_ < timed_launches) rounds_ *= 2;
    }
    ++batches_;
    return {size_, buffers_.at(BIND_IMAGE).download<glm::vec3>(size_.pixels())};
}

}  // namespace vkcppm
