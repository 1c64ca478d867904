// The path tracer of the kernels, and references, against the reference path tracer, in double precision and with other
// ways of sampling: one room a feature. Paths are unbiased, so that nothing but noise may stand between the two.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/flatten.h"
#include "render/moments.h"
#include "render/path_tracer.h"
#include "render/reference.h"
#include "render/render.h"
#include "render/surface.h"
#include "support/blocks.h"
#include "support/gpu.h"
#include "support/rooms.h"
#include "support/scenes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t samples = 256;

reference::PathTracing trace_on_device(const Scene& scene, const Settings& wanted) {
    const Settings settings = resolve_settings(wanted, scene);
    const FlatScene flat = flatten(scene);
    PathTracer tracer(plain_device(), flat, scene.cameras.at(0), settings, PathTracer::Light::all);
    Moments moments(*settings.size);
    for (std::uint32_t i = 0; i < samples / PathTracer::batch; ++i) moments.add(tracer.trace());
    EXPECT_EQ(tracer.invalid(), 0u);
    reference::PathTracing result;
    result.mean.extent = result.standard_error.extent = *settings.size;
    for (std::size_t i = 0; i < settings.size->pixels(); ++i) {
        result.mean.rgb.emplace_back(moments.mean()[i]);
        result.standard_error.rgb.emplace_back(glm::sqrt(moments.squared_error(i)));
    }
    return result;
}

reference::PathTracing trace_in_double(const Scene& scene, const Settings& settings) {
    reference::PathTracerSettings reference;
    reference.size = *settings.size;
    reference.samples = samples;
    reference.max_depth = settings.max_depth;
    reference.aperture = settings.aperture;
    reference.focus_distance = settings.focus_distance.value_or(1.0);
    return reference::path_trace(scene, reference);
}

class PathTracerRooms : public testing::TestWithParam<Case> {};

TEST_P(PathTracerRooms, AgreeWithDoublePrecision) {
    Scene scene = make_room();
    Settings settings;
    GetParam().change(scene, settings);
    settings.size = Extent{16, 16};
    const reference::PathTracing paths = trace_in_double(scene, settings);
    const BlockSettings exact{.side = 8, .level = 1e-4, .bias = 1e-6};
    const BlockComparison blocks = compare_blocks(trace_on_device(scene, settings), paths, exact);
    EXPECT_EQ(blocks.differing, 0u) << "device over double, a block and channel:\n" << blocks.table;

    // Textures may be smooth somewhere, but hardly are.
    const auto smooth = [](const SurfaceTraits& t) { return t.smooth && !t.textured; };
    if (!std::ranges::any_of(traits_of(scene), smooth)) return;
    ReferenceSettings split;
    split.render = settings;
    split.render.iterations = 64;
    split.render.photons = 4096;
    split.samples = samples;
    const Reference reference =
        make_reference(scene, split, plain_device(), [](const ReferenceProgress&) { return true; });
    const BlockComparison sum =
        compare_blocks({reference.mean, reference.standard_error}, paths, {.side = 8, .level = 1e-4, .bias = 0.004});
    EXPECT_EQ(sum.differing, 0u) << "reference over paths, a block and channel:\n" << sum.table;
    EXPECT_GT(reference.caustic_share, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Features, PathTracerRooms, testing::ValuesIn(material_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

class PathTracerClosedForm : public testing::TestWithParam<const char*> {};

/// The scenes with a closed form whose light paths find: regions as ClosedForm of closed_form_test.cpp takes them.
TEST_P(PathTracerClosedForm, MeanRadianceOfEveryRegion) {
    const std::filesystem::path folder = std::filesystem::path(VKCPPM_SOURCE_DIR) / "scenes";
    std::ifstream file(folder / (std::string(GetParam()) + ".expect.json"));
    const nlohmann::json expected = nlohmann::json::parse(file);
    Settings settings;
    settings.size = Extent{expected["size"][0], expected["size"][1]};
    const reference::PathTracing paths = trace_on_device(project_scene(GetParam()), settings);
    for (const auto& region : expected["regions"]) {
        glm::dvec3 sum(0.0), variance(0.0);
        double count = 0.0;
        for (std::uint32_t y = region["y"][0]; y < region["y"][1]; ++y) {
            for (std::uint32_t x = region["x"][0]; x < region["x"][1]; ++x, ++count) {
                const glm::dvec3 error(paths.standard_error.at(x, y));
                sum += glm::dvec3(paths.mean.at(x, y));
                variance += error * error;
            }
        }
        for (int channel = 0; channel < 3; ++channel) {
            const double want = region["rgb"][channel], got = sum[channel] / count;
            const double error = std::sqrt(variance[channel]) / count;
            // 5 standard errors, and the rounding of float arithmetic.
            EXPECT_NEAR(got, want, 5.0 * error + 2e-5 * want)
                << region["name"] << " channel " << channel << ": ratio " << got / want << ", standard error "
                << error / want << "; " << expected["formula"];
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathTracerClosedForm,
                         testing::Values("coloured_slab", "directional_plane", "furnace", "mirror", "point_plane",
                                         "rough_metal", "slab", "spot_plane", "square_light"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace vkcppm::test
