// Every lobe of every kind of material, at several widths and angles: reciprocal, sampled in proportion to its density,
// of the oracle's albedo, and split between following and gathering without rest; and that the host's traits of a
// material are what the kernels find.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/material.h"
#include "flat/textures.h"
#include "kernels/probe.h"
#include "oracle/bsdf.h"
#include "oracle/sheen.h"
#include "support/device/gpu.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

constexpr std::uint32_t bsdf_words[] = {
#include "bsdf.spv.inc"
};

/// LOBE_* and LOBE_NONE of shaders/include/bsdf.glsl.
// clang-format off
enum LobeIndex : std::uint32_t {
#define NAME_LOBE(number, NAME, name, present) name = number,
    LOBES(NAME_LOBE)
#undef NAME_LOBE
    none = lobe_count
};
// clang-format on

constexpr std::uint32_t features = FEATURE_REFLECTION | FEATURE_TRANSMISSION | FEATURE_GLOSS | FEATURE_ROUGH |
                                   FEATURE_COAT | FEATURE_CLEARCOAT | FEATURE_THIN | FEATURE_SPECULAR_GLASS;
// What few materials have, and all of a scene that has it are made for.
constexpr std::uint32_t rare_features = FEATURE_ANISOTROPY | FEATURE_IRIDESCENCE | FEATURE_SHEEN;
constexpr std::uint32_t knn = 10;
constexpr float delta = 1e38f;  // densities above it are infinite
// Of anisotropic facets, oblique to the azimuth of at_angle: 0.4 + 0.6 rad.
const glm::vec3 tangent(0.5403023f, 0.84147098f, 0.0f);

constexpr std::array roughnesses = {0.05f, 0.2f, 0.5f, 1.0f};
constexpr std::array angles = {0.0, 25.0, 50.0, 70.0, 85.0};  // degrees

struct Case {
    std::string name;
    Material material;
    bool front = true;
};

/// Materials whose lobes all have the same roughness, and mixtures.
std::vector<Case> cases(float roughness) {
    std::vector<Case> list;
    const auto add = [&](const char* name, auto&& change) -> Material& {
        Material m;
        m.name = name;
        m.metallic = 0.0f;
        m.specular = 0.0f;
        m.roughness = roughness;
        m.base_color = {0.8f, 0.5f, 0.2f};
        change(m);
        list.push_back({name, m});
        return list.back().material;
    };
    const auto from_both_sides = [&](const char* name, auto&& change) {
        add(name, change);
        list.push_back({fmt::format("{} from inside", name), list.back().material, false});
    };
    add("diffuse", [](Material&) {});
    add("white metal", [](Material& m) { m.metallic = 1.0f, m.base_color = glm::vec3(1.0f); });
    add("gold", [](Material& m) { m.metallic = 1.0f, m.base_color = {1.0f, 0.78f, 0.36f}; });
    add("nearly black metal", [](Material& m) { m.metallic = 1.0f, m.base_color = glm::vec3(0.0f, 0.0f, 0.01f); });
    add("coat over diffuse", [](Material& m) { m.specular = 1.0f; });
    add("coat over black", [](Material& m) { m.specular = 1.0f, m.base_color = glm::vec3(0.0f); });
    add("tinted coat", [](Material& m) { m.specular = 0.6f, m.specular_color = {1.0f, 0.5f, 2.0f}, m.ior = 1.8f; });
    add("coat of infinite index", [](Material& m) { m.specular = 0.7f, m.ior = 0.0f; });
    add("half metal", [](Material& m) { m.metallic = 0.5f, m.specular = 1.0f; });
    const auto glass = [](float ior, float thickness) {
        return [=](Material& m) { m.transmission = 1.0f, m.thickness = thickness, m.ior = ior, m.specular = 1.0f; };
    };
    from_both_sides("glass", glass(1.5f, 1.0f));
    from_both_sides("diamond", glass(2.4f, 1.0f));
    from_both_sides("glass of index 1", glass(1.0f, 1.0f));
    from_both_sides("thin glass", glass(1.5f, 0.0f));
    from_both_sides("glass in part", [](Material& m) {
        m.transmission = 0.6f, m.thickness = 1.0f, m.metallic = 0.3f, m.specular = 1.0f;
    });
    for (const float thickness : {0.0f, 1.0f}) {
        const std::string kind = thickness > 0.0f ? "glass" : "thin glass";
        from_both_sides((kind + " that reflects less").c_str(), [=](Material& m) {
            glass(1.5f, thickness)(m);
            m.specular = 0.4f;
        });
        from_both_sides((kind + " that reflects in colours").c_str(), [=](Material& m) {
            glass(1.7f, thickness)(m);
            m.specular = 0.9f, m.specular_color = {1.0f, 0.3f, 20.0f};
        });
    }
    add("clearcoat over black",
        [=](Material& m) { m.base_color = glm::vec3(0.0f), m.clearcoat = 1.0f, m.clearcoat_roughness = roughness; });
    add("clearcoat over diffuse", [=](Material& m) { m.clearcoat = 0.8f, m.clearcoat_roughness = roughness; });
    add("clearcoat over a rougher metal",
        [=](Material& m) { m.metallic = 1.0f, m.clearcoat = 1.0f, m.clearcoat_roughness = 0.5f * roughness; });
    add("smooth clearcoat over gold", [](Material& m) { m.metallic = 1.0f, m.clearcoat = 0.9f; });
    add("white metal, stretched",
        [](Material& m) { m.metallic = 1.0f, m.base_color = glm::vec3(1.0f), m.anisotropy = 0.5f; });
    add("stretched coat over diffuse", [](Material& m) { m.specular = 1.0f, m.anisotropy = 0.8f; });
    from_both_sides("stretched glass", [=](Material& m) { glass(1.5f, 1.0f)(m), m.anisotropy = 0.6f; });
    from_both_sides("stretched thin glass", [=](Material& m) { glass(1.5f, 0.0f)(m), m.anisotropy = 0.6f; });
    const auto film = [](Material& m) { m.iridescence = 1.0f, m.iridescence_thickness_maximum = 350.0f; };
    add("film over diffuse", [=](Material& m) { m.specular = 1.0f, film(m); });
    add("film over gold", [=](Material& m) { m.metallic = 1.0f, m.base_color = {1.0f, 0.78f, 0.36f}, film(m); });
    add("film over black metal", [=](Material& m) { m.metallic = 1.0f, m.base_color = glm::vec3(0.0f), film(m); });
    add("film in part, denser than its base", [=](Material& m) {
        m.metallic = 0.4f, m.specular = 0.8f, m.specular_color = {1.0f, 0.5f, 2.0f}, film(m);
        m.iridescence = 0.7f, m.iridescence_ior = 1.9f;
    });
    from_both_sides("glass with a film", [=](Material& m) { glass(1.5f, 1.0f)(m), film(m); });
    from_both_sides("thin glass with a film", [=](Material& m) { glass(1.5f, 0.0f)(m), film(m); });
    from_both_sides("film around index 1", [=](Material& m) { glass(1.0f, 1.0f)(m), film(m); });
    const auto sheen = [=](Material& m) { m.sheen_color = {0.9f, 0.5f, 0.7f}, m.sheen_roughness = roughness; };
    add("sheen over black", [=](Material& m) { m.base_color = glm::vec3(0.0f), sheen(m); });
    add("white sheen over white",
        [=](Material& m) { m.base_color = m.sheen_color = glm::vec3(1.0f), m.sheen_roughness = roughness; });
    add("sheen between coats",
        [=](Material& m) { m.specular = 1.0f, m.clearcoat = 0.7f, m.clearcoat_roughness = roughness, sheen(m); });
    from_both_sides("glass with sheen", [=](Material& m) { glass(1.5f, 1.0f)(m), sheen(m); });
    add("everything", [](Material& m) {
        m.metallic = 0.2f, m.transmission = 0.4f, m.specular = 0.9f, m.clearcoat = 0.5f, m.clearcoat_roughness = 0.3f;
        m.anisotropy = 0.7f, m.iridescence = 0.6f, m.sheen_color = {0.2f, 0.4f, 0.3f}, m.sheen_roughness = 0.5f;
    });
    return list;
}

oracle::Bsdf oracle_of(const Case& c) {
    const Material& m = c.material;
    oracle::Bsdf b;
    b.base_color = glm::dvec3(m.base_color);
    b.metallic = m.metallic;
    b.alpha = double(m.roughness) * double(m.roughness);
    b.anisotropy = m.anisotropy;
    b.tangent = glm::dvec3(tangent);
    b.film = m.iridescence;
    b.film_ior = m.iridescence_ior;
    b.film_thickness = m.iridescence_thickness_maximum;
    b.transmission = m.transmission;
    b.ior = b.refraction_ior = m.ior;
    b.specular = m.specular;
    b.specular_color = glm::dvec3(m.specular_color);
    b.coat = m.clearcoat;
    b.coat_alpha = double(m.clearcoat_roughness) * double(m.clearcoat_roughness);
    b.sheen_color = glm::dvec3(m.sheen_color);
    b.sheen_alpha = double(m.sheen_roughness) * double(m.sheen_roughness);
    b.thin = m.thickness == 0.0f;
    b.front = c.front;
    return b;
}

/// Index on the side of wo over that of the other side of the surface.
double index_ratio(const Case& c) {
    return c.material.thickness == 0.0f ? 1.0 : c.front ? 1.0 / double(c.material.ior) : double(c.material.ior);
}

glm::vec3 at_angle(double degrees, double azimuth = 0.4) {
    const double a = degrees * pi / 180.0;
    return glm::vec3(
        glm::normalize(glm::dvec3(std::sin(a) * std::cos(azimuth), std::sin(a) * std::sin(azimuth), std::cos(a))));
}

/// Relative rounding of what a facet of glass reflects or transmits: the cosine beyond it is the root of a difference,
/// which cancels towards the critical angle; and that of the cosine on this side of a facet that is met at grazing
/// incidence.
double critical_rounding(const Case& c, const glm::dvec3& wo, const glm::dvec3& wi) {
    const double ratio = index_ratio(c);
    if (ratio == 1.0) return 0.0;
    const glm::dvec3 h = glm::normalize(wi.z > 0.0 ? wo + wi : ratio * wo + wi);
    const double cosine = glm::dot(wo, h), squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    // f falls with its square.
    const double off = wi.z > 0.0 ? 0.0 : 6e-7 / std::max(1e-7, cosine);
    return off * (2.0 + off) + 4e-7 * std::max(1.0, ratio * ratio) / std::max(1e-12, std::abs(squared));
}

gpu::BsdfView view_of(const Case& c, const glm::vec3& outgoing, std::uint32_t lobe) {
    gpu::BsdfView view{};
    view.outgoing = outgoing;
    view.geometric = view.normal = view.clearcoat_normal = glm::vec3(0.0f, 0.0f, 1.0f);
    view.tangent = tangent;
    view.front = c.front ? 1 : 0;
    view.lobe = lobe;
    return view;
}

std::vector<gpu::BsdfInput> random_numbers(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return float(random() >> 8) / 16777216.0f; };
    std::vector<gpu::BsdfInput> inputs(count);
    for (auto& input : inputs) {
        for (int c = 0; c < 3; ++c) input.u[c] = next();
    }
    return inputs;
}

class BsdfLobes : public GpuTest {
protected:
    void SetUp() override {
        GpuTest::SetUp();
        gpu::Params params{};
        params.knn = knn;
        for (Probe* probe : {&usual_, &rare_}) probe->input(Binding::params, std::vector{params});
    }

    /// views: one for all inputs, or one each.
    std::vector<gpu::BsdfOutput> run(const Material& material, const std::vector<gpu::BsdfView>& views,
                                     const std::vector<gpu::BsdfInput>& inputs, bool follow) {
        const Scene scene;
        TextureTable textures(scene);
        const MaterialTraits traits = traits_of(material, 1.0f);
        const bool rare = traits.anisotropic || traits.iridescent || traits.has(Lobe::sheen);
        Probe& probe = rare ? rare_ : usual_;
        probe.input(Binding::materials, std::vector{gpu_material(material, traits, 1.0, textures)});
        probe.input(PROBE_VIEW, views);
        probe.input(PROBE_INPUT, inputs);
        probe.output<gpu::BsdfOutput>(PROBE_OUTPUT, inputs.size());
        probe.run(inputs.size(), {.iteration = 0,
                                  .round = 0,
                                  .last_round = 0,
                                  .argument = follow ? 1u : 0u,
                                  .items = std::uint32_t(inputs.size())});
        return probe.result<gpu::BsdfOutput>(PROBE_OUTPUT, inputs.size());
    }

    std::vector<gpu::BsdfOutput> run(const Material& material, const gpu::BsdfView& view,
                                     const std::vector<gpu::BsdfInput>& inputs, bool follow) {
        return run(material, std::vector{view}, inputs, follow);
    }

    Probe usual_{"bsdf", bsdf_words, 32, features};
    Probe rare_{"bsdf", bsdf_words, 32, features | rare_features};
};

constexpr oracle::Lobe oracle_lobe[] = {oracle::Lobe::diffuse, oracle::Lobe::reflection, oracle::Lobe::transmission,
                                        oracle::Lobe::coat, oracle::Lobe::sheen};
static_assert(std::size(oracle_lobe) == lobe_count, "a lobe more: oracle_lobe, lobe_widths, lobe_density, LobeCase");

std::string text(const glm::dvec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// Calls check(case, angle, wo) with the case's name in every failure.
template <typename Check> void for_views(Check check) {
    for (const float roughness : roughnesses) {
        for (const Case& c : cases(roughness)) {
            for (const double angle : angles) {
                SCOPED_TRACE(fmt::format("{}, roughness {}, {} degrees", c.name, roughness, angle));
                check(c, at_angle(angle));
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

/// Alpha of the narrowest lobe of a width above 0, across the tangent.
double narrowest(const oracle::Bsdf& b) {
    double alpha = b.alpha;
    if (b.coat > 0.0 && b.coat_alpha > 0.0) alpha = std::min(alpha, b.coat_alpha);
    if (b.sheen_color != glm::dvec3(0.0)) alpha = std::min(alpha, std::max(b.sheen_alpha, 0.0049));
    return alpha;
}

/// What the fit of include/sheen.glsl may be off: of the albedo where that is at most 1, else of its share.
constexpr double albedo_fit = 8e-4;

/// How far that fit may take values off: what lies below in proportion to its value without sheen, and sheen that is
/// brought down to what arrives.
glm::dvec3 off_by_fit(const oracle::Bsdf& b, const glm::dvec3& wo, const glm::dvec3& wi) {
    if (b.sheen_color == glm::dvec3(0.0)) return glm::dvec3(0.0);
    oracle::Bsdf bare = b;
    bare.sheen_color = glm::dvec3(0.0);
    const double most = std::max(oracle::sheen_albedo(std::abs(wo.z), b.sheen_alpha),
                                 oracle::sheen_albedo(std::abs(wi.z), b.sheen_alpha));
    const glm::dvec3 brought_down = most > 1.0 - albedo_fit ? b.evaluate(oracle::Lobe::sheen, wo, wi) : glm::dvec3(0.0);
    return albedo_fit * (bare.evaluate(wo, wi) + brought_down);
}

/// Widths of a lobe along the tangent and across it.
struct Widths {
    double along, across;
    /// Of the direction w, so much longer along and across.
    static double stretched(const glm::dvec3& w, double along, double across) {
        const glm::dvec3 t(tangent), s = glm::cross(glm::dvec3(0.0, 0.0, 1.0), t);
        return std::hypot(along * glm::dot(w, t), across * glm::dot(w, s));
    }
    double ggx(const glm::dvec3& h) const {
        const double tan2 = std::pow(stretched(h, 1.0 / along, 1.0 / across) / h.z, 2);
        return 1.0 / (pi * along * across * std::pow(h.z * h.z * (1.0 + tan2), 2));
    }
    double g1(const glm::dvec3& wo) const {
        return 2.0 / (1.0 + std::sqrt(1.0 + std::pow(stretched(wo, along, across) / wo.z, 2)));
    }
};

Widths lobe_widths(LobeIndex lobe, const oracle::Bsdf& b) {
    if (lobe == sheen) return {1.0, 1.0};
    const double alpha = lobe == clearcoat ? b.coat_alpha : b.alpha;
    const double strength = lobe == clearcoat ? 0.0 : b.anisotropy;
    return {glm::mix(alpha, 1.0, strength * strength), alpha};
}

TEST_F(BsdfLobes, ValuesAreTheReferences) {
    // Directions on the whole sphere, half of them near the peaks of the lobes.
    std::mt19937 random(22);
    std::normal_distribution<double> normal;
    std::size_t bright = 0;
    for_views([&](const Case& c, const glm::vec3& wo) {
        const oracle::Bsdf oracle = oracle_of(c);
        std::vector<gpu::BsdfInput> inputs = random_numbers(500, random());
        const auto sampled = run(c.material, view_of(c, wo, none), inputs, true);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 v(normal(random), normal(random), normal(random));
            const bool near = i % 2 == 0 && glm::dot(sampled[i].direction, sampled[i].direction) > 0.0f;
            inputs[i].incoming = near ? sampled[i].direction : glm::vec3(glm::normalize(v));
        }
        const auto outputs = run(c.material, view_of(c, wo, none), inputs, false);
        const double eta2 = std::pow(index_ratio(c), 2);
        const double alpha = narrowest(oracle);
        const MaterialTraits traits = traits_of(c.material, 1.0f);
        const glm::dvec3 albedo = traits.has(Lobe::diffuse)
                                      ? glm::dvec3(c.material.base_color) * (1.0 - double(c.material.metallic)) *
                                            (1.0 - double(c.material.transmission))
                                      : glm::dvec3(0.0);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::dvec3 wi(inputs[i].incoming);
            if (std::abs(wi.z) < 1e-4) continue;
            const glm::dvec3 want = oracle.evaluate(glm::dvec3(wo), wi) * (wi.z < 0.0 ? eta2 : 1.0);
            const glm::dvec3 off = off_by_fit(oracle, glm::dvec3(wo), wi) * (wi.z < 0.0 ? eta2 : 1.0);
            for (int channel = 0; channel < 3; ++channel) {
                // Rounding of half vectors, in widths of the lobe.
                const double relative = 2e-5 + 3e-6 / alpha + critical_rounding(c, glm::dvec3(wo), wi);
                const double tolerance = relative * want[channel] + off[channel] + 1e-7;
                ASSERT_NEAR(outputs[i].value[channel], want[channel], tolerance)
                    << "wi " << text(wi) << ", channel " << channel;
            }
            bright += want.y > 0.01 ? 1 : 0;
            // Elsewhere photons are weighed by the diffuse albedo alone.
            if (!traits.glossy()) {
                ASSERT_NEAR(want.y, wi.z > 0.0 ? albedo.y / pi : 0.0, 1e-7) << "not glossy, wi " << text(wi);
            }
        }
    });
    EXPECT_GT(bright, 10000u);
}

TEST_F(BsdfLobes, AreReciprocal) {
    std::mt19937 random(22);
    std::normal_distribution<double> normal;
    for (const float roughness : roughnesses) {
        for (const Case& c : cases(roughness)) {
            // What comes through a clearcoat is weighed by the cosine of either direction's own side.
            const bool skip_transmission = c.material.clearcoat > 0.0f && c.material.transmission > 0.0f;
            SCOPED_TRACE(fmt::format("{}, roughness {}", c.name, roughness));
            // All pairs of directions there in one launch, and all of them back in one a side of the surface.
            std::vector<gpu::BsdfView> views;
            std::vector<gpu::BsdfInput> inputs;
            for (int pair = 0; pair < 20; ++pair) {
                glm::vec3 wo(glm::normalize(glm::dvec3(normal(random), normal(random), std::abs(normal(random)))));
                if (wo.z < 0.05f) continue;
                for (const gpu::BsdfInput& input : random_numbers(8, random())) {
                    views.push_back(view_of(c, wo, none));
                    inputs.push_back(input);
                }
            }
            const auto forth = run(c.material, views, inputs, true);
            for (const bool through : {false, true}) {
                if (through && skip_transmission) continue;
                Case other = c;
                if (through && c.material.thickness > 0.0f) other.front = !c.front;
                std::vector<std::size_t> there;  // into `forth`
                std::vector<gpu::BsdfView> views_back;
                std::vector<gpu::BsdfInput> inputs_back;
                for (std::size_t i = 0; i < forth.size(); ++i) {
                    const glm::vec3 wi = forth[i].direction;
                    if (forth[i].density == 0.0f || std::abs(wi.z) < 0.05f || forth[i].weight == glm::vec3(0.0f)) {
                        continue;
                    }
                    if ((wi.z < 0.0f) != through) continue;
                    gpu::BsdfView view = view_of(other, wi, none);
                    if (through) view.geometric = view.normal = view.clearcoat_normal = -view.normal;
                    there.push_back(i);
                    views_back.push_back(view);
                    inputs_back.push_back({.incoming = views[i].outgoing, .u = {}});
                }
                if (there.empty()) continue;
                const auto back = run(c.material, views_back, inputs_back, false);
                // Radiance: f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2.
                const double eta2 = through ? std::pow(index_ratio(c), 2) : 1.0;
                const double alpha = std::pow(std::min(roughness, 0.3f), 2.0) * 0.25;  // of the narrowest lobe
                for (std::size_t i = 0; i < there.size(); ++i) {
                    const gpu::BsdfOutput& out = forth[there[i]];
                    const glm::dvec3 wo(views[there[i]].outgoing), wi(out.direction);
                    const double rounding = 2.0 * critical_rounding(c, wo, wi);
                    for (int channel = 0; channel < 3; ++channel) {
                        const double a = out.value[channel] / eta2, b = back[i].value[channel];
                        ASSERT_NEAR(a, b, (2e-5 + 2e-6 / alpha + rounding) * std::max(a, b) + 1e-7)
                            << "wo " << text(wo) << ", wi " << text(wi) << ", channel " << channel;
                    }
                }
            }
        }
    }
}

TEST_F(BsdfLobes, SheenReflectsTheIntegral) {
    // White over white, both ways at one cosine: what is left is 1 - E, from little roughness to all of it.
    std::vector<gpu::BsdfView> views;
    std::vector<gpu::BsdfInput> inputs;
    Material m;
    m.metallic = m.specular = 0.0f;
    m.sheen_color = glm::vec3(1.0f);
    const Case c{"white sheen over white", m};
    for (int i = 0; i < 200; ++i) {
        const double degrees = std::acos(std::pow(0.01 + 0.99 * (i + 0.5) / 200.0, 2.0)) * 180.0 / pi;
        views.push_back(view_of(c, at_angle(degrees), none));
        inputs.push_back({.incoming = at_angle(degrees, 0.4 + 0.05 * i), .u = {}});
    }
    for (int step = 0; step <= 24; ++step) {
        m.sheen_roughness = std::pow(0.07f, float(step) / 24.0f);
        const double alpha = double(m.sheen_roughness) * double(m.sheen_roughness);
        const auto outputs = run(m, views, inputs, false);
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const double cosine = views[i].outgoing.z;
            const glm::dvec3 h = glm::normalize(glm::dvec3(views[i].outgoing) + glm::dvec3(inputs[i].incoming));
            const double reflected = oracle::sheen_value(cosine, double(inputs[i].incoming.z), h.z, alpha);
            const double albedo = oracle::sheen_albedo(cosine, alpha);
            const double rounding = (2e-5 + 3e-6 / alpha + (albedo > 1.0 - albedo_fit ? albedo_fit : 0.0)) * reflected;
            EXPECT_NEAR(double(outputs[i].value.x) - reflected, (1.0 - std::min(1.0, albedo)) / pi,
                        albedo_fit / pi + rounding)
                << "roughness " << m.sheen_roughness << ", cosine " << cosine << ", an albedo of " << albedo;
        }
    }
}

/// The oracle's, once for all tests that ask for it: it takes longer than what is compared with it.
glm::dvec3 albedo_of(const Case& c, const glm::vec3& wo) {
    static std::map<std::tuple<std::string, float, float>, glm::dvec3> known;
    const auto [entry, is_new] = known.try_emplace({c.name, c.material.roughness, wo.z});
    if (is_new) entry->second = oracle_of(c).directional_albedo(glm::dvec3(wo), 100);
    return entry->second;
}

TEST_F(BsdfLobes, WeightsAverageToTheAlbedo) {
    constexpr std::size_t samples = 1u << 15;
    const auto inputs = random_numbers(samples, 23);
    for_views([&](const Case& c, const glm::vec3& wo) {
        const glm::dvec3 albedo = albedo_of(c, wo);
        const auto outputs = run(c.material, view_of(c, wo, none), inputs, true);
        glm::dvec3 sum(0.0), squares(0.0);
        double heaviest = 0.0;
        const double fit = c.material.sheen_color != glm::vec3(0.0f) ? albedo_fit : 0.0;
        for (const auto& out : outputs) {
            if (out.lobe == none) continue;
            const glm::dvec3 weight = glm::dvec3(out.weight) / double(out.probability);
            sum += weight;
            squares += weight * weight;
            heaviest = std::max(heaviest, std::max({weight.x, weight.y, weight.z}));
        }
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = sum[channel] / samples;
            const double error = std::sqrt(std::max(0.0, squares[channel] / samples - mean * mean) / samples);
            // 1200 means: five standard errors; then the quadrature of the oracle.
            EXPECT_NEAR(mean, albedo[channel], 5.0 * error + 2e-4 + fit)
                << "channel " << channel << ", standard error " << error << ", heaviest sample " << heaviest;
            // The model's coats take from the base by the half vector: together they are too bright at grazing angles.
            const Material& m = c.material;
            const bool bare =
                m.clearcoat == 0.0f && (m.specular == 0.0f || m.metallic == 1.0f || m.transmission == 1.0f);
            if (bare) {
                EXPECT_LE(mean, 1.0 + 5.0 * error + fit) << "more light leaves than arrives";
            }
        }
    });
}

/// Edges of bins that crowd at `peak` of [low, high] with the scale `width`, and the density of their parameter.
struct Warp {
    double low, peak, high, width;
    double at(double t) const {  // t in [-1, 1]
        const double span = t < 0.0 ? peak - low : high - peak;
        if (span == 0.0) return peak;
        const double k = std::log1p(span / width);
        const double s = std::expm1(k * std::abs(t)) / std::expm1(k) * span;
        return t < 0.0 ? peak - s : peak + s;
    }
    double slope(double t) const {
        const double span = t < 0.0 ? peak - low : high - peak;
        if (span == 0.0) return 0.0;
        const double k = std::log1p(span / width);
        return span * k * std::exp(k * std::abs(t)) / std::expm1(k);
    }
    double inverse(double x) const {
        const double span = x < peak ? peak - low : high - peak;
        const double k = std::log1p(span / width);
        if (span == 0.0) return 0.0;
        const double t = std::log1p(std::abs(x - peak) / span * std::expm1(k)) / k;
        return x < peak ? -t : t;
    }
};

/// Density of wi that following one lobe of these widths about +z has, 1/sr: visible normals (Heitz 2014) times the
/// Jacobian of reflection or of refraction (Walter et al. 2007, equations 14 and 17). ratio: index on the side of wo
/// over that beyond.
double lobe_density(LobeIndex lobe, const Widths& widths, bool thin, double ratio, const glm::dvec3& wo,
                    glm::dvec3 wi) {
    if ((wi.z < 0.0) != (lobe == transmission)) return 0.0;
    if (lobe == diffuse) return wi.z / pi;
    if (lobe == sheen) return 0.5 / pi;
    double jacobian = 0.0;
    glm::dvec3 h;
    if (lobe == transmission && !thin) {
        h = glm::normalize(ratio * wo + wi);
        if (h.z < 0.0) h = -h;
        const double oh = glm::dot(wo, h), ih = glm::dot(wi, h);
        if (oh <= 0.0 || ih >= 0.0) return 0.0;
        jacobian = -ih / std::pow(ratio * oh + ih, 2);
    } else {
        if (lobe == transmission) wi.z = -wi.z;
        h = glm::normalize(wo + wi);
        jacobian = 0.25 / glm::dot(wo, h);
    }
    return widths.ggx(h) * widths.g1(wo) * glm::dot(wo, h) / wo.z * jacobian;
}

/// Bins of directions on one side of the surface: crowded about `peak`, aligned with the horizon.
class SphereBins {
public:
    SphereBins(const glm::dvec3& peak, double width)
        : side_(peak.z < 0.0 ? -1.0 : 1.0),
          turn_(std::atan2(peak.y, peak.x)),
          polar_{0.0, std::acos(std::min(1.0, std::abs(peak.z))), 0.5 * pi, width},
          // A facet that tilts sideways turns a grazing direction by less.
          azimuth_{-pi, 0.0, pi, std::min(1.0, width * std::abs(peak.z) / std::max(1e-3, std::hypot(peak.x, peak.y)))} {
    }

    std::size_t count() const { return std::size_t(bins) * bins; }

    std::size_t bin_of(const glm::dvec3& wi) const {
        const double polar = std::acos(std::clamp(side_ * wi.z, 0.0, 1.0));
        const double azimuth = std::remainder(std::atan2(wi.y, wi.x) - turn_, 2.0 * pi);
        const auto index = [](double t) { return std::size_t(std::clamp(0.5 * (t + 1.0) * bins, 0.0, bins - 1.0)); };
        return index(polar_.inverse(polar)) * bins + index(azimuth_.inverse(azimuth));
    }

    /// Gauss-Legendre rule of 7^2 points on each of 6^2 parts of a bin.
    template <typename Density> std::vector<double> integrals(Density density) const {
        using Rule = boost::math::quadrature::gauss<double, 7>;
        constexpr int parts = 6;
        constexpr std::size_t points_a_bin = 7 * parts;
        std::vector<std::pair<double, double>> points;  // of all bins, in [-1, 1], and their weights
        for (int part = 0; part < bins * parts; ++part) {
            const double middle = (2.0 * part + 1.0) / (bins * parts) - 1.0;
            for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
                const double offset = Rule::abscissa()[i] / (bins * parts);
                const double weight = Rule::weights()[i] / (bins * parts);
                points.emplace_back(middle + offset, weight);
                if (offset != 0.0) points.emplace_back(middle - offset, weight);
            }
        }
        std::vector<double> result(count(), 0.0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double polar = polar_.at(points[i].first);
            const double row = std::sin(polar) * polar_.slope(points[i].first) * points[i].second;
            if (row == 0.0) continue;
            for (std::size_t j = 0; j < points.size(); ++j) {
                const double azimuth = azimuth_.at(points[j].first) + turn_;
                const glm::dvec3 wi(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                    side_ * std::cos(polar));
                result[i / points_a_bin * bins + j / points_a_bin] +=
                    density(wi) * row * azimuth_.slope(points[j].first) * points[j].second;
            }
        }
        return result;
    }

private:
    static constexpr int bins = 14;
    double side_, turn_;
    Warp polar_, azimuth_;
};

/// Where a facet of normal h sends wo; none where refraction ends.
std::optional<glm::dvec3> scattered(LobeIndex lobe, bool thin, double ratio, const glm::dvec3& wo,
                                    const glm::dvec3& h) {
    const double cosine = glm::dot(wo, h);
    if (lobe == transmission && !thin) {
        const double squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
        if (squared <= 0.0) return std::nullopt;
        return glm::normalize((ratio * cosine - std::sqrt(squared)) * h - ratio * wo);
    }
    glm::dvec3 wi = 2.0 * cosine * h - wo;
    if (lobe == transmission) wi.z = -wi.z;
    return wi;
}

/// Shares of the bins in what visible normals about +z scatter, by points of a rule over the normals: for a density of
/// directions that falls like a root where refraction ends, or that is a ridge. FollowingAndGatheringMakeOneWhole holds
/// that density to account.
template <typename Scatter>
std::vector<double> shares_of_normals(const SphereBins& bins, const Widths& widths, const glm::dvec3& wo, bool through,
                                      Scatter scatter) {
    constexpr int normals = 120000;
    std::vector<double> shares(bins.count(), 0.0);
    const glm::dvec3 x(tangent), y = glm::cross(glm::dvec3(0.0, 0.0, 1.0), x);
    const double g1 = widths.g1(wo);
    double whole = 0.0;
    for (int i = 0; i < normals; ++i) {
        // Slopes of r times the widths, r^2 = (1 - t^2) / t^2, have the density D (n.h) where that of t is 2 t. Turns
        // by the golden ratio: rows of a grid would lie along the edges of bins.
        const double t = (i + 0.5) / normals, r = std::sqrt(1.0 - t * t);
        const double turn = 2.0 * pi * std::fmod(i / std::numbers::phi, 1.0);
        const glm::dvec3 h = glm::normalize(
            r * (widths.along * std::cos(turn) * x + widths.across * std::sin(turn) * y) + glm::dvec3(0.0, 0.0, t));
        const double cosine = glm::dot(wo, h);
        if (cosine <= 0.0) continue;
        const double share = 2.0 * t * g1 * cosine / (wo.z * h.z) / normals;
        whole += share;
        const std::optional<glm::dvec3> wi = scatter(h);
        if (wi && (wi->z < 0.0) == through) shares[bins.bin_of(*wi)] += share;
    }
    EXPECT_NEAR(whole, 1.0, 1e-3) << "the density of visible normals";
    for (double& share : shares) share /= whole;
    return shares;
}

TEST_F(BsdfLobes, TheDensityOfAllIsThatOfWhatIsChosenAndFollowed) {
    constexpr std::size_t samples = 1u << 10;
    constexpr float wide = FAR;  // WIDE of shaders/include/ggx.glsl
    const auto inputs = random_numbers(samples, 26);
    std::array<std::size_t, lobe_count> chosen{};
    for_views([&](const Case& c, const glm::vec3& outgoing) {
        const oracle::Bsdf oracle = oracle_of(c);
        const MaterialTraits traits = traits_of(c.material, 1.0f);
        const glm::dvec3 wo = glm::normalize(glm::dvec3(outgoing));
        const double ratio = index_ratio(c), alpha = narrowest(oracle);
        const auto outputs = run(c.material, view_of(c, outgoing, none), inputs, true);
        ASSERT_EQ(outputs[0].sides != HIT_NONE, traits.gathers());
        std::array<double, lobe_count> probability{};
        double wide_probability = 0.0;
        for (const auto& out : outputs) {
            if (out.lobe == none) continue;
            ASSERT_LT(out.lobe, lobe_count);
            const LobeTraits& lobe = traits.lobes[out.lobe];
            ASSERT_TRUE(out.width == wide   ? lobe.wide
                        : out.width == 0.0f ? lobe.smooth
                                            : lobe.rough)
                << "the traits of lobe " << out.lobe << ", of width " << out.width;
            if (probability[out.lobe] == 0.0 && out.width == wide) wide_probability += double(out.probability);
            probability[out.lobe] = out.probability;
            ++chosen[out.lobe];
        }
        // Sheen seen from above reflects so little that none of the samples may have chosen it.
        double unknown = 1.0;
        for (const double p : probability) unknown -= p;
        if (traits.has(Lobe::sheen) && probability[sheen] == 0.0) probability[sheen] = std::max(0.0, unknown);
        // Over the samples the cosine over pi, divided by their density, averages to its integral of 1, and is nowhere
        // above one over the probability of the lobes that are sampled by it.
        double sum = 0.0, squares = 0.0;
        for (const auto& out : outputs) {
            // Of lobes without facets every direction is one, also where they are as good as black.
            const bool lost = out.width != wide && out.weight == glm::vec3(0.0f);
            if (out.lobe == none || out.density >= delta || lost) continue;
            const glm::dvec3 wi = glm::normalize(glm::dvec3(out.direction));
            const double share = std::max(0.0, wi.z) / pi / double(out.scatter);
            sum += share;
            squares += share * share;
            if (std::abs(wi.z) < 1e-3) continue;
            double want = 0.0;
            for (std::uint32_t lobe = 0; lobe < lobe_count; ++lobe) {
                const Widths widths = lobe_widths(LobeIndex(lobe), oracle);
                if (probability[lobe] == 0.0 || widths.along == 0.0) continue;
                want += probability[lobe] * lobe_density(LobeIndex(lobe), widths, oracle.thin, ratio, wo, wi);
            }
            const double relative = 3e-5 + 3e-6 / alpha + critical_rounding(c, wo, wi);
            ASSERT_NEAR(out.scatter, want, relative * want + 1e-6) << "wi " << text(wi) << ", lobe " << out.lobe;
        }
        if (wide_probability < 0.05) return;
        const double mean = sum / samples;
        const double error = std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples);
        EXPECT_NEAR(mean, 1.0, 5.0 * error + 1e-4) << "the integral of the cosine over pi";
    });
    for (std::uint32_t lobe = 0; lobe < lobe_count; ++lobe) {
        EXPECT_GT(chosen[lobe], 1000u) << "no material of cases() has lobe " << lobe;
    }
}

struct LobeCase {
    LobeIndex lobe;
    const char* material;
};

TEST_F(BsdfLobes, DirectionsFollowTheDensityThatTheyReport) {
    constexpr std::size_t samples = 60000;
    const auto inputs = random_numbers(samples, 24);
    const std::array lobes = {
        LobeCase{diffuse, "coat over diffuse"},         LobeCase{reflection, "gold"},
        LobeCase{reflection, "glass from inside"},      LobeCase{transmission, "glass"},
        LobeCase{transmission, "glass from inside"},    LobeCase{transmission, "diamond"},
        LobeCase{transmission, "thin glass"},           LobeCase{clearcoat, "clearcoat over diffuse"},
        LobeCase{reflection, "white metal, stretched"}, LobeCase{transmission, "stretched glass"},
        LobeCase{transmission, "stretched thin glass"}, LobeCase{sheen, "sheen over black"}};
    for (std::uint32_t lobe = 0; lobe < lobe_count; ++lobe) {
        EXPECT_TRUE(std::ranges::any_of(lobes, [&](const LobeCase& of) { return of.lobe == lobe; })) << "lobe " << lobe;
    }
    const double level = sidak(1e-3, lobes.size() * roughnesses.size() * angles.size());
    for_views([&](const Case& c, const glm::vec3& outgoing) {
        for (const LobeCase& which : lobes) {
            if (c.name != which.material) continue;
            const LobeIndex lobe = which.lobe;
            const glm::dvec3 wo = glm::normalize(glm::dvec3(outgoing));
            const oracle::Bsdf oracle = oracle_of(c);
            const Widths widths = lobe_widths(lobe, oracle);
            const double ratio = index_ratio(c);
            const bool thin = oracle.thin;
            const auto density = [&](const glm::dvec3& wi) { return lobe_density(lobe, widths, thin, ratio, wo, wi); };

            glm::dvec3 peak(-wo.x, -wo.y, wo.z);
            if (lobe == diffuse || lobe == sheen) peak = {0.0, 0.0, 1.0};
            if (lobe == transmission && thin) peak.z = -wo.z;
            if (lobe == transmission && !thin) {
                const double across = std::min(0.999, ratio * std::hypot(wo.x, wo.y)), along = std::hypot(wo.x, wo.y);
                peak = glm::dvec3(-wo.x, -wo.y, 0.0) * (along > 0.0 ? across / along : 0.0);
                peak.z = -std::sqrt(1.0 - across * across);
            }
            // Refraction bends what a facet's tilt does by the difference of the indices.
            // As wide as a ridge is long: across it a bin holds all.
            const double width = lobe == diffuse                 ? 1.0
                                 : lobe == transmission && !thin ? 0.4 * widths.along
                                                                 : widths.along;
            const SphereBins bins(peak, width);
            const auto scatter = [&](const glm::dvec3& h) { return scattered(lobe, thin, ratio, wo, h); };
            std::vector<double> expected = (lobe == transmission && !thin) || widths.along != widths.across
                                               ? shares_of_normals(bins, widths, wo, lobe == transmission, scatter)
                                               : bins.integrals(density);
            double whole = 0.0;
            for (const double p : expected) whole += p;
            // The rule's error: 30 of the samples, where a bin has thousands.
            ASSERT_LT(whole, 1.0 + 5e-4) << "lobe " << lobe;
            expected.push_back(std::max(0.0, 1.0 - whole));  // what ends behind the horizon or is totally reflected
            for (double& p : expected) p /= std::max(1.0, whole);

            std::vector<std::uint64_t> observed(expected.size());
            std::size_t followed = 0;
            for (const auto& out : run(c.material, view_of(c, outgoing, lobe), inputs, true)) {
                if (out.density >= delta) {
                    ASSERT_EQ(out.weight, glm::vec3(0.0f)) << "lobe " << lobe << ": a rough lobe has a finite density";
                    ++observed.back();
                    continue;
                }
                ASSERT_NEAR(glm::length(glm::dvec3(out.direction)), 1.0, 1e-6);
                const glm::dvec3 wi = glm::normalize(glm::dvec3(out.direction));
                ++observed[bins.bin_of(wi)];
                if (std::abs(wi.z) < 1e-3) continue;
                const double want = density(wi);
                const double relative = 2e-5 + 3e-6 / widths.across + critical_rounding(c, wo, wi);
                ASSERT_NEAR(out.density, want, relative * want + 1e-6)
                    << "lobe " << lobe << ", wi " << text(wi) << ": density";
                // f cos / density, lobe by lobe.
                glm::dvec3 weight = oracle.evaluate(oracle_lobe[lobe], wo, wi) * (std::abs(wi.z) / want);
                const glm::dvec3 off = off_by_fit(oracle, wo, wi) * (std::abs(wi.z) / want);
                // That of sheen is no ratio in which the rounding of the half vector cancels.
                const double rounding = lobe == sheen ? 3e-6 / narrowest(oracle) : 0.0;
                for (int channel = 0; channel < 3; ++channel) {
                    const double relative_weight = 2e-5 + rounding + critical_rounding(c, wo, wi);
                    const double tolerance = relative_weight * weight[channel] + off[channel] + 1e-6;
                    ASSERT_NEAR(out.weight[channel], weight[channel], tolerance)
                        << "lobe " << lobe << ", wi " << text(wi) << ": weight, channel " << channel;
                }
                ++followed;
            }
            if (whole < 0.01) {  // nearly all is totally reflected
                EXPECT_NEAR(double(followed), whole * samples, 5.0 * std::sqrt(whole * samples) + 1.0)
                    << "lobe " << lobe;
                continue;
            }
            expect_density(fmt::format("lobe {}", std::uint32_t(lobe)), chi_squared(observed, expected), level);
        }
    });
}

TEST_F(BsdfLobes, FollowingAndGatheringMakeOneWhole) {
    // What following finds, weighed, and what photons bring from everywhere, weighed, add up to the albedo. Gathering
    // is integrated over cosine-distributed directions of both sides: its weighed values times pi are at most knn or
    // so.
    constexpr std::size_t samples = 1u << 14;
    const auto inputs = random_numbers(samples, 25);
    std::vector<gpu::BsdfInput> everywhere = inputs;
    for (std::size_t i = 0; i < samples; ++i) {
        const double r = std::sqrt(double(inputs[i].u.x)), turn = 2.0 * pi * double(inputs[i].u.y);
        const double z = std::sqrt(1.0 - r * r);
        everywhere[i].incoming = glm::vec3(r * std::cos(turn), r * std::sin(turn), i % 2 == 0 ? z : -z);
    }
    for_views([&](const Case& c, const glm::vec3& wo) {
        const glm::dvec3 albedo = albedo_of(c, wo);
        const double fit = c.material.sheen_color != glm::vec3(0.0f) ? albedo_fit : 0.0;
        const double eta2 = std::pow(index_ratio(c), 2);
        glm::dvec3 sum(0.0), squares(0.0);
        const auto followed = run(c.material, view_of(c, wo, none), inputs, true);
        const auto gathered = run(c.material, view_of(c, wo, none), everywhere, false);
        double least = 1.0, most = 0.0;
        for (std::size_t i = 0; i < samples; ++i) {
            glm::dvec3 light = glm::dvec3(gathered[i].gathered) * (2.0 * pi);
            if (everywhere[i].incoming.z < 0.0f) light /= eta2;
            // Eye paths gather on lobes without facets alone.
            if (followed[i].lobe != none && followed[i].width != FAR && followed[i].weight != glm::vec3(0.0f)) {
                light +=
                    glm::dvec3(followed[i].weight) * double(followed[i].followed) / double(followed[i].probability);
                least = std::min(least, double(followed[i].followed));
                most = std::max(most, double(followed[i].followed));
            }
            sum += light;
            squares += light * light;
        }
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = sum[channel] / samples;
            const double error = std::sqrt(std::max(0.0, squares[channel] / samples - mean * mean) / samples);
            EXPECT_NEAR(mean, albedo[channel], 5.0 * error + 5e-4 + fit)
                << "channel " << channel << ", standard error " << error << ", weights of following from " << least
                << " to " << most;
        }
    });
}

}  // namespace
}  // namespace vkcppm::test
