#include "render/path_tracer.h"

#include "flat/features.h"
#include "render/kernels.h"
#include "render/status.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t most_rounds = 64;  // of a submission

Specialization specialize(const FlatScene& scene, const Settings& settings, PathTracer::Light light) {
    std::uint32_t features = feature_bits(scene, settings);
    features &= ~(FEATURE_AOVS | FEATURE_ERRORS | FEATURE_SPLIT | FEATURE_DIRECT);
    if (light == PathTracer::Light::split) features |= FEATURE_SPLIT;
    return scene_specialization(scene, features);
}

}  // namespace

PathTracer::PathTracer(const SceneOnDevice& scene, const Camera& camera, const Settings& settings, Light light,
                       std::uint64_t most_band_pixels)
    : device_(scene.device()),
      bindings_(device_),
      commands_(device_, bindings_),
      buffers_(device_, bindings_),
      kernel_(device_, std::string(row_of(KernelId::path).name), words_of(KernelId::path, {}),
              specialize(scene.flat(), settings, light)),
      size_(*settings.size) {
    scene.lend(buffers_);
    Counts counts;
    counts.traced = true;
    bands_ = counts.bands = bands_of(size_.pixels(), counts, device_, most_band_pixels);
    buffers_.allocate(counts, [](const BufferRow& row) {
        return row.entries == Entries::where_traced || row.binding == Binding::image ||
               row.binding == Binding::params || row.binding == Binding::status;
    });
    buffers_.at(Binding::params)
        .upload_value(scene_params(device_, scene.flat(), camera, settings, light == Light::split));
}

Image PathTracer::trace() {
    Image image{size_, std::vector<glm::vec3>(size_.pixels())};
    for (std::uint32_t band = 0; band < bands_.count(); ++band) {
        trace(bands_.first(band), bands_.size(band));
        buffers_.at(Binding::image).download_to(std::span(image.rgb).subspan(bands_.first(band), bands_.size(band)));
    }
    ++batches_;
    return image;
}

/// The pixels of a band, of which no state is kept.
void PathTracer::trace(std::uint64_t first, std::uint64_t pixels) {
    gpu::Status status{};
    status.completed = batches_;
    gpu::Launch push{.iteration = batches_, .paths = batch};
    push.first_pixel = std::uint32_t(first);
    push.pixels = std::uint32_t(pixels);
    bool blocked = true;
    for (std::uint32_t first_round = 0; blocked; first_round += rounds_) {
        if (first_round > 0 && rounds_ < most_rounds) rounds_ *= 2;
        buffers_.at(Binding::status).upload_value(status);
        commands_.begin();
        for (std::uint32_t r = 0; r < rounds_; ++r) {
            push.round = first_round + r;
            push.last_round = r + 1 == rounds_ ? 1 : 0;
            commands_.launch(kernel_, pixels, push);
        }
        for (const Timing& timing : commands_.finish()) {
            ++pass_.calls;
            pass_.device_seconds += timing.seconds;
        }
        status = buffers_.at(Binding::status).download_value<gpu::Status>();
        blocked = status.blocked != 0;
        const StatusCounts counts = take_counts(status, device_.policy().step_budget, device_.info().name);
        rays_ += counts.rays;
        invalid_ += counts.invalid;
    }
}

}  // namespace vkcppm
