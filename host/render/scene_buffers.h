#pragma once
// What every kernel that traces rays reads: the scene on the device, and the parameters that follow from the scene,
// the camera and the settings.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "flat/flatten.h"
#include "render/settings.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm {

/// The buffers of one renderer by their bindings (BIND_*): those of the scene from the start, others as they are
/// allocated. Each is bound as long as it lives.
class SceneBuffers {
public:
    /// Throws Error(out_of_device_memory) where the scene does not fit the device.
    SceneBuffers(Device& device, Bindings& bindings, const FlatScene& scene);

    /// A buffer of `bytes` zeros at `binding`, and where kernels read it as texels, in place of what stood there.
    /// Throws Error(out_of_device_memory).
    void allocate(std::uint32_t binding, const std::string& name, std::uint64_t bytes, Buffer::Kind kind);

    /// The same that holds `data`.
    template <typename T>
    void upload(std::uint32_t binding, const std::string& name, const std::vector<T>& data, Buffer::Kind kind) {
        allocate(binding, name, data.size() * sizeof(T), kind);
        at(binding).upload(data);
    }

    /// Asserts that there is one.
    Buffer& at(std::uint32_t binding) { return buffers_.at(binding); }
    const Buffer& at(std::uint32_t binding) const { return buffers_.at(binding); }

    /// Bytes of the buffers by their bindings.
    std::map<std::uint32_t, std::uint64_t> bytes() const;

private:
    Device& device_;
    Bindings& bindings_;
    std::map<std::uint32_t, Buffer> buffers_;
};

/// The binding by which kernels read as texels what stands at a storage binding; none where they do not.
std::optional<std::uint32_t> texels_over(std::uint32_t binding);

/// SPEC_* of every kernel that traces rays. features: FEATURE_*.
Specialization scene_specialization(const Bvh& bvh, std::uint32_t features);

/// The part of the scene's radius from a lamp within which a surface is near it, where light is split.
inline constexpr double near_lamp = 0.04;

/// Camera, lens, bounds, lights, seed, depth and step budget, in the scene's frame; the rest is 0. `settings` must be
/// resolved. split: FEATURE_SPLIT.
gpu::Params scene_params(const Device& device, const FlatScene& scene, const Camera& camera, const Settings& settings,
                         bool split);

/// True where splitting the light of this scene takes what is near its lamps to the photons: it has lamps of some area,
/// and no surface that is partly there.
bool splits_near_lamps(const FlatScene& scene);

}  // namespace vkcppm
