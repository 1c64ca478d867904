// The path tracer of the kernels, and references, against the oracle's path tracer, in double precision and with other
// ways of sampling: one room a feature. Paths are unbiased, so that nothing but noise may stand between the two.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/metrics.h"
#include "flat/flatten.h"
#include "flat/material.h"
#include "render/path_tracer.h"
#include "render/render.h"
#include "study/batch_mean.h"
#include "study/reference.h"
#include "support/device/gpu.h"
#include "support/files/evidence.h"
#include "support/files/places.h"
#include "support/scenes/expectation.h"
#include "support/scenes/lamps.h"
#include "support/scenes/rooms.h"
#include "support/scenes/scenes.h"
#include "support/scenes/shapes.h"
#include "support/statistics/blocks.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t samples = 256;

oracle::PathTracing trace_on_device(const Scene& scene, const Settings& wanted) {
    const Settings settings = resolve_settings(wanted, scene);
    const FlatScene flat = flatten(scene);
    const SceneOnDevice on_device(plain_device(), flat);
    PathTracer tracer(on_device, scene.cameras.at(0), settings, PathTracer::Light::all);
    BatchMean batches(*settings.size);
    for (std::uint32_t i = 0; i < samples / PathTracer::batch; ++i) batches.add(tracer.trace());
    EXPECT_EQ(tracer.invalid(), 0u);
    oracle::PathTracing result;
    result.mean.extent = result.standard_error.extent = *settings.size;
    for (std::size_t i = 0; i < settings.size->pixels(); ++i) {
        result.mean.rgb.emplace_back(batches.mean()[i]);
        result.standard_error.rgb.emplace_back(glm::sqrt(batches.squared_error(i)));
    }
    return result;
}

oracle::PathTracing trace_in_double(const Scene& scene, const Settings& settings, std::uint32_t samples) {
    return oracle::path_trace(scene, oracle_settings(settings, samples));
}

Reference refer(const Scene& scene, const Settings& settings, std::uint32_t iterations, std::uint32_t photons) {
    ReferenceSettings wanted;
    wanted.render = settings;
    wanted.render.iterations = iterations;
    wanted.render.photons = photons;
    wanted.samples = 128;
    return make_reference(scene, resolve_reference(wanted, scene), plain_device(),
                          [](const ReferenceProgress&) { return true; });
}

TEST(PathTracerLamps, OfManyAgreeWithDoublePrecision) {
    for (const Scene& scene : {many_lamp_room(40), lamps_over_metal(0.5f)}) {
        Settings settings;
        settings.size = Extent{16, 16};
        expect_blocks_agree(trace_on_device(scene, settings), trace_in_double(scene, settings, 4 * samples),
                            {.side = 8, .level = 1e-4, .bias = 1e-6}, "device over double");
    }
}

class PathTracerRooms : public testing::TestWithParam<Case> {};

TEST_P(PathTracerRooms, AgreeWithDoublePrecision) {
    Scene scene = make_room();
    Settings settings;
    GetParam().change(scene, settings);
    settings.size = Extent{16, 16};
    const oracle::PathTracing paths = trace_in_double(scene, settings, samples);
    const BlockSettings exact{.side = 8, .level = 1e-4, .bias = 1e-6};
    expect_blocks_agree(trace_on_device(scene, settings), paths, exact, "device over double");

    // Textures may be smooth somewhere, but hardly are.
    const auto smooth = [](const MaterialTraits& t) { return t.smooth() && !t.textured; };
    if (!std::ranges::any_of(traits_of(scene), smooth)) return;
    const Reference reference = refer(scene, settings, 64, 4096);
    expect_blocks_agree({reference.mean, reference.standard_error}, paths, {.side = 8, .level = 1e-4, .bias = 0.004},
                        "reference over paths");
    EXPECT_GT(reference.caustic_share, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Features, PathTracerRooms, testing::ValuesIn(material_cases()),
                         [](const auto& info) { return std::string(info.param.name); });

/// Regions of <name>.expect.json, as closed_form_test.cpp takes them: 5 standard errors are allowed, and `bias`,
/// relative.
void expect_regions(const std::string& name, const std::function<oracle::PathTracing(const Settings&)>& render,
                    double bias) {
    const nlohmann::json expected = expectation_of(name);
    Settings settings;
    settings.size = Extent{expected["size"][0], expected["size"][1]};
    const oracle::PathTracing picture = render(settings);
    Image wanted = picture.mean;
    for (const auto& region : expected["regions"]) {
        glm::dvec3 sum(0.0), variance(0.0);
        double count = 0.0;
        for_each_pixel(region, [&](std::uint32_t x, std::uint32_t y) {
            const glm::dvec3 error(picture.standard_error.at(x, y));
            sum += glm::dvec3(picture.mean.at(x, y));
            ++count;
            wanted.rgb[std::size_t(y) * wanted.extent.width + x] = {region["rgb"][0], region["rgb"][1],
                                                                    region["rgb"][2]};
            variance += error * error;
        });
        for (int channel = 0; channel < 3; ++channel) {
            const double want = region["rgb"][channel], got = sum[channel] / count;
            const double error = std::sqrt(variance[channel]) / count;
            EXPECT_NEAR(got, want, 5.0 * error + bias * want)
                << region["name"] << " channel " << channel << ": ratio " << got / want << ", standard error "
                << error / want << "; " << expected["formula"];
        }
    }
    if (testing::Test::HasFailure()) leave_pictures(picture.mean, wanted);
}

class PathTracerClosedForm : public testing::TestWithParam<const char*> {};

/// The scenes with a closed form whose light paths find; the bias is the rounding of float arithmetic.
TEST_P(PathTracerClosedForm, MeanRadianceOfEveryRegion) {
    const Scene scene = project_scene(GetParam());
    expect_regions(
        GetParam(), [&](const Settings& settings) { return trace_on_device(scene, settings); }, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PathTracerClosedForm,
                         testing::Values("coloured_slab", "directional_plane", "furnace", "mirror", "point_plane",
                                         "rough_metal", "slab", "spot_plane", "square_light"),
                         [](const auto& info) { return std::string(info.param); });

class ReferenceClosedForm : public testing::TestWithParam<const char*> {};

/// Those whose light paths do not find; the bias is that of discs of a few pixels.
TEST_P(ReferenceClosedForm, MeanRadianceOfEveryRegion) {
    const Scene scene = project_scene(GetParam());
    const auto render = [&](const Settings& settings) {
        const Reference reference = refer(scene, settings, 64, 16384);
        EXPECT_GT(reference.caustic_share, 0.1);
        return oracle::PathTracing{reference.mean, reference.standard_error};
    };
    expect_regions(GetParam(), render, 0.001);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceClosedForm, testing::Values("coloured_slab_floor", "focus", "slab_floor"),
                         [](const auto& info) { return std::string(info.param); });

/// The room with a ball of glass.
Scene glass_room(Settings& settings) {
    Scene scene = make_room();
    const auto& cases = material_cases();
    std::ranges::find_if(cases, [](const Case& c) { return std::string(c.name) == "glass"; })->change(scene, settings);
    settings.size = Extent{16, 12};
    return scene;
}

TEST(Reference, LeavesWhatIsNearItsLampToPhotons) {
    Settings settings;
    settings.size = Extent{16, 16};
    Scene scene = make_room();
    // A frame of 60 mm round the lamp, and a ball of rough metal that sees it.
    const auto frame = std::uint32_t(scene.materials.size());
    add_material(scene, lambert(glm::vec3(0.9f, 0.8f, 0.7f)));
    for (const double x : {0.39, 1.61}) add_quad(scene, {x, 1.93, 0.4}, {0, 0.06, 0}, {0, 0, 1.2}, frame);
    for (const double z : {0.39, 1.61}) add_quad(scene, {0.4, 1.93, z}, {0, 0.06, 0}, {1.2, 0, 0}, frame);
    scene.materials[2].metallic = 1.0f;
    scene.materials[2].roughness = 0.4f;
    const Reference reference = refer(scene, settings, 64, 16384);
    EXPECT_GT(reference.caustic_share, 0.01);
    expect_blocks_agree({reference.mean, reference.standard_error}, trace_in_double(scene, settings, 1024),
                        {.side = 8, .level = 1e-4, .bias = 0.002}, "reference over paths");
}

TEST(Reference, ErrorIsTheSpreadOfSeeds) {
    Settings settings;
    const Scene scene = glass_room(settings);
    constexpr std::uint32_t seeds = 10;
    BatchMean batches(*settings.size);
    std::vector<double> stated(settings.size->pixels(), 0.0);  // squared standard error, mean over seeds and channels
    double relmse = 0.0, mse = 0.0, srgb_mse = 0.0;
    std::vector<Image> pictures;
    for (settings.seed = 1; settings.seed <= seeds; ++settings.seed) {
        const Reference reference = refer(scene, settings, 32, 4096);
        pictures.push_back(reference.mean);
        mse += reference.mse / seeds;
        srgb_mse += reference.srgb_mse / seeds;
        batches.add(reference.mean);
        for (std::size_t i = 0; i < stated.size(); ++i) {
            const glm::dvec3 error(reference.standard_error.rgb[i]);
            stated[i] += glm::dot(error, error) / (3.0 * seeds);
        }
        relmse += reference.relmse / seeds;
    }
    double spread_sum = 0.0, stated_sum = 0.0, relative_spread = 0.0;
    for (std::size_t i = 0; i < stated.size(); ++i) {
        const glm::dvec3 spread = batches.squared_error(i) * double(seeds);  // variance of one picture
        const double weight = 1.0 / (glm::dot(batches.mean()[i], batches.mean()[i]) / 3.0 + 0.01);
        spread_sum += (spread.x + spread.y + spread.z) / 3.0 * weight;
        stated_sum += stated[i] * weight;
        relative_spread += glm::dot(spread, 1.0 / (batches.mean()[i] * batches.mean()[i] + 0.01)) / 3.0;
    }
    // 192 pixels with 9 degrees of freedom each; what is stated may be too much, as pixels are sampled evenly.
    const double ratio = spread_sum / stated_sum;
    EXPECT_GT(ratio, 0.7);
    EXPECT_LT(ratio, 1.2);
    EXPECT_NEAR(relative_spread / double(stated.size()) / relmse, 0.95, 0.25);
    // Two pictures differ by the errors of both; encodings also by their rounding, a twelfth each.
    double pairs = 0.0, pair_mse = 0.0, pair_srgb_mse = 0.0;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j, ++pairs) {
            const Comparison difference = compare(pictures[i], pictures[j]);
            pair_mse += difference.mse.all;
            pair_srgb_mse += difference.srgb_mse.all;
        }
    }
    EXPECT_NEAR(pair_mse / pairs / (2.0 * mse), 0.95, 0.25);
    EXPECT_NEAR(pair_srgb_mse / pairs / (2.0 * srgb_mse + 1.0 / 6.0), 0.95, 0.25);
}

TEST(Reference, SameSettingsSameBits) {
    Settings settings;
    const Scene scene = glass_room(settings);
    const Reference one = refer(scene, settings, 32, 4096), other = refer(scene, settings, 32, 4096);
    expect_same_picture(other.mean, one.mean, "mean");
    expect_same_picture(other.standard_error, one.standard_error, "standard error");
    EXPECT_EQ(one.samples, 128u);
    EXPECT_EQ(one.iterations, 32u);
}

TEST(Reference, TrustsPixelsWhoseNeighbourhoodHasASmallError) {
    Settings settings;
    const Scene scene = glass_room(settings);
    const Reference reference = refer(scene, settings, 32, 4096);
    const Extent size = *settings.size;
    const auto relative = [&](int x, int y) {  // squared
        const glm::dvec3 r(reference.mean.at(x, y)), error(reference.standard_error.at(x, y));
        return glm::dot(error * error, 1.0 / (r * r + 0.01)) / 3.0;
    };
    std::size_t untrusted = 0;
    double relmse = 0.0;
    for (int y = 0; y < int(size.height); ++y) {
        for (int x = 0; x < int(size.width); ++x) {
            double sum = 0.0, count = 0.0;
            for (int v = y - 1; v <= y + 1; ++v) {
                for (int u = x - 1; u <= x + 1; ++u) {
                    if (u < 0 || v < 0 || u >= int(size.width) || v >= int(size.height)) continue;
                    sum += relative(u, v);
                    ++count;
                }
            }
            const bool trusted = std::sqrt(sum / count) <= 0.05;
            EXPECT_EQ(reference.trusted[std::size_t(y) * size.width + x], trusted ? 1.0f : 0.0f) << x << ", " << y;
            untrusted += trusted ? 0 : 1;
            relmse += relative(x, y) / double(size.pixels());
        }
    }
    EXPECT_EQ(reference.untrusted, untrusted);
    EXPECT_GT(untrusted, 0u);
    EXPECT_LT(untrusted, size.pixels());
    EXPECT_NEAR(reference.relmse, relmse, 1e-5 * relmse);
    EXPECT_NEAR(reference.relmse_paths + reference.relmse_caustics, relmse, 1e-5 * relmse);
}

}  // namespace
}  // namespace vkcppm::test
