#pragma once
// Unbiased path tracing on the device: shaders/kernels/path.comp.

#include <cstdint>

#include "core/image.h"
#include "render/buffers.h"
#include "render/kernels.h"
#include "render/report.h"
#include "render/scene_on_device.h"
#include "render/settings.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm {

class PathTracer {
public:
    /// Which paths: all that path tracing finds, or the paths' half of split light (FEATURE_SPLIT).
    enum class Light { all, split };

    /// Compiles the pipeline. `scene` must outlive this, `settings` be resolved; size, camera, lens, seed and max_depth
    /// count. most_band_pixels: as of the Integrator. Throws Error(out_of_device_memory) where the picture does not fit
    /// the device beside what is on it.
    PathTracer(const SceneOnDevice& scene, const Camera& camera, const Settings& settings, Light light,
               std::uint64_t most_band_pixels = 0);

    /// Paths a pixel of one trace().
    static constexpr std::uint32_t batch = 16;

    /// The mean of the next `batch` paths of every pixel, independent of those before it but for its place in the
    /// low-discrepancy sequence over the pixel. Throws Error(device_lost), Error(internal) where a ray cannot be traced
    /// within the device's limits.
    Image trace();

    std::uint32_t batches() const { return batches_; }
    double seconds() const { return pass_.device_seconds; }  // device time so far
    const PassReport& pass() const { return pass_; }
    std::uint64_t rays() const { return rays_; }
    std::uint64_t invalid() const { return invalid_; }  // paths that were not finite and were dropped

private:
    void trace(std::uint64_t first, std::uint64_t pixels);

    Device& device_;
    Bindings bindings_;
    Commands commands_;
    Buffers buffers_;
    Kernel kernel_;
    Extent size_;
    Bands bands_;
    PassReport pass_{std::string(row_of(KernelId::path).name)};
    std::uint32_t rounds_ = 1;
    std::uint32_t batches_ = 0;
    std::uint64_t rays_ = 0;
    std::uint64_t invalid_ = 0;
};

}  // namespace vkcppm
