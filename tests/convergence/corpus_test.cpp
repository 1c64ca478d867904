// The sample models that stand beside the project, under an even sky: each renders without a word of the validation
// layer, and to a picture of finite light. Of the asset generator's files, which vary one thing at a time, one stands for
// all that ask the same features of the kernels.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/features.h"
#include "support/rig.h"
#include "support/scenes.h"

namespace vkcppm::test {
namespace {

namespace fs = std::filesystem;

class Corpus : public GpuTest {
protected:
    /// The scene of a file under the sky; none where the loader refuses it, which tests/unit/gltf_corpus_test.cpp is about.
    static std::optional<Scene> load(const fs::path& file) {
        try {
            Scene scene = load_gltf(file);
            scene.environment = Environment{{4, 2}, std::vector<glm::vec3>(8, glm::vec3(0.5f, 0.6f, 0.7f))};
            return scene;
        } catch (const Error&) {
            return std::nullopt;
        }
    }

    static void render(const Scene& scene) {
        Settings settings;
        settings.size = Extent{16, 16};
        settings.photons = 256;
        Rig rig(scene, settings);
        rig.integrator.run(2);
        double largest = 0.0;
        for (const glm::vec3& pixel : rig.integrator.resolve().rgb) {
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0.0f) << pixel[c];
                largest = std::max(largest, double(pixel[c]));
            }
        }
        EXPECT_GT(largest, 0.0);
        EXPECT_EQ(rig.integrator.invalid(), 0u);
    }

    /// Renders what is below `folder`; with `sample` one of every set of features. Returns how many.
    static std::size_t render_all(const fs::path& folder, bool sample) {
        std::set<fs::path> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            const std::string extension = entry.path().extension();
            if (extension == ".gltf" || extension == ".glb") files.insert(entry.path());
        }
        std::set<std::uint32_t> seen;
        std::set<fs::path> models;  // of a model in several formats one is enough
        std::size_t count = 0;
        for (const fs::path& file : files) {
            SCOPED_TRACE(file.string());
            const fs::path model = sample ? file : *fs::relative(file, folder).begin();
            if (models.contains(model)) continue;
            const std::optional<Scene> scene = load(file);
            if (!scene || (sample && !seen.insert(bits_of(flatten(*scene).features)).second)) continue;
            models.insert(model);
            render(*scene);
            ++count;
        }
        return count;
    }
};

TEST_F(Corpus, SampleModelsRender) {
    const auto folder = shared_file("khronos");
    if (!folder) GTEST_SKIP() << "the sample models are not there";
    EXPECT_GT(render_all(*folder, false), 30u);
}

TEST_F(Corpus, GeneratedAssetsRender) {
    const auto folder = shared_file("asset-generator");
    if (!folder) GTEST_SKIP() << "the generated assets are not there";
    EXPECT_GT(render_all(*folder, true), 5u);
}

}  // namespace
}  // namespace vkcppm::test
