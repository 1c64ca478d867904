// Sample models through the whole pipeline under the validation layer: those that are made here, one a feature, and the
// collections that may stand beside the project.

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "flat/features.h"
#include "scene/gltf/gltf.h"
#include "support/device/rig.h"
#include "support/names.h"
#include "support/scenes/loading.h"
#include "support/scenes/sample_models.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

/// Light from everywhere, more of it from above: no surface that reflects is black.
Environment sky() {
    Environment sky{{4, 2}, {}};
    sky.radiance.assign(4, {2.0f, 2.2f, 2.5f});
    sky.radiance.resize(8, {0.5f, 0.4f, 0.3f});
    return sky;
}

/// Marks the pixels whose eye paths of the last iteration ended where they gather photons.
void keep_gathering(Rig& rig, std::vector<bool>& gathers) {
    const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
    for (std::size_t i = 0; i < gathers.size(); ++i) {
        gathers[i] = gathers[i] && (hits[i].state & HIT_MASK) == HIT_DIFFUSE;
    }
}

struct Rendered {
    std::size_t gathering = 0;  // pixels that gather photons
    std::size_t lit = 0;        // of those, that are not black
};

Rendered expect_sound_picture(const Scene& scene, const char* direct) {
    SCOPED_TRACE(fmt::format("direct light {}", direct));
    Settings settings;
    settings.size = Extent{16, 16};
    settings.photons = 256;
    settings.direct = direct;
    const std::size_t messages = device().validation_messages().size();
    Rig rig(scene, settings);
    std::vector<bool> gathers(rig.pixels(), true);
    for (int iteration = 0; iteration < 2; ++iteration) {
        rig.integrator.run(1);
        keep_gathering(rig, gathers);
    }
    EXPECT_EQ(rig.integrator.invalid(), 0u);
    EXPECT_EQ(device().validation_messages().size(), messages) << "messages of the validation layer are below";
    const Image image = rig.integrator.resolve();
    Rendered rendered;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const glm::vec3& rgb = image.rgb[i];
        for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(rgb[c]) && rgb[c] >= 0.0f) << "pixel " << i << ": " << rgb[c];
        }
        rendered.gathering += gathers[i] ? 1 : 0;
        rendered.lit += gathers[i] && rgb != glm::vec3(0.0f) ? 1 : 0;
    }
    return rendered;
}

/// Sets of features that have been rendered with all light from photons: kernels are compiled for each, and those take
/// most of the time.
std::set<std::uint32_t>& gathered_features() {
    static std::set<std::uint32_t> features;
    return features;
}

/// Renders it, and the first of its set of features both ways. Returns whether a pixel gathers photons.
bool expect_sound_pictures(const Scene& scene) {
    const Rendered sampled = expect_sound_picture(scene, direct_sampled);
    if (!gathered_features().insert(bits_of(flatten(scene).features)).second) return sampled.gathering > 0;
    // Few photons come to what the only light does not see, and a ray to it none: lit is what photons light.
    const Rendered rendered = expect_sound_picture(scene, direct_gathered);
    EXPECT_GE(4 * rendered.lit, 3 * rendered.gathering)
        << "only " << rendered.lit << " of " << rendered.gathering << " pixels that gather are not black";
    return rendered.gathering > 0;
}

/// Every `count`-th file of a folder from the `index`-th on: a test of minutes is cut in parts that run side by side.
struct Part {
    const char* folder;
    std::size_t index;
    std::size_t count;
    bool one_a_feature_set;  // kernels are compiled for every set of features: of many small models, one a set
    // Of its models, at least and at most.
    std::size_t rendered;
    std::size_t gathering;
    std::size_t refused;
};

class Corpus : public GpuTest, public testing::WithParamInterface<Part> {};

TEST_P(Corpus, EveryModelRenders) {
    const Part& part = GetParam();
    const auto folder = shared_file(part.folder);
    if (!folder) GTEST_SKIP() << no_collections;
    const std::vector<std::filesystem::path> files = gltf_files_in(*folder);
    std::size_t rendered = 0, gathering = 0, refused = 0;
    std::set<std::uint32_t> seen;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (i % part.count != part.index) continue;
        SCOPED_TRACE(files[i]);
        Scene scene;
        try {
            scene = load_gltf(files[i]);
        } catch (const Error&) {
            ++refused;  // the unit tests have their lines
            continue;
        }
        scene.environment = sky();
        if (part.one_a_feature_set && !seen.insert(bits_of(flatten(scene).features)).second) continue;
        gathering += expect_sound_pictures(scene) ? 1 : 0;
        ++rendered;
    }
    EXPECT_GE(rendered, part.rendered);
    EXPECT_GE(gathering, part.gathering) << "models with pixels that gather photons, of " << rendered;
    EXPECT_LE(refused, part.refused);
}

class Samples : public GpuTest {};

TEST_F(Samples, EveryModelRenders) {
    std::set<std::uint32_t> seen;
    std::size_t gathering = 0;
    for (const SampleModel& model : sample_models()) {
        SCOPED_TRACE(model.name);
        Scene scene = load(model.file);
        scene.environment = sky();
        if (!seen.insert(bits_of(flatten(scene).features)).second) continue;
        gathering += expect_sound_pictures(scene) ? 1 : 0;
    }
    EXPECT_GE(seen.size(), 12u) << "sets of features";
    EXPECT_GE(gathering, 8u) << "models with pixels that gather photons, of " << seen.size();
}

INSTANTIATE_TEST_SUITE_P(
    Models, Corpus,
    testing::Values(Part{"khronos", 0, 4, false, 14, 14, 0}, Part{"khronos", 1, 4, false, 13, 13, 1},
                    Part{"khronos", 2, 4, false, 13, 11, 1}, Part{"khronos", 3, 4, false, 12, 12, 2},
                    Part{"asset-generator", 0, 1, true, 15, 12, 2}),
    [](const testing::TestParamInfo<Part>& info) {
        return identifier(fmt::format("{} {} of {}", info.param.folder, info.param.index + 1, info.param.count));
    });

}  // namespace
}  // namespace vkcppm::test
