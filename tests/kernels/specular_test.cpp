// Lobes of width 0: Fresnel's equations, the choice between the two lobes of a dielectric and the directions behind
// mirrors and dielectrics, against oracle/fresnel in double.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/material.h"
#include "kernels/probe.h"
#include "oracle/fresnel.h"
#include "support/device/gpu.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

constexpr std::uint32_t specular_words[] = {
#include "specular.spv.inc"
};

const std::vector<float> indices = {1.0f, 1.0001f, 1.33f, 1.5f, 2.4f};  // of the dielectrics; material i has indices[i]
const glm::vec3 tint(0.9f, 0.5f, 0.25f);
const glm::vec3 gold(1.0f, 0.78f, 0.36f);

constexpr auto reflection = std::uint32_t(Lobe::reflection), transmission = std::uint32_t(Lobe::transmission);

std::vector<gpu::SurfaceMaterial> materials() {
    std::vector<gpu::SurfaceMaterial> list;
    for (const float ior : indices) {
        gpu::SurfaceMaterial glass{};
        glass.transmission = 1.0f;
        glass.specular = 1.0f;
        glass.specular_color = glm::vec3(1.0f);
        glass.color = tint;
        glass.ior = ior;
        list.push_back(glass);
    }
    gpu::SurfaceMaterial mirror{};
    mirror.metallic = 1.0f;
    mirror.specular = 1.0f;
    mirror.specular_color = glm::vec3(1.0f);
    mirror.ior = 1.5f;
    mirror.color = gold;
    list.push_back(mirror);
    return list;
}

const std::uint32_t mirror_material = std::uint32_t(indices.size());

/// Range of the exact reflectance while cosine and ratio move by what one float rounding can do to them: near the
/// critical angle and at grazing incidence no float program can do better.
struct Range {
    double low = 1.0, high = 0.0;
};
Range reflectance_range(double cosine, double ior_ratio) {
    Range range;
    for (const double c : {-2.4e-7, 0.0, 2.4e-7}) {
        for (const double n : {-2.4e-7, 0.0, 2.4e-7}) {
            const double r = oracle::fresnel_dielectric(std::clamp(cosine + c, 0.0, 1.0), ior_ratio * (1.0 + n));
            range.low = std::min(range.low, r);
            range.high = std::max(range.high, r);
        }
    }
    return range;
}

class Specular : public GpuTest {
protected:
    std::vector<gpu::ScatterOutput> scatter(const std::vector<gpu::ScatterInput>& inputs) {
        probe_.input(Binding::materials, materials());
        probe_.input(PROBE_INPUT, inputs);
        probe_.output<gpu::ScatterOutput>(PROBE_OUTPUT, inputs.size());
        probe_.run(inputs.size(),
                   {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(inputs.size())});
        return probe_.result<gpu::ScatterOutput>(PROBE_OUTPUT, inputs.size());
    }

    Probe probe_{"specular", specular_words};
};

/// Index behind the face over that before it.
double ratio(const gpu::ScatterInput& input) {
    const double ior = input.material < mirror_material ? indices[input.material] : 1.0;
    return input.front ? ior : 1.0 / ior;
}

glm::vec3 random_unit(std::mt19937& random) {
    std::normal_distribution<float> normal;
    return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
}

/// Every material from both sides at 0 to 90 degrees, dense towards both ends and about the critical angle.
std::vector<gpu::ScatterInput> incidences() {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<gpu::ScatterInput> inputs;
    for (std::uint32_t material = 0; material <= mirror_material; ++material) {
        std::vector<double> angles;
        for (int i = 0; i < 4000; ++i) angles.push_back(0.5 * pi * i / 4000.0);
        for (int i = 0; i < 400; ++i) {
            angles.push_back(0.5 * pi - std::exp(-0.05 * i));  // grazing, down to 2e-9 rad
            angles.push_back(std::exp(-0.05 * i));
            if (material < mirror_material) {
                const double critical = std::asin(std::min(1.0, 1.0 / double(indices[material])));
                angles.push_back(std::max(0.0, critical - 0.1 * std::exp(-0.05 * i)));
                angles.push_back(std::min(0.5 * pi, critical + 0.1 * std::exp(-0.05 * i)));
            }
        }
        for (const double angle : angles) {
            if (angle < 0.0 || angle >= 0.5 * pi) continue;
            const glm::dvec3 n(random_unit(random));
            const glm::dvec3 side = glm::normalize(glm::cross(n, glm::dvec3(random_unit(random))));
            const glm::vec3 direction(glm::normalize(std::sin(angle) * side - std::cos(angle) * n));
            const glm::vec3 normal(n);
            if (!(glm::dot(direction, normal) < 0.0f)) continue;
            for (const std::uint32_t front : {0u, 1u}) {
                inputs.push_back({direction, normal, normal, uniform(random), front, material, front});
            }
        }
    }
    return inputs;
}

std::string describe(const gpu::ScatterInput& s) {
    const double cosine = -glm::dot(glm::dvec3(s.direction), glm::dvec3(s.normal));
    return fmt::format("index ratio {:.9g}, {:.6f} degrees (cosine {:.9g}), u {:.9g}", ratio(s),
                       std::acos(std::min(1.0, cosine)) * 180.0 / pi, cosine, s.u);
}

TEST_F(Specular, ReflectancesAreFresnels) {
    const auto inputs = incidences();
    const auto outputs = scatter(inputs);
    std::size_t total = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double cosine =
            std::clamp(-glm::dot(glm::dvec3(inputs[i].direction), glm::dvec3(inputs[i].normal)), 0.0, 1.0);
        const glm::dvec3 metal = oracle::fresnel_metal(gold, cosine);
        if (inputs[i].material == mirror_material) {
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(outputs[i].facet[c], metal[c], 2e-6) << describe(inputs[i]);
            continue;
        }
        const Range range = reflectance_range(cosine, ratio(inputs[i]));
        ASSERT_GE(outputs[i].reflectance, range.low - 1e-6)
            << describe(inputs[i]) << ", exact " << range.low << " to " << range.high;
        ASSERT_LE(outputs[i].reflectance, range.high + 1e-6)
            << describe(inputs[i]) << ", exact " << range.low << " to " << range.high;
        for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(outputs[i].facet[c], outputs[i].reflectance) << describe(inputs[i]) << ": glass has a coat";
        }
        if (range.low == 1.0) {
            ++total;
            ASSERT_EQ(outputs[i].cosine_t, 0.0f) << describe(inputs[i]);
        }
    }
    EXPECT_GT(total, 1000u) << "too few incidences with total reflection to mean anything";
}

TEST_F(Specular, DirectionsObeySnellAndThroughputsTheSquaredIndex) {
    const auto inputs = incidences();
    const auto outputs = scatter(inputs);
    std::size_t reflected = 0, refracted = 0, undecided = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto& in = inputs[i];
        const glm::dvec3 d(in.direction), n(in.normal), out(outputs[i].direction);
        const double cosine = -glm::dot(d, n), eta = 1.0 / ratio(in);
        ASSERT_NEAR(glm::length(out), 1.0, 1e-6) << describe(in);
        ASSERT_GT(outputs[i].density, 1e38f) << describe(in) << ": a lobe of width 0 has no finite density";
        bool reflects = true;
        Range range{1.0, 1.0}, chance{1.0, 1.0};
        if (in.material != mirror_material) {
            // Lobes are chosen in proportion to their largest channel.
            range = reflectance_range(std::clamp(cosine, 0.0, 1.0), ratio(in));
            const auto share = [](double r) { return r / (r + double(tint.x) * (1.0 - r)); };
            chance = {share(range.low), share(range.high)};
            if (in.u > chance.low - 1e-6 && in.u < chance.high + 1e-6) {
                ++undecided;
                continue;
            }
            reflects = in.u < chance.low;
        }
        ASSERT_EQ(outputs[i].lobe, reflects ? reflection : transmission)
            << describe(in) << ", reflection's chance " << chance.low;
        if (reflects) {
            ++reflected;
            ASSERT_GE(outputs[i].probability, chance.low - 1e-6) << describe(in);
            ASSERT_LE(outputs[i].probability, chance.high + 1e-6) << describe(in);
            ASSERT_LT(glm::distance(out, d + 2.0 * cosine * n), 1e-5) << describe(in);
            if (in.material == mirror_material) {
                const glm::dvec3 factor = oracle::fresnel_metal(gold, cosine);
                ASSERT_LT(glm::distance(glm::dvec3(outputs[i].factor), factor), 5e-6) << describe(in);
            } else {
                ASSERT_EQ(outputs[i].factor, glm::vec3(outputs[i].reflectance)) << describe(in);
            }
            continue;
        }
        ++refracted;
        ASSERT_GE(outputs[i].probability, 1.0 - chance.high - 1e-6) << describe(in);
        ASSERT_LE(outputs[i].probability, 1.0 - chance.low + 1e-6) << describe(in);
        // The component across the normal grows by eta; the rest is what makes it unit. Its error is that of the
        // square root: 1e-5 in the sine, more in the cosine where that is small.
        const glm::dvec3 across = d + cosine * n, out_across = out - glm::dot(out, n) * n;
        ASSERT_LT(glm::distance(out_across, eta * across), 1e-5) << describe(in);
        ASSERT_LT(glm::dot(out, n), 0.0) << describe(in) << ": refracted to its own side";
        const glm::dvec3 factor = glm::dvec3(tint) * (in.radiance ? eta * eta : 1.0);
        for (int c = 0; c < 3; ++c) {
            const double rounding = 2e-6 * std::max(1.0, eta * eta);
            ASSERT_GE(outputs[i].factor[c], factor[c] * (1.0 - range.high) - rounding) << describe(in);
            ASSERT_LE(outputs[i].factor[c], factor[c] * (1.0 - range.low) + rounding) << describe(in);
        }
    }
    EXPECT_GT(reflected, 5000u);
    EXPECT_GT(refracted, 5000u);
    EXPECT_LT(undecided, inputs.size() / 20) << "of " << inputs.size();
}

TEST_F(Specular, BentShadingNormalsNeverSendARayThroughTheSurfaceItLeft) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::vector<gpu::ScatterInput> inputs;
    while (inputs.size() < 50000) {
        const glm::vec3 geometric = random_unit(random), direction = random_unit(random);
        const glm::vec3 normal = glm::normalize(geometric + 0.8f * random_unit(random));
        if (glm::dot(direction, geometric) >= 0.0f || glm::dot(direction, normal) >= 0.0f) continue;
        const auto material = std::uint32_t(inputs.size() % (indices.size() + 1));
        inputs.push_back(
            {direction, normal, geometric, uniform(random), std::uint32_t(inputs.size() & 1), material, 0});
    }
    const auto outputs = scatter(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto& in = inputs[i];
        const double side = glm::dot(glm::dvec3(outputs[i].direction), glm::dvec3(in.geometric));
        ASSERT_NEAR(glm::length(glm::dvec3(outputs[i].direction)), 1.0, 1e-6) << describe(in);
        if (outputs[i].lobe == reflection) {
            ASSERT_GT(side, -1e-6) << describe(in) << ": reflected into the surface";
        } else {
            ASSERT_LT(side, 1e-6) << describe(in) << ": refracted to its own side";
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
