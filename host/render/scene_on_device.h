#pragma once
// What is on the device once a scene, however many renderers read it: geometry, textures, lights.

#include <cstdint>
#include <map>

#include "flat/flatten.h"
#include "render/buffers.h"
#include "render/settings.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm {

class SceneOnDevice {
public:
    /// Uploads the scene, which must outlive this. Throws Error(out_of_device_memory) where it does not fit the device.
    SceneOnDevice(Device& device, const FlatScene& scene);
    /// The same, and keeps of it but what is not one for each of many: triangles and texels are gone from the host.
    SceneOnDevice(Device& device, FlatScene&& scene);
    SceneOnDevice(const SceneOnDevice&) = delete;  // renderers point into it
    SceneOnDevice& operator=(const SceneOnDevice&) = delete;

    Device& device() const { return device_; }
    const FlatScene& flat() const { return scene_; }

    /// Binds its buffers for a renderer, which must not outlive this.
    void lend(Buffers& buffers) const;

private:
    template <typename T> void put(Binding binding, const std::vector<T>& data);

    Device& device_;
    FlatScene own_;
    const FlatScene& scene_;
    std::map<Binding, Buffer> buffers_;
};

/// The scene, flattened and uploaded. Throws as check_memory(), which is asked first: `settings`, which must be
/// resolved, are of what is to be rendered of it.
SceneOnDevice put_on_device(const Scene& scene, const Settings& settings, Device& device);

/// SPEC_* of every kernel that traces rays. features: FEATURE_*.
Specialization scene_specialization(const FlatScene& scene, std::uint32_t features);

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
