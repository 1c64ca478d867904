#pragma once
// A scene on the device of the tests, ready to run iterations or single kernels of it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "render/integrator.h"
#include "render/render.h"
#include "scene/scene.h"
#include "support/device/gpu.h"

namespace vkcppm::test {

/// Of a small render that keeps all that one can: every further channel, and what errors are estimated from.
inline Settings settings_with_all(const std::string& estimator, Extent size = {24, 16}, std::uint32_t photons = 600) {
    Settings settings;
    settings.estimator = estimator;
    settings.size = size;
    settings.photons = photons;
    settings.aovs = true;
    settings.error = true;
    return settings;
}

/// Where a light path has stored its photons: `count` of them from `slot` on.
struct StoredPath {
    std::size_t slot;
    std::uint32_t count;
};

struct Rig {
    Rig(Scene scene_, const Settings& wanted, Device& on = device(), std::uint64_t most_band_pixels = 0)
        : scene(std::move(scene_)),
          settings(resolve_settings(wanted, scene)),
          flat(flatten(scene)),
          on_device(on, flat),
          integrator(on_device, scene.cameras.at(0), settings, {}, most_band_pixels) {}

    /// The whole buffer of that binding as values of T.
    template <typename T> std::vector<T> all(Binding binding) {
        Buffer& buffer = integrator.buffer(binding);
        return buffer.download<T>(buffer.bytes() / sizeof(T));
    }
    /// The photons of the last iteration's light paths, in their order.
    std::vector<StoredPath> stored_paths() {
        const gpu::Params& params = integrator.params();
        const auto counters = all<std::uint32_t>(Binding::counters);
        const std::uint32_t* offsets = counters.data() + params.cells + 1;
        const std::uint32_t* slots = offsets + params.photons + 1;
        std::vector<StoredPath> paths;
        for (std::uint32_t p = 0; p < params.photons; ++p) paths.push_back({slots[p], offsets[p + 1] - offsets[p]});
        return paths;
    }
    /// Of one invocation: what needs more steps goes on in further rounds.
    void set_step_budget(std::uint32_t steps) {
        gpu::Params params = integrator.params();
        params.step_budget = steps;
        integrator.set_params(params);
    }
    Report report() const {
        Report told;
        integrator.fill(told);
        return told;
    }
    gpu::Status status() { return integrator.buffer(Binding::status).download_value<gpu::Status>(); }
    std::uint64_t pixels() const { return settings.size->pixels(); }

    Scene scene;
    Settings settings;
    FlatScene flat;
    SceneOnDevice on_device;
    Integrator integrator;
};

/// All that an iteration leaves to the next is the same, byte for byte.
inline void expect_same_state(const Rig& a, const Rig& b, const std::string& what) {
    const std::vector<std::byte> left = a.integrator.save(), right = b.integrator.save();
    ASSERT_EQ(left.size(), right.size()) << what;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < left.size(); ++i) differing += left[i] != right[i] ? 1 : 0;
    EXPECT_EQ(differing, 0u) << "of " << left.size() << " bytes of state, " << what;
}

/// Small discs and large ones, which stay as they are. Before iteration 1, so that the grid of iteration 2 is planned
/// for them and has several levels.
inline void set_two_radii(Rig& rig) {
    auto states = rig.all<gpu::PixelState>(Binding::pixels);
    states.resize(rig.pixels());
    for (std::size_t i = 0; i < states.size(); ++i) {
        const float radius = i % 2 == 0 ? 0.3f : 3e-3f;
        states[i].radius2 = radius * radius;
        states[i].seeded = 1;
        states[i].batch = 1e30f;
    }
    rig.integrator.buffer(Binding::pixels).upload(states);
}

/// Gathers in iteration 1 with whatever stands in the buffers, in as many rounds as it takes.
inline void gather(Rig& rig) {
    for (std::uint32_t round = 0; round < 100; ++round) {
        gpu::Status status = rig.status();
        status.blocked = 0;
        rig.integrator.buffer(Binding::status).upload_value(status);
        rig.integrator.run_kernel(KernelId::gather, rig.pixels(), {.iteration = 1, .round = round, .last_round = 1});
        if (rig.status().blocked == 0) return;
    }
    FAIL() << "the gather does not end";
}

/// The picture after so many iterations, on the device without the validation layer. Expects that all that was added to
/// it are numbers.
inline Image valid_picture(const Scene& scene, const Settings& settings, std::uint32_t iterations) {
    Rig rig(scene, settings, plain_device());
    rig.integrator.run(iterations);
    EXPECT_EQ(rig.integrator.invalid(), 0u);
    return rig.integrator.resolve();
}

}  // namespace vkcppm::test
