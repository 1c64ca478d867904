// The oracle's scattering function against what holds for any, and against its own limits.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "oracle/bsdf.h"
#include "oracle/dispersion.h"
#include "oracle/fresnel.h"
#include "oracle/sheen.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;

struct Case {
    std::string name;
    Bsdf bsdf;
};

std::vector<Case> cases() {
    Bsdf lambert;
    lambert.base_color = {0.8, 0.5, 0.2};
    lambert.specular = 0.0;
    Bsdf metal;
    metal.base_color = {0.9, 0.6, 0.3};
    metal.metallic = 1.0;
    metal.alpha = 0.3;
    Bsdf plastic = lambert;
    plastic.specular = 0.9;
    plastic.specular_color = {1.0, 0.7, 0.5};
    plastic.alpha = 0.2;
    Bsdf frosted;
    frosted.base_color = {0.9, 0.8, 0.7};
    frosted.transmission = 1.0;
    frosted.alpha = 0.4;
    frosted.thin = false;
    Bsdf frosted_inside = frosted;
    frosted_inside.front = false;
    Bsdf pane = frosted;
    pane.thin = true;
    Bsdf everything = plastic;
    everything.metallic = 0.2;
    everything.transmission = 0.4;
    everything.thin = false;
    everything.alpha = 0.35;
    everything.coat = 0.7;
    everything.coat_alpha = 0.25;
    everything.coat_normal = glm::normalize(glm::dvec3(0.1, -0.2, 1.0));
    everything.normal = glm::normalize(glm::dvec3(-0.15, 0.1, 1.0));
    Bsdf velvet = plastic;
    velvet.sheen_color = {0.7, 0.3, 0.5};
    velvet.sheen_alpha = 0.16;
    everything.sheen_color = {0.2, 0.4, 0.3};
    everything.sheen_alpha = 0.5;
    Bsdf everything_inside = everything;
    everything_inside.front = false;
    return {{"lambert", lambert}, {"metal", metal},           {"plastic", plastic},
            {"velvet", velvet},   {"frosted", frosted},       {"frosted inside", frosted_inside},
            {"pane", pane},       {"everything", everything}, {"everything inside", everything_inside}};
}

glm::dvec3 on_sphere(std::mt19937_64& random) {
    const double z = 1.0 - 2.0 * uniform(random), angle = 2.0 * pi * uniform(random);
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

glm::dvec3 above(std::mt19937_64& random) {
    const glm::dvec3 w = on_sphere(random);
    return {w.x, w.y, std::abs(w.z)};
}

/// Midpoint rule over the sphere in polar angle and azimuth.
template <typename Function> auto over_sphere(const Function& function, int steps) {
    decltype(function(glm::dvec3())) sum{};
    for (int i = 0; i < steps; ++i) {
        const double polar = pi * (i + 0.5) / steps, radius = std::sin(polar);
        for (int j = 0; j < steps; ++j) {
            const double azimuth = 2.0 * pi * (j + 0.5) / steps;
            sum += radius * function({radius * std::cos(azimuth), radius * std::sin(azimuth), std::cos(polar)});
        }
    }
    return sum * (2.0 * pi * pi / (double(steps) * steps));
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance, const std::string& what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], tolerance) << what << ", channel " << c;
}

const glm::dvec3 slanted[] = {glm::normalize(glm::dvec3(0.1, 0.05, 1.0)), glm::normalize(glm::dvec3(-0.8, 0.3, 0.6)),
                              glm::normalize(glm::dvec3(0.5, 0.9, 0.25))};

/// The same surface as seen by light that arrives along wi.
Bsdf seen_from(const Bsdf& bsdf, const glm::dvec3& wi) {
    Bsdf other = bsdf;
    if (wi.z < 0.0) {
        for (glm::dvec3* normal : {&other.normal, &other.coat_normal, &other.geometric_normal}) *normal = -*normal;
        other.front = !bsdf.front;
    }
    return other;
}

TEST(OracleBsdf, Reciprocal) {
    std::mt19937_64 random(1);
    for (const auto& [name, bsdf] : cases()) {
        int counted = 0;
        for (int i = 0; i < 4000; ++i) {
            const glm::dvec3 wo = above(random), wi = on_sphere(random);
            const Bsdf other = seen_from(bsdf, wi);
            const bool refracted = wi.z < 0.0 && !bsdf.thin;
            const double ratio = refracted ? (bsdf.front ? 1.0 / bsdf.ior : bsdf.ior) : 1.0;  // eta_o / eta_i
            for (const Lobe lobe : all_lobes) {
                Bsdf forth = bsdf, back = other;
                if (lobe == Lobe::transmission) {
                    forth.coat = back.coat = 0.0;  // it dims transmission by |n.wo|, which knows one side only
                }
                const glm::dvec3 there = forth.evaluate(lobe, wo, wi), here = back.evaluate(lobe, wi, wo);
                // Shading normals let a lobe see one of the directions only: those pairs say nothing.
                const bool one_sided = glm::dot(wo, bsdf.normal) <= 0.0 || glm::dot(wo, bsdf.coat_normal) <= 0.0 ||
                                       glm::dot(wi, bsdf.normal) * wi.z <= 0.0 ||
                                       glm::dot(wi, bsdf.coat_normal) * wi.z <= 0.0;
                if (one_sided) continue;
                counted += there.x > 0.0;
                expect_near(there * ratio * ratio, here, 1e-9 * std::max(1e-3, there.x), name);
            }
        }
        EXPECT_GT(counted, 1000) << name;
    }
}

TEST(OracleBsdf, DensityIntegratesToWhatSamplingKeeps) {
    std::mt19937_64 random(2);
    constexpr int samples = 100000;
    for (const auto& [name, bsdf] : cases()) {
        for (const glm::dvec3& wo : slanted) {
            const double kept = over_sphere([&](const glm::dvec3& wi) { return bsdf.pdf(wo, wi); }, 400);
            int found = 0;
            for (int i = 0; i < samples; ++i) found += bsdf.sample(wo, random).has_value();
            const double share = double(found) / samples;
            EXPECT_NEAR(kept, share, 4.0 * std::sqrt(share * (1.0 - share) / samples) + 1e-3) << name << " " << wo.z;
            if (name == "lambert" || name == "pane") {
                EXPECT_GT(kept, name == "lambert" ? 0.9999 : 0.7) << name;
            }
        }
    }
}

TEST(OracleBsdf, DensityOfAnUprightLobe) {
    // Seen along the normal the half vectors are those of D (n.h): steeper than 45 degrees, alpha^2 / (1 + alpha^2) of
    // them, they send light below the surface.
    Bsdf metal;
    metal.metallic = 1.0;
    for (const double alpha : {0.2, 0.5}) {
        metal.alpha = alpha;
        const double sum =
            over_sphere([&](const glm::dvec3& wi) { return metal.pdf(glm::dvec3(0.0, 0.0, 1.0), wi); }, 1000);
        EXPECT_NEAR(sum, 1.0 / (1.0 + alpha * alpha), 1e-4) << alpha;
    }
}

TEST(OracleBsdf, SamplesFallAsTheDensitySays) {
    // Mean of a test function that is not symmetric in any way, by samples and by the density.
    std::mt19937_64 random(3);
    constexpr int samples = 100000;
    const auto probe = [](const glm::dvec3& w) { return 1.0 + w.x + 0.5 * w.y * w.z + w.z * w.z; };
    for (const auto& [name, bsdf] : cases()) {
        for (const glm::dvec3& wo : slanted) {
            const double expected =
                over_sphere([&](const glm::dvec3& wi) { return bsdf.pdf(wo, wi) * probe(wi); }, 400);
            double sum = 0.0, squares = 0.0;
            for (int i = 0; i < samples; ++i) {
                if (const auto sample = bsdf.sample(wo, random)) {
                    ASSERT_NEAR(sample->pdf, bsdf.pdf(wo, sample->direction), 1e-9 * sample->pdf) << name;
                    sum += probe(sample->direction);
                    squares += probe(sample->direction) * probe(sample->direction);
                }
            }
            const double mean = sum / samples;
            const double error = std::sqrt((squares / samples - mean * mean) / samples);
            EXPECT_NEAR(mean, expected, 4.5 * error + 1e-3) << name << " " << wo.z;
        }
    }
}

TEST(OracleBsdf, MeanWeightOfSamplesIsTheAlbedo) {
    std::mt19937_64 random(4);
    constexpr int samples = 50000;
    for (const auto& [name, bsdf] : cases()) {
        for (const glm::dvec3& wo : slanted) {
            const glm::dvec3 albedo = bsdf.directional_albedo(wo);
            const glm::dvec3 plain =
                over_sphere([&](const glm::dvec3& wi) { return bsdf.evaluate_cosine(wo, wi); }, 400);
            expect_near(albedo, plain, 2e-3, name + ", two quadratures");
            glm::dvec3 sum(0.0), squares(0.0);
            for (int i = 0; i < samples; ++i) {
                if (const auto sample = bsdf.sample(wo, random)) {
                    sum += sample->weight;
                    squares += sample->weight * sample->weight;
                }
            }
            const glm::dvec3 mean = sum / double(samples);
            const glm::dvec3 variance = glm::max(glm::dvec3(0.0), squares / double(samples) - mean * mean);
            const glm::dvec3 error = glm::sqrt(variance / double(samples));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(mean[c], albedo[c], 4.5 * error[c] + 5e-4)
                    << name << ", wo.z " << wo.z << ", channel " << c;
            }
        }
    }
}

TEST(OracleBsdf, NeverCreatesEnergyWithoutADiffuseBase) {
    // With one it does: glTF's base under a coat loses what the coat reflects at h, not all that it reflects.
    for (auto [name, bsdf] : cases()) {
        bsdf.base_color = bsdf.specular_color = glm::dvec3(1.0);
        if (bsdf.metallic < 1.0) bsdf.transmission = 1.0;
        for (const glm::dvec3& wo : slanted) {
            EXPECT_LE(bsdf.directional_albedo(wo).x, 1.0 + 1e-6) << name << ", wo.z " << wo.z;
        }
    }
}

TEST(OracleBsdf, MaskingIsSmithsWithCorrelatedHeights) {
    // f = D / (4 |n.wo| |n.wi| (1 + L(wo) + L(wi))), L = (sqrt(1 + alpha^2 tan^2) - 1) / 2, where F = 1.
    Bsdf metal;
    metal.metallic = 1.0;
    metal.alpha = 0.5;
    const auto lambda = [](const glm::dvec3& w) {
        return (std::sqrt(1.0 + 0.25 * (1.0 - w.z * w.z) / (w.z * w.z)) - 1.0) / 2.0;
    };
    for (const glm::dvec3& wo : slanted) {
        for (const glm::dvec3& wi : slanted) {
            const double cosine = glm::normalize(wo + wi).z;
            const double d = 0.25 / (pi * std::pow(cosine * cosine * (0.25 - 1.0) + 1.0, 2));
            const double expected = d / (4.0 * wo.z * wi.z * (1.0 + lambda(wo) + lambda(wi)));
            expect_near(metal.evaluate(wo, wi), glm::dvec3(expected), 1e-12 * expected, "GGX");
        }
    }
}

TEST(OracleBsdf, LambertReflectsItsBaseColour) {
    const Bsdf bsdf = cases().front().bsdf;
    for (const glm::dvec3& wo : slanted) {
        expect_near(bsdf.directional_albedo(wo), bsdf.base_color, 1e-12, "furnace");
        expect_near(bsdf.evaluate(wo, slanted[1]), bsdf.base_color / pi, 1e-15, "constant");
    }
}

TEST(OracleBsdf, SmoothGlassKeepsAllLight) {
    for (const bool thin : {false, true}) {
        for (const bool front : {false, true}) {
            Bsdf bsdf;
            bsdf.transmission = 1.0;
            bsdf.alpha = 0.0;
            bsdf.thin = thin;
            bsdf.front = front;
            for (const glm::dvec3& wo : slanted) {
                expect_near(bsdf.directional_albedo(wo), glm::dvec3(1.0), 1e-12, "glass");
                EXPECT_EQ(bsdf.pdf(wo, slanted[0]), 0.0);
            }
        }
    }
}

TEST(OracleBsdf, GlassRefractsBySnell) {
    Bsdf bsdf;
    bsdf.transmission = 1.0;
    bsdf.alpha = 0.0;
    bsdf.thin = false;
    for (const bool front : {true, false}) {
        bsdf.front = front;
        const double sine = 0.4, expected = front ? sine / 1.5 : sine * 1.5;
        const auto deltas = bsdf.delta_lobes({sine, 0.0, std::sqrt(1.0 - sine * sine)});
        ASSERT_EQ(deltas.size(), 2u);
        EXPECT_EQ(deltas[1].lobe, Lobe::transmission);
        expect_near(deltas[1].direction, {-expected, 0.0, -std::sqrt(1.0 - expected * expected)}, 1e-14, "Snell");
    }
    const auto total = bsdf.delta_lobes({0.9, 0.0, std::sqrt(0.19)});
    ASSERT_EQ(total.size(), 1u) << "total reflection from inside";
    expect_near(total[0].weight, glm::dvec3(1.0), 0.0, "total reflection");
}

TEST(OracleBsdf, GlassOfIndexOneIsInvisible) {
    for (const double alpha : {0.0, 0.3}) {
        Bsdf bsdf;
        bsdf.transmission = 1.0;
        bsdf.ior = bsdf.refraction_ior = 1.0;
        bsdf.alpha = alpha;
        bsdf.thin = false;
        for (const glm::dvec3& wo : slanted) {
            const auto deltas = bsdf.delta_lobes(wo);
            ASSERT_EQ(deltas.size(), 1u) << "alpha " << alpha;
            expect_near(deltas[0].direction, -wo, 1e-15, "straight on");
            expect_near(deltas[0].weight, glm::dvec3(1.0), 0.0, "whole");
            expect_near(bsdf.directional_albedo(wo, 16), glm::dvec3(1.0), 1e-15, "nothing else");
        }
        bsdf.ior = bsdf.refraction_ior = 1.0001;
        bsdf.alpha = 0.3;
        expect_near(bsdf.directional_albedo(slanted[0]), glm::dvec3(1.0), 2e-3, "the limit of rough glass");
    }
}

TEST(OracleBsdf, SmallAlphaIsTheDelta) {
    // Light from directions near the mirrored and the refracted one, weighted by a function of the direction.
    const auto probe = [](const glm::dvec3& w) { return 1.0 + w.x + 0.5 * w.y + 0.25 * w.z; };
    for (const auto& [name, rough] : cases()) {
        if (name == "lambert") continue;
        Bsdf nearly = rough, delta = rough;
        nearly.alpha = 1e-4;
        delta.alpha = 0.0;
        if (rough.coat > 0.0) {
            nearly.coat_alpha = 1e-4;
            delta.coat_alpha = 0.0;
        }
        for (const glm::dvec3& wo : {slanted[0], slanted[1]}) {
            expect_near(nearly.directional_albedo(wo), delta.directional_albedo(wo), 1e-3, name + ", albedo");
            std::mt19937_64 random(5);
            constexpr int samples = 60000;
            glm::dvec3 near_sum(0.0), delta_sum(0.0);
            for (int i = 0; i < samples; ++i) {
                if (const auto sample = nearly.sample(wo, random)) {
                    near_sum += sample->weight * probe(sample->direction) / double(samples);
                }
                if (const auto sample = delta.sample(wo, random)) {
                    delta_sum += sample->weight * probe(sample->direction) / double(samples);
                }
            }
            expect_near(near_sum, delta_sum, 0.02, name + ", directions");
        }
    }
}

TEST(OracleBsdf, RoughThinPaneTransmitsWhatItDoesNotReflect) {
    // D V of both lobes is the same and F splits it: together a white conductor, whose albedo does not depend on F.
    Bsdf pane, conductor;
    pane.transmission = 1.0;
    conductor.metallic = 1.0;
    pane.alpha = conductor.alpha = 0.4;
    for (const glm::dvec3& wo : slanted) {
        expect_near(pane.directional_albedo(wo), conductor.directional_albedo(wo), 1e-9, "pane");
    }
}

TEST(OracleBsdf, InfiniteIndexReflectsAll) {
    Bsdf bsdf;
    bsdf.ior = bsdf.refraction_ior = 0.0;
    bsdf.alpha = 0.0;
    for (const double transmission : {0.0, 1.0}) {
        bsdf.transmission = transmission;
        const auto deltas = bsdf.delta_lobes(slanted[1]);
        ASSERT_EQ(deltas.size(), 1u);
        EXPECT_EQ(deltas[0].lobe, Lobe::reflection);
        expect_near(deltas[0].weight, glm::dvec3(1.0), 1e-15, "reflectance 1");
        expect_near(bsdf.directional_albedo(slanted[1], 16), glm::dvec3(1.0), 1e-15, "nothing is left for the base");
    }
}

TEST(OracleBsdf, CoatTakesItsShareOfTheBase) {
    Bsdf bsdf = cases().front().bsdf;
    bsdf.coat = 1.0;
    bsdf.coat_alpha = 0.0;
    const glm::dvec3 up(0.0, 0.0, 1.0);
    // All pairs of wo = n: |wo.h| = cos(theta / 2), cos-weighted over the hemisphere by the midpoint rule.
    double below = 0.0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double cosine = std::sqrt((i + 0.5) / steps);
        below += (1.0 - fresnel_schlick(glm::dvec3(0.04), 1.0, std::sqrt((1.0 + cosine) / 2.0)).x) / steps;
    }
    expect_near(bsdf.directional_albedo(up), bsdf.base_color * below + 0.04, 1e-6, "coated Lambert");
}

TEST(OracleFilm, IsItsBaseWhereThereIsNone) {
    // Without thickness, or of index 1, at normal incidence, where faces reflect by their indices alone.
    for (const double f0 : {0.0, 0.04, 0.3, 0.9}) {
        for (const double index : {1.0, 1.3, 2.5}) {
            const glm::dvec3 thin = fresnel_film(glm::dvec3(f0), 1.0, index, 0.0, endless);
            expect_near(thin, glm::dvec3(f0), 1e-12, fmt::format("f0 {}, index {}", f0, index));
        }
        expect_near(fresnel_film(glm::dvec3(f0), 1.0, 1.0, 300.0, endless), glm::dvec3(f0), 1e-12, "index 1");
    }
}

TEST(OracleFilm, ThickFilmsReflectAsFacesThatDoNotInterfere) {
    // R1 + (1 - R1)^2 R2 / (1 - R1 R2) of two faces.
    const double outer = std::pow(0.5 / 2.5, 2), base = (1.0 + 0.5) / (1.0 - 0.5);
    const double inner = std::pow((base - 1.5) / (base + 1.5), 2);
    const double sum = outer + (1.0 - outer) * (1.0 - outer) * inner / (1.0 - outer * inner);
    expect_near(fresnel_film(glm::dvec3(0.25), 1.0, 1.5, 3500.0), glm::dvec3(sum), 1e-4, "3.5 micrometres");
}

TEST(OracleFilm, QuarterWavesReflectNothingOfTheirColour) {
    // Of index sqrt(n) over a base of index n and a quarter of a green wave thick: a blooming of lenses, magenta.
    const glm::dvec3 f0(std::pow(0.7 / 2.7, 2));
    const glm::dvec3 r = fresnel_film(f0, 1.0, std::sqrt(1.7), 550.0 / 4.0 / std::sqrt(1.7));
    EXPECT_LT(r.g, 0.02 * f0.g);
    EXPECT_GT(r.r, 2.0 * r.g);
    EXPECT_GT(r.b, 2.0 * r.g);
}

TEST(OracleFilm, FewOrdersAreNearlyAll) {
    const auto error = [](double f0, double least_cosine) {
        double most = 0.0;
        for (double cosine = least_cosine; cosine <= 1.0; cosine += 0.02) {
            for (const double thickness : {0.0, 50.0, 100.0, 200.0, 400.0, 800.0}) {
                const glm::dvec3 all = fresnel_film(glm::dvec3(f0), cosine, 1.3, thickness, endless);
                const glm::dvec3 off = glm::abs(fresnel_film(glm::dvec3(f0), cosine, 1.3, thickness) - all);
                most = std::max({most, off.x, off.y, off.z});
            }
        }
        return most;
    };
    EXPECT_LT(error(0.04, 0.0), 1e-4);
    EXPECT_LT(error(0.6, 0.3), 5e-3);
    EXPECT_LT(error(0.95, 0.3), 5e-3);
    EXPECT_LT(error(0.95, 0.0), 0.2) << "of metals at grazing angles";
}

/// The largest of a function over cosines at which a surface is seen, crowded at grazing ones.
template <typename Function> double most_over_cosines(const Function& function) {
    double most = 0.0;
    for (double root = 0.025; root <= 1.0; root += 0.05) most = std::max(most, function(root * root));
    return most;
}

TEST(OracleSheen, ReflectsItsAlbedoAndNoMoreThanArrives) {
    Bsdf velvet;
    velvet.base_color = glm::dvec3(0.0);
    velvet.specular = 0.0;
    velvet.sheen_color = glm::dvec3(1.0);
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        velvet.sheen_alpha = roughness * roughness;
        const double off = most_over_cosines([&](double c) {
            const double sum = velvet.directional_albedo({std::sqrt(1.0 - c * c), 0.0, c}, 200).x;
            EXPECT_LE(sum, 1.0) << "roughness " << roughness << ", cosine " << c;
            // Where a direction of light is brought down, too, there is less.
            return roughness < 0.25 ? 0.0 : std::abs(sum - sheen_albedo(c, velvet.sheen_alpha));
        });
        EXPECT_LT(off, 2e-4) << "roughness " << roughness;
    }
}

TEST(OracleSheen, FurnaceLosesWhatTheScalingTakesTwice) {
    // White over white: E(o) of the sheen, and 2 c (1 - max(E(o), E(c))) of the base over the cosines c.
    Bsdf white;
    white.specular = 0.0;
    white.sheen_color = glm::dvec3(1.0);
    for (const double roughness : {0.3, 0.6, 1.0}) {
        white.sheen_alpha = roughness * roughness;
        const double off = most_over_cosines([&](double c) {
            const double seen = sheen_albedo(c, white.sheen_alpha);
            double base = 0.0;
            constexpr int steps = 2000;
            for (int i = 0; i < steps; ++i) {
                const double at = (i + 0.5) / steps;
                base += 2.0 * at * (1.0 - std::max(seen, sheen_albedo(at, white.sheen_alpha))) / steps;
            }
            const double sum = white.directional_albedo({std::sqrt(1.0 - c * c), 0.0, c}, 200).x;
            EXPECT_LT(sum, 1.0 + 2e-4) << "roughness " << roughness << ", cosine " << c;
            return std::abs(sum - (seen + base));
        });
        EXPECT_LT(off, 2e-4) << "roughness " << roughness;
    }
}

TEST(OracleBsdf, TiltedCoatReflectsAboutItsOwnNormal) {
    Bsdf bsdf = cases().front().bsdf;
    bsdf.coat = 1.0;
    bsdf.coat_alpha = 0.0;
    bsdf.coat_normal = glm::normalize(glm::dvec3(1.0, 0.0, 3.0));
    const auto deltas = bsdf.delta_lobes({0.0, 0.0, 1.0});
    ASSERT_EQ(deltas.size(), 1u);
    expect_near(deltas[0].direction, {0.6, 0.0, 0.8}, 1e-15, "twice the tilt");
}

TEST(OracleDispersion, HasTheAbbeNumber) {
    for (const double dispersion : {0.0, 0.3, 1.0}) {
        const double spread = ior_at(1.5, dispersion, 486.1) - ior_at(1.5, dispersion, 656.3);
        EXPECT_NEAR(spread, 0.5 * dispersion / 20.0, 1e-15);
        EXPECT_NEAR(ior_at(1.5, dispersion, 587.6), 1.5, 1e-15);
    }
}

TEST(OracleDispersion, WavelengthsAddUpToWhite) {
    glm::dvec3 sum(0.0);
    constexpr int steps = 3000;
    for (int i = 0; i < steps; ++i) {
        sum += wavelength_color(400.0 + (i + 0.5) * 300.0 / steps) / double(steps);
    }
    expect_near(sum, glm::dvec3(1.0), 1e-6, "mean colour");
    EXPECT_EQ(wavelength_color(450.0).x, 0.0);
    EXPECT_EQ(wavelength_color(650.0).z, 0.0);
    EXPECT_NEAR(wavelength_color(500.0).y, wavelength_color(500.0).z * 0.875, 1e-12) << "half way between two peaks";
}

}  // namespace
}  // namespace vkcppm::oracle
