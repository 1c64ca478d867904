// What a render says of its own error, and where it ends by that, through the program.

#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "io/exr.h"
#include "support/files/files.h"

namespace vkcppm {
namespace {

using Json = nlohmann::json;
using namespace test;

class OwnError : public ProgramTest {
protected:
    ProcessResult render(Words more) const {
        Words words{scene("caustic"), "--size", "24x16", "--photons", "1000"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    std::map<std::string, std::string> attributes(const std::string& name) const {
        const ExrAttributes all = read_exr_attributes(folder_ / name);
        return {all.begin(), all.end()};
    }
    Json stats(const std::string& name) const { return Json::parse(read_bytes(folder_ / name)); }
};

TEST_F(OwnError, IsToldAndLeavesThePictureAsItIs) {
    expect_done(render({"--iterations", "40", "-o", "plain.exr", "--quiet"}));
    const ProcessResult result =
        render({"--iterations", "40", "--error", "-o", "a.exr", "--stats", "a.json", "--verbose"});
    expect_done(result);
    EXPECT_TRUE(contains(result.err, "error of its own estimate: relmse_trimmed ")) << result.err;
    EXPECT_EQ(read_exr(folder_ / "a.exr"), read_exr(folder_ / "plain.exr"));
    for (const char* name : {"StdErr", "StdErr.8", "StdErr.64", "Bias", "Bound"}) {
        EXPECT_EQ(read_exr_channels(folder_ / "a.exr", name).values.count(name), 1u) << name;
        EXPECT_EQ(read_exr_channels(folder_ / "plain.exr", name).values.count(name), 0u) << name;
    }
    const Json estimate = stats("a.json").at("estimate");
    const auto attributes_of_picture = attributes("a.exr");
    for (const auto& [name, value] : estimate.items()) {
        EXPECT_EQ(Json::parse(attributes_of_picture.at("vkcppm." + name)), value) << name;
    }
    EXPECT_EQ(attributes_of_picture.at("vkcppm.batches"), "8");
    EXPECT_NEAR(estimate.at("expected_relmse").get<double>(),
                estimate.at("expected_relmse_noise").get<double>() + estimate.at("expected_relmse_bias").get<double>(),
                1e-9);
    EXPECT_LE(estimate.at("expected_relmse_trimmed"), estimate.at("expected_relmse"));
    EXPECT_FALSE(stats("a.json").contains("target"));
}

TEST_F(OwnError, EndsARenderAtALookWithThePictureOfThatManyIterations) {
    const ProcessResult result = render({"--target", "noise=3%", "-o", "a.exr", "--stats", "a.json"});
    expect_done(result);
    EXPECT_TRUE(contains(result.err, "--target noise=0.03 was reached")) << result.err;
    const Json told = stats("a.json");
    EXPECT_EQ(told.at("target"), Json({{"measure", "noise"}, {"value", 0.03}, {"confidence", 0.9}, {"reached", true}}));
    const std::uint64_t done = told.at("totals").at("iterations");
    EXPECT_GT(done, 32u) << "the first look, which shows nothing of the others";
    EXPECT_LT(told.at("estimate").at("expected_noise"), 0.03);
    expect_done(render({"--iterations", std::to_string(done), "--error", "-o", "b.exr", "--quiet"}));
    EXPECT_EQ(read_exr(folder_ / "a.exr"), read_exr(folder_ / "b.exr"));
    // A higher confidence takes longer, and what is put down on the way ends in the same place.
    expect_done(render({"--target", "noise=3%", "--confidence", "99.9", "-o", "c.exr", "--quiet"}));
    EXPECT_GT(std::stoul(attributes("c.exr").at("vkcppm.iterations_done")), done);
    expect_done(
        render({"--target", "noise=3%", "--iterations", "20", "--checkpoint", "d.ckpt", "-o", "d.exr", "--quiet"}));
    expect_done(render({"--target", "noise=3%", "--resume", "d.ckpt", "-o", "d.exr", "--quiet"}));
    EXPECT_EQ(read_exr(folder_ / "a.exr"), read_exr(folder_ / "d.exr"));
    // It is there already.
    expect_done(render({"--target", "noise=3%", "--resume", "d.ckpt", "-o", "e.exr", "--quiet"}));
    EXPECT_EQ(attributes("e.exr").at("vkcppm.iterations_done"), std::to_string(done));
}

TEST_F(OwnError, SaysWhereATargetWasNotReached) {
    const auto late =
        render({"--target", "relmse=1e-9", "--iterations", "32", "-o", "a.exr", "--stats", "a.json", "--quiet"});
    expect_done(late);
    EXPECT_TRUE(contains(late.err, "--target relmse=1e-09 was not reached")) << late.err;
    EXPECT_EQ(stats("a.json").at("target").at("reached"), false);
    const auto early = render({"--target", "relmse=1e-9", "--iterations", "3", "-o", "a.exr", "--quiet"});
    expect_done(early);
    EXPECT_TRUE(contains(early.err, "--target relmse=1e-09: 3 iterations tell no error, 16 or more do")) << early.err;
    EXPECT_FALSE(attributes("a.exr").contains("vkcppm.expected_relmse"));
}

// What it is for in CI: a picture of another seed passes by statistics, one of another light does not.
TEST_F(OwnError, TellsNoiseFromADifference) {
    for (const char* seed : {"1", "2"}) {
        expect_done(
            render({"--iterations", "64", "--error", "--seed", seed, "-o", std::string(seed) + ".exr", "--quiet"}));
    }
    const ProcessResult right = run({"check", "1.exr", "2.exr"});
    EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
    Image brighter = read_exr(folder_ / "2.exr");
    ExrChannels channels = read_exr_channels(folder_ / "2.exr", "StdErr");
    for (glm::vec3& rgb : brighter.rgb) rgb *= 1.1f;
    ExrChannels all = to_channels(brighter);
    all.values.insert(channels.values.begin(), channels.values.end());
    write_exr(folder_ / "3.exr", all, {{"vkcppm.batches", "8"}});
    const ProcessResult wrong = run({"check", "1.exr", "3.exr"});
    EXPECT_EQ(wrong.exit_code, 1) << wrong.out << wrong.err;
}

}  // namespace
}  // namespace vkcppm
