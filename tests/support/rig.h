#pragma once
// A scene on the device of the tests, ready to run iterations or single kernels of it.

#include <cstdint>

#include "render/flatten.h"
#include "render/integrator.h"
#include "render/render.h"
#include "scene/scene.h"
#include "support/gpu.h"

namespace vkcppm::test {

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
    gpu::Status status() { return integrator.buffer(BIND_STATUS).download_value<gpu::Status>(); }
    std::uint64_t pixels() const { return settings.size->pixels(); }

    Scene scene;
    Settings settings;
    FlatScene flat;
    Integrator integrator;
};

}  // namespace vkcppm::test
