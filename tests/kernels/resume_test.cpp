// A picture does not depend on how its work is cut: small step budgets, small photon buffers, one iteration at a time.

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "render/estimators.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/files/evidence.h"
#include "support/names.h"
#include "support/pass_report.h"
#include "support/scenes/instanced.h"
#include "support/scenes/rooms.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

Settings settings_of(const std::string& estimator, std::uint32_t seed = 1) {
    Settings settings;
    settings.estimator = estimator;
    settings.size = Extent{48, 32};
    settings.photons = 1500;
    settings.seed = seed;
    return settings;
}

constexpr std::uint32_t iterations = 5;

/// Pixels whose bits differ.
std::size_t differences(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        count += std::memcmp(&a.rgb[i], &b.rgb[i], sizeof(a.rgb[i])) != 0 ? 1 : 0;
    return count;
}

std::uint64_t calls(const Rig& rig, Pass pass) { return report_of(rig.report().passes, pass).calls; }

class Resume : public GpuTest, public testing::WithParamInterface<std::string> {};

TEST_P(Resume, SmallStepBudgetsGiveTheSameBits) {
    Rig whole(room(), settings_of(GetParam())), cut(room(), settings_of(GetParam()));
    cut.set_step_budget(150);
    whole.integrator.run(iterations);
    cut.integrator.run(iterations);
    // A pass of the whole render may run again because the photon buffer grew, but in one round each time.
    for (const KernelRow& kernel : kernel_rows()) {
        if (kernel.unfinished == 0 || kernel.pass == Pass::trace) continue;
        EXPECT_GE(calls(cut, kernel.pass), calls(whole, kernel.pass) + iterations)
            << kernel.name << " was not cut into rounds";
    }
    expect_same_picture(cut.integrator.resolve(), whole.integrator.resolve());
    const auto a = whole.all<gpu::PixelState>(Binding::pixels), b = cut.all<gpu::PixelState>(Binding::pixels);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(std::memcmp(&a[i], &b[i], sizeof(a[i])), 0)
            << "pixel " << i << ": radius^2 " << a[i].radius2 << " and " << b[i].radius2 << ", total " << a[i].total
            << " and " << b[i].total << ", rejections " << a[i].rejections << " and " << b[i].rejections;
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, Resume, testing::ValuesIn(all_estimators()),
                         [](const auto& info) { return identifier(info.param); });

class Determinism : public GpuTest {};

TEST_F(Determinism, SmallPhotonBuffersGiveTheSameBits) {
    Settings settings = settings_of("cppm");
    settings.direct = direct_gathered;  // more photons
    Rig whole(room(), settings);
    whole.integrator.run(iterations);
    const Image expected = whole.integrator.resolve();
    for (const auto& [capacity, budget] : {std::pair(3u, 0u), std::pair(20u, 0u), std::pair(5u, 150u)}) {
        Rig cut(room(), settings);
        gpu::Params params = cut.integrator.params();
        params.photon_capacity = capacity;
        if (budget > 0) params.step_budget = budget;
        cut.integrator.set_params(params);
        cut.integrator.run(iterations);
        EXPECT_GT(cut.integrator.params().photon_capacity, capacity) << "the buffer was never too small";
        expect_same_picture(cut.integrator.resolve(), expected,
                            fmt::format("capacity {}, step budget {}", capacity, budget));
        const Report a = whole.report(), b = cut.report();
        EXPECT_EQ(a.stored_photons, b.stored_photons);
    }
}

// What a glossy hit is remembered by includes the instance.
TEST_F(Determinism, SmallStepBudgetsGiveTheSameBitsInInstances) {
    Scene scene = make_room();
    constexpr std::uint32_t ball = 2, pane = 3;
    scene.materials[ball].metallic = 1.0f;
    scene.materials[ball].roughness = 0.3f;
    const glm::dmat4 small = glm::scale(glm::dmat4(1.0), glm::dvec3(-0.01, 0.02, 0.03));
    scene = shared(shared(scene, ball, small), pane, glm::scale(glm::dmat4(1.0), glm::dvec3(3.0)));
    const Settings settings = settings_of("cppm");
    Rig whole(scene, settings);
    ASSERT_EQ(whole.flat.instances.size(), 2u);
    whole.integrator.run(iterations);
    Rig cut(scene, settings);
    cut.set_step_budget(150);
    cut.integrator.run(iterations);
    for (const Pass pass : {Pass::eye, Pass::photon, Pass::gather}) {
        EXPECT_GT(calls(cut, pass), calls(whole, pass)) << "the pass was not cut";
    }
    expect_same_picture(cut.integrator.resolve(), whole.integrator.resolve());
}

// What a path remembers of surfaces that it has passed straight, and of the solids that it is in, waits with it.
TEST_F(Determinism, SmallStepBudgetsGiveTheSameBitsThroughSheetsAndInNestedSolids) {
    Scene scene = make_room();
    constexpr std::uint32_t ball = 2;
    Material& outer = scene.materials[ball];
    outer.transmission = outer.thickness = 1.0f;
    outer.roughness = 0.2f;
    outer.attenuation_color = {0.9f, 0.5f, 0.3f};
    outer.attenuation_distance = 0.3f;
    Material inner = glass(1.33f);
    add_sphere(scene, {0.65, 0.5, 0.8}, 0.3, 3, add_material(scene, inner), true);
    Material faint = lambert(glm::vec3(0.5f));
    faint.alpha = Material::Alpha::blend;
    faint.opacity = 0.1f;
    const std::uint32_t sheet = add_material(scene, faint);
    for (int i = 0; i < 20; ++i) add_quad(scene, {0.2, 0.2, 1.3 + 0.02 * i}, {1.6, 0, 0}, {0, 1.6, 0}, sheet);
    const Settings settings = settings_of("cppm");
    Rig whole(scene, settings);
    ASSERT_NE(whole.flat.nested, "");
    whole.integrator.run(iterations);
    for (const std::uint32_t budget : {150u, 177u}) {
        Rig cut(scene, settings);
        cut.set_step_budget(budget);
        cut.integrator.run(iterations);
        for (const Pass pass : {Pass::eye, Pass::photon}) EXPECT_GT(calls(cut, pass), calls(whole, pass)) << "not cut";
        expect_same_picture(cut.integrator.resolve(), whole.integrator.resolve(), fmt::format("budget {}", budget));
    }
}

// Where eye paths ask for lights, the ray to one is cut too, also behind a path that has ended.
TEST_F(Determinism, SmallStepBudgetsGiveTheSameBitsWhereLightsAreAskedFor) {
    for (const Case& room : small_light_cases()) {
        Scene scene = make_room();
        Settings settings = settings_of("cppm");
        room.change(scene, settings);
        Rig whole(scene, settings);
        whole.integrator.run(iterations);
        for (const std::uint32_t budget : {120u, 132u}) {
            Rig cut(scene, settings);
            cut.set_step_budget(budget);
            cut.integrator.run(iterations);
            EXPECT_GT(calls(cut, Pass::eye), calls(whole, Pass::eye)) << "the eye pass was not cut";
            expect_same_picture(cut.integrator.resolve(), whole.integrator.resolve(),
                                fmt::format("{}, step budget {}", room.name, budget));
        }
    }
}

TEST_F(Determinism, TheSameSeedGivesTheSameBitsAndAnotherSeedOthers) {
    Rig first(room(), settings_of("cppm")), again(room(), settings_of("cppm")), other(room(), settings_of("cppm", 2));
    first.integrator.run(iterations);
    for (std::uint32_t i = 0; i < iterations; ++i) again.integrator.run(1);
    other.integrator.run(iterations);
    const Image a = first.integrator.resolve(), b = again.integrator.resolve(), c = other.integrator.resolve();
    expect_same_picture(b, a, "in one submission and in several");
    EXPECT_GT(differences(a, c), first.pixels() * 9 / 10) << "of " << first.pixels() << " pixels under another seed";
}

TEST_F(Determinism, EveryFormOfTheKernelsGivesTheSameBits) {
    Rig whole(room(), settings_of("cppm"), plain_device());
    whole.integrator.run(iterations);
    const auto expected = whole.integrator.save();
    const std::vector<std::vector<KernelForm>> several = {
        {{16, false}}, {{256, false}}, {{64, true}}, {{64, false}, {64, true}, {16, false}}};
    for (const std::vector<KernelForm>& forms : several) {
        Integrator other(whole.on_device, whole.scene.cameras.at(0), whole.settings, forms);
        other.run(iterations);
        const std::string name = fmt::format("{} forms, {} first", forms.size(), text_of(forms.front()));
        expect_same_picture(other.resolve(), whole.integrator.resolve(), name);
        EXPECT_TRUE(expected == other.save()) << "state, " << name;
    }
}

TEST_F(Determinism, FormsAreMeasuredWhileTheyRenderAndThenOneIsKept) {
    Rig whole(room(), settings_of("cppm"), plain_device());
    const std::vector<KernelForm> forms = {{64, false}, {64, true}, {16, false}};
    Integrator other(whole.on_device, whole.scene.cameras.at(0), whole.settings, forms);
    const auto form_of_photon = [&] {
        Report report;
        other.fill(report);
        return report_of(report.passes, Pass::photon).form;
    };
    constexpr std::uint32_t enough = 3 * KernelChoice::rounds;
    other.run(enough - 1);
    EXPECT_EQ(form_of_photon(), "being measured");
    other.run(enough);  // iterations that had to be finished in further rounds are not measured
    std::vector<std::string> names;
    for (const KernelForm& form : forms) names.push_back(text_of(form));
    EXPECT_NE(std::ranges::find(names, form_of_photon()), names.end()) << form_of_photon();
    whole.integrator.run(2 * enough - 1);
    EXPECT_TRUE(whole.integrator.save() == other.save());
}

}  // namespace
}  // namespace vkcppm::test
