// Dispersion: wavelengths, their colours and indices, against oracle/dispersion in double.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "flat/material.h"
#include "flat/textures.h"
#include "kernels/probe.h"
#include "oracle/dispersion.h"
#include "support/device/gpu.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t wavelength_words[] = {
#include "wavelength.spv.inc"
};

class Wavelength : public GpuTest {
protected:
    std::vector<gpu::WavelengthOutput> run(const std::vector<gpu::WavelengthInput>& inputs, std::uint32_t stream = 0,
                                           std::uint32_t iteration = 3, std::uint32_t paths = 1) {
        gpu::Params params{};
        params.seed = 5;
        params.width = params.height = side;
        probe_.input(Binding::params, std::vector{params});
        probe_.input(PROBE_INPUT, inputs);
        probe_.output<gpu::WavelengthOutput>(PROBE_OUTPUT, inputs.size());
        gpu::Launch push{
            .iteration = iteration, .last_round = 0, .argument = stream, .items = std::uint32_t(inputs.size())};
        push.paths = paths;
        probe_.run(inputs.size(), push);
        return probe_.result<gpu::WavelengthOutput>(PROBE_OUTPUT, inputs.size());
    }

    static constexpr std::uint32_t side = 400;  // of the picture, pixels
    Probe probe_{"wavelength", wavelength_words};
};

TEST_F(Wavelength, WeightsAverageToWhite) {
    constexpr std::size_t steps = 30000;  // midpoints of the spectrum: the corners of the triangles lie between them
    std::vector<gpu::WavelengthInput> inputs;
    for (std::size_t i = 0; i < steps; ++i) {
        inputs.push_back({float(0.4 + 0.3 * (double(i) + 0.5) / double(steps)), 1.5f, 0.0f});
    }
    const auto outputs = run(inputs);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < steps; ++i) {
        const glm::dvec3 want = oracle::wavelength_color(1000.0 * double(inputs[i].wavelength));
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(outputs[i].weight[c], want[c], 1e-5) << inputs[i].wavelength << " um, channel " << c;
        }
        sum += glm::dvec3(outputs[i].weight);
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / double(steps), 1.0, 1e-5) << "channel " << c;
}

TEST_F(Wavelength, AreUniformAndTheirOwnForEveryPath) {
    constexpr std::size_t paths = 100000;
    for (const std::uint32_t stream : {0u, 1u}) {
        std::vector<std::uint64_t> bins(60);
        for (const auto& out : run(std::vector<gpu::WavelengthInput>(paths, {0.5f, 1.5f, 0.0f}), stream)) {
            ASSERT_GE(out.drawn, 0.4f);
            ASSERT_LE(out.drawn, 0.7f);
            ++bins[std::min<std::size_t>(59, std::size_t(60.0 * (double(out.drawn) - 0.4) / 0.3))];
        }
        expect_density("wavelengths", chi_squared_uniform(bins), sidak(1e-3, 2));
    }
}

// 64 that a pixel draws, over iterations or as paths of the path tracer: of random numbers three of four pixels would
// have a bin of one or none.
TEST_F(Wavelength, OfAPixelCoverTheSpectrumEvenly) {
    constexpr std::size_t pixels = std::size_t(side) * side, looked_at = 100;
    std::vector<std::array<std::uint64_t, 16>> eye(looked_at), traced(looked_at);
    const auto count = [](auto& bins, float drawn) {
        ++bins[std::min<std::size_t>(15, std::size_t(16.0 * (double(drawn) - 0.4) / 0.3))];
    };
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto outputs = run(std::vector<gpu::WavelengthInput>(looked_at, {0.5f, 1.5f, 0.0f}), 0, i);
        for (std::size_t pixel = 0; pixel < looked_at; ++pixel) count(eye[pixel], outputs[pixel].drawn);
    }
    const std::vector<gpu::WavelengthInput> two_each(pixels + looked_at, {0.5f, 1.5f, 0.0f});
    for (std::uint32_t batch = 0; batch < 32; ++batch) {
        const auto outputs = run(two_each, 3, batch, 2);
        for (std::size_t pixel = 0; pixel < looked_at; ++pixel) {
            for (const std::size_t path : {pixel, pixels + pixel}) count(traced[pixel], outputs[path].drawn);
        }
    }
    for (const auto* all : {&eye, &traced}) {
        for (const auto& bins : *all) {
            EXPECT_GE(*std::ranges::min_element(bins), 2u);
            EXPECT_LE(*std::ranges::max_element(bins), 6u);
        }
    }
}

TEST_F(Wavelength, IndicesHaveTheIndexAndTheAbbeNumberOfTheFile) {
    struct Glass {
        float ior, dispersion;
    };
    for (const Glass& glass : {Glass{1.5f, 0.33f}, Glass{2.4f, 0.36f}, Glass{1.33f, 1.5f}, Glass{1.7f, 5.0f}}) {
        Material material;
        material.metallic = 0.0f;
        material.transmission = 1.0f;
        material.thickness = 1.0f;
        material.ior = glass.ior;
        material.dispersion = glass.dispersion;
        const Scene scene;
        TextureTable textures(scene);
        const gpu::SurfaceMaterial surface = gpu_material(material, traits_of(material, 1.0f), 0.125, textures);
        std::vector<gpu::WavelengthInput> inputs;
        for (const float l : {0.5876f, 0.4861f, 0.6563f}) inputs.push_back({l, surface.ior, surface.cauchy});
        for (int i = 0; i <= 30; ++i) inputs.push_back({0.4f + 0.01f * float(i), surface.ior, surface.cauchy});
        const auto outputs = run(inputs);
        const double d = outputs[0].index, f = outputs[1].index, c = outputs[2].index;
        EXPECT_NEAR(d, glass.ior, 2e-7) << "at the d line";
        // Each index is rounded to 2.4e-7.
        const double abbe = (d - 1.0) / (f - c), want = 20.0 / double(glass.dispersion);
        EXPECT_NEAR(abbe, want, want * (5e-7 / (f - c) + 1e-5));
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            EXPECT_NEAR(outputs[i].index,
                        oracle::ior_at(glass.ior, glass.dispersion, 1000.0 * double(inputs[i].wavelength)), 1e-6)
                << inputs[i].wavelength << " um, index " << glass.ior << ", dispersion " << glass.dispersion;
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
