#pragma once
// A scene on the device of the tests, ready to run iterations or single kernels of it.

#include <cstdint>
#include <vector>

#include "render/flatten.h"
#include "render/integrator.h"
#include "render/render.h"
#include "scene/scene.h"
#include "support/gpu.h"

namespace vkcppm::test {

/// Where a light path has stored its photons: `count` of them from `slot` on.
struct StoredPath {
    std::size_t slot;
    std::uint32_t count;
};

struct Rig {
    Rig(Scene scene_, const Settings& wanted, Device& on = device())
        : scene(std::move(scene_)),
          settings(resolve_settings(wanted, scene)),
          flat(flatten(scene)),
          integrator(on, flat, scene.cameras.at(0), settings) {}

    /// The whole buffer of that binding as values of T.
    template <typename T>
    std::vector<T> all(std::uint32_t binding) {
        Buffer& buffer = integrator.buffer(binding);
        return buffer.download<T>(buffer.bytes() / sizeof(T));
    }
    /// The photons of the last iteration's light paths, in their order.
    std::vector<StoredPath> stored_paths() {
        const gpu::Params& params = integrator.params();
        const auto counters = all<std::uint32_t>(BIND_COUNTERS);
        const std::uint32_t* offsets = counters.data() + params.cells + 1;
        const std::uint32_t* slots = offsets + params.photons + 1;
        std::vector<StoredPath> paths;
        for (std::uint32_t p = 0; p < params.photons; ++p) paths.push_back({slots[p], offsets[p + 1] - offsets[p]});
        return paths;
    }
    gpu::Status status() { return integrator.buffer(BIND_STATUS).download_value<gpu::Status>(); }
    std::uint64_t pixels() const { return settings.size->pixels(); }

    Scene scene;
    Settings settings;
    FlatScene flat;
    Integrator integrator;
};

}  // namespace vkcppm::test
