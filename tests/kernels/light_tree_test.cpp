// Lamps that a kernel chooses down the light tree, against their probabilities in double precision.

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "flat/light_tree.h"
#include "kernels/probe.h"
#include "oracle/light_tree.h"
#include "support/device/gpu.h"
#include "support/scenes/lamps.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t light_tree_words[] = {
#include "light_tree.spv.inc"
};

class LightTreeOnDevice : public GpuTest {
protected:
    std::vector<gpu::LampOutput> run(const FlatScene& flat, const std::vector<gpu::LampInput>& inputs) {
        probe_.input(Binding::light_tree, flat.light_tree);
        probe_.input(Binding::lamps, flat.lamps);
        probe_.input(PROBE_INPUT, inputs);
        probe_.output<gpu::LampOutput>(PROBE_OUTPUT, inputs.size());
        probe_.run(inputs.size(),
                   {.iteration = 0, .argument = flat.asked[0].depth, .items = std::uint32_t(inputs.size())});
        return probe_.result<gpu::LampOutput>(PROBE_OUTPUT, inputs.size());
    }

    Probe probe_{"light_tree", light_tree_words};
};

std::map<std::uint32_t, std::uint32_t> lamp_by_first(const FlatScene& flat) {
    std::map<std::uint32_t, std::uint32_t> lamps;
    for (std::uint32_t i = 0; i < 2 * flat.light_tree.size(); ++i) {
        if (flat.light_tree[i / 2].count[i % 2] > 0) lamps[flat.light_tree[i / 2].first[i % 2]] = i;
    }
    return lamps;
}

// Cosines lose digits in floats where a lamp is seen nearly edge on: 1e-4 of the probability there.
TEST_F(LightTreeOnDevice, HasTheProbabilitiesOfDoublePrecision) {
    const FlatScene flat = flatten(lamps_of_every_kind(200, 6.0, 5));
    const auto lamps = lamp_by_first(flat);
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(-0.6f, 0.6f);
    std::vector<gpu::LampInput> inputs;
    for (int i = 0; i < 50; ++i) {
        const glm::vec3 position(uniform(random), uniform(random), uniform(random));
        for (const auto& [first, lamp] : lamps) {
            inputs.push_back({position, lamp, std::uint32_t(random()), {0.5f, 0.5f}});
        }
    }
    const auto outputs = run(flat, inputs);
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double want = oracle::lamp_probability(flat.light_tree, inputs[i].lamp, glm::dvec3(inputs[i].position));
        ASSERT_NEAR(outputs[i].of_input, want, 2e-3 * want + 1e-7) << "lamp " << inputs[i].lamp << ", input " << i;
        if (outputs[i].count == 0) continue;
        ++chosen;
        const double of_chosen =
            oracle::lamp_probability(flat.light_tree, lamps.at(outputs[i].first), glm::dvec3(inputs[i].position));
        ASSERT_NEAR(outputs[i].probability, of_chosen, 2e-3 * of_chosen + 1e-7) << "input " << i;
    }
    EXPECT_GT(chosen, inputs.size() / 2);
}

// Equidistributed words choose each lamp so often as they must, but for the two at its ends, and what they have left is
// equidistributed. Random words choose them by their probability.
TEST_F(LightTreeOnDevice, ChoosesLampsByTheirProbability) {
    const FlatScene flat = flatten(lamps_of_every_kind(60, 1.0, 7));
    const auto lamps = lamp_by_first(flat);
    constexpr std::uint32_t samples = 1u << 16;
    std::mt19937 random(8);
    for (const bool even : {true, false}) {
        std::vector<gpu::LampInput> inputs;
        for (std::uint32_t i = 0; i < samples; ++i) {
            const std::uint32_t word = even ? i << 16 | 0x8000u : std::uint32_t(random());
            inputs.push_back({{0.1f, -0.2f, 0.05f}, 0, word, {float(random() >> 8) / 16777216.0f, 0.5f}});
        }
        const auto outputs = run(flat, inputs);
        std::map<std::uint32_t, std::uint64_t> counts;
        std::vector<std::uint64_t> rest(64);
        for (const auto& output : outputs) {
            if (output.count == 0) continue;
            ++counts[output.first];
            ++rest[output.word >> 26];
        }
        std::vector<std::uint64_t> observed;
        std::vector<double> wanted;
        std::uint64_t found = 0;
        double sum = 0.0;
        for (const auto& [first, lamp] : lamps) {
            const double p = oracle::lamp_probability(flat.light_tree, lamp, glm::dvec3(inputs[0].position));
            if (even) {
                EXPECT_NEAR(double(counts[first]), samples * p, 1.5 + 1e-4 * samples * p) << "lamp " << lamp;
            }
            observed.push_back(counts[first]);
            found += counts[first];
            wanted.push_back(p);
            sum += p;
        }
        observed.push_back(samples - found);
        wanted.push_back(std::max(0.0, 1.0 - sum));
        if (even) {
            for (const std::uint64_t n : rest) EXPECT_NEAR(double(n), double(found) / 64.0, double(lamps.size()));
        } else {
            expect_density("lamps", chi_squared(observed, wanted), 1e-4);
            expect_density("what is left of words", chi_squared_uniform(rest), 1e-4);
        }
    }
}

// Of a million lamps in a row each has its turn, though words of 32 bits and floats know less.
TEST_F(LightTreeOnDevice, LeavesWordsFineAmongManyLamps) {
    std::vector<Lamp> lamps(1u << 20);
    for (std::uint32_t i = 0; i < lamps.size(); ++i) {
        lamps[i].first = i;
        lamps[i].count = 1;
        lamps[i].low = lamps[i].high = {float(i) / float(lamps.size()) - 0.5f, 0.0f, 0.0f};
        lamps[i].spread = 3.2f;
        lamps[i].reach = FAR;
        lamps[i].intensity = 1.0;
    }
    const LightTree tree = build_light_tree(lamps);
    FlatScene flat;
    flat.light_tree = tree.branches;
    flat.lamps = {NO_LAMP};
    flat.asked.push_back({0, 0, 1, tree.depth});
    constexpr std::uint32_t samples = 1u << 16;
    std::mt19937 random(9);
    std::vector<gpu::LampInput> inputs;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto number = [&] { return float(random() >> 8) / 16777216.0f; };
        const float v = number();
        inputs.push_back({{0.0f, 50.0f, 0.0f}, 0, std::uint32_t(random()), {v, number()}});
    }
    const auto outputs = run(flat, inputs);
    std::vector<std::uint64_t> places(64), words(64);
    for (const auto& output : outputs) {
        ++places[output.first >> 14];
        ++words[output.word >> 26];
    }
    // Seen from so far all are as likely, to a hundredth.
    std::vector<double> wanted(64, 1.0 / 64.0);
    expect_density("places", chi_squared(places, wanted), 1e-4);
    expect_density("what is left of words", chi_squared_uniform(words), 1e-4);
}

}  // namespace
}  // namespace vkcppm::test
