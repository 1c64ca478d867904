// Sample models that stand beside the project, through the whole pipeline under the validation layer.

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "render/features.h"
#include "scene/gltf.h"
#include "support/rig.h"
#include "support/scenes.h"

namespace vkcppm::test {
namespace {

class Corpus : public GpuTest {};

/// Light from everywhere, more of it from above: no surface that reflects is black.
Environment sky() {
    Environment sky{{4, 2}, {}};
    sky.radiance.assign(4, {2.0f, 2.2f, 2.5f});
    sky.radiance.resize(8, {0.5f, 0.4f, 0.3f});
    return sky;
}

/// Marks the pixels whose eye paths of the last iteration ended where they gather photons.
void keep_gathering(Rig& rig, std::vector<bool>& gathers) {
    const auto hits = rig.all<gpu::HitPosition>(BIND_HIT_POSITION);
    for (std::size_t i = 0; i < gathers.size(); ++i) {
        gathers[i] = gathers[i] && (hits[i].state & HIT_MASK) == HIT_DIFFUSE;
    }
}

/// Returns the number of pixels that gather photons.
std::size_t expect_sound_picture(const Scene& scene) {
    Settings settings;
    settings.size = Extent{16, 16};
    settings.photons = 256;
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
    std::size_t gathering = 0, lit = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const glm::vec3& rgb = image.rgb[i];
        for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(rgb[c]) && rgb[c] >= 0.0f) << "pixel " << i << ": " << rgb[c];
        }
        gathering += gathers[i] ? 1 : 0;
        lit += gathers[i] && rgb != glm::vec3(0.0f) ? 1 : 0;
    }
    EXPECT_GE(4 * lit, 3 * gathering) << "only " << lit << " of " << gathering << " pixels that gather are not black";
    return gathering;
}

// Kernels are compiled for every set of features: of the asset generator, one model a set is rendered.
TEST_F(Corpus, EveryModelRenders) {
    if (!shared_file("khronos") || !shared_file("asset-generator")) GTEST_SKIP() << "the models are not there";
    std::size_t rendered = 0, gathering = 0, refused = 0;
    std::set<std::uint32_t> seen;
    for (const char* folder : {"khronos", "asset-generator"}) {
        for (const std::filesystem::path& file : gltf_files_in(*shared_file(folder))) {
            SCOPED_TRACE(file);
            Scene scene;
            try {
                scene = load_gltf(file);
            } catch (const Error&) {
                ++refused;  // the unit tests have their lines
                continue;
            }
            scene.environment = sky();
            const bool is_new = seen.insert(bits_of(flatten(scene).features)).second;
            if (!is_new && std::string(folder) == "asset-generator") continue;
            gathering += expect_sound_picture(scene) > 0 ? 1 : 0;
            ++rendered;
        }
    }
    EXPECT_GE(rendered, 50u);
    EXPECT_GE(gathering, 50u) << "models with pixels that gather photons, of " << rendered;
    EXPECT_LE(refused, 6u);
}

}  // namespace
}  // namespace vkcppm::test
