// Jobs of many machines through the program: plan, render-shard, merge, status.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "io/exr.h"
#include "support/files/files.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace test;

class ManyMachines : public ProgramTest {
protected:
    /// 8 iterations of the pilot and, of 28, five slices of 4.
    static Words plan_words(const std::string& job, Words more = {}, const char* iterations = "28") {
        Words words{"plan", scene("slab_floor"), "-o", job,       "--size", "32x24",  "--photons",
                    "500",  "--pilot",           "8",  "--slice", "4",      "--quiet"};
        words.insert(words.end(), {"--iterations", iterations});
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    void plan(const std::string& job, Words more = {}, const char* iterations = "28") const {
        expect_done(run(plan_words(job, std::move(more), iterations)));
    }
    ProcessResult shard(const std::string& job, const std::string& which) const {
        return run({"render-shard", job, "--shard", which, "--quiet"});
    }
    ProcessResult merge(const std::string& job, const std::string& out, Words more = {}) const {
        more.insert(more.begin(), {"merge", job, "-o", out});
        return run(more);
    }
    std::string bytes(const std::string& name) const { return read_bytes(folder_ / name); }
    void copy(const std::string& from, const std::string& to) const {
        fs::copy(folder_ / from, folder_ / to, fs::copy_options::overwrite_existing | fs::copy_options::recursive);
    }
    std::string attribute(const std::string& file, const std::string& name) const {
        for (const auto& [key, value] : read_exr_attributes(folder_ / file)) {
            if (key == "vkcppm." + name) return value;
        }
        return "";
    }
};

TEST_F(ManyMachines, TheSameBitsForAnyNumberOfShardsInAnyOrder) {
    plan("one", {"--aovs", "--error"});
    for (const char* name : {"two", "five"}) copy("one", name);
    expect_done(shard("one", "1/1"));
    for (const char* which : {"2/2", "1/2"}) expect_done(shard("two", which));
    for (const char* which : {"4/5", "2/5", "5/5", "1/5", "3/5"}) expect_done(shard("five", which));
    for (const char* name : {"one", "two", "five"}) {
        expect_done(merge(name, fmt::format("{}.exr", name), {"--complete", "--quiet"}));
    }
    EXPECT_TRUE(bytes("one.exr") == bytes("two.exr"));
    EXPECT_TRUE(bytes("one.exr") == bytes("five.exr"));
    EXPECT_EQ(attribute("one.exr", "iterations_done"), "28");
    EXPECT_EQ(attribute("one.exr", "emitted_photons"), std::to_string(28 * 500));
    EXPECT_FALSE(attribute("one.exr", "expected_relmse").empty());
    // All channels of a render, and the layers sum to the picture.
    expect_done(run({scene("slab_floor"), "-o", "plain.exr", "--size", "32x24", "--photons", "500", "--iterations",
                     "28", "--aovs", "--error", "--quiet"}));
    const ExrChannels merged = read_exr_channels(folder_ / "one.exr", "");
    const ExrChannels plain = read_exr_channels(folder_ / "plain.exr", "");
    ASSERT_EQ(merged.values.size(), plain.values.size());
    for (const auto& [name, channel] : plain.values) EXPECT_TRUE(merged.values.contains(name)) << name;
    EXPECT_EQ(merged.values.at("Albedo.R"), plain.values.at("Albedo.R"));
    for (std::size_t i = 0; i < merged.extent.pixels(); ++i) {
        double layers = 0.0;
        for (const char* layer : {"direct.R", "caustic.R", "rest.R"}) layers += merged.values.at(layer)[i];
        EXPECT_NEAR(merged.values.at("R")[i], layers, 1e-5 * layers);
    }
}

// Pictures of fewer slices are means over fewer iterations, so that they tell what each slice has added.
TEST_F(ManyMachines, WhatIsMissingIsToldAndTheRestIsAdded) {
    plan("job", {"--shards", "2"});
    expect_done(shard("job", "1/1"));
    const std::vector<Words> subsets = {{}, {"2"}, {"2", "5"}, {"2", "3", "4", "5"}, {"1", "2", "3", "4", "5"}};
    std::map<std::string, Image> pictures;
    std::map<std::string, double> iterations;
    for (const Words& gone : subsets) {
        const std::string name = fmt::format("{}gone", gone.size());
        copy("job", name);
        for (const std::string& number : gone) fs::remove(folder_ / name / fmt::format("slice_000{}.sums", number));
        const ProcessResult result = merge(name, name + ".exr");
        expect_done(result);
        for (const std::string& number : gone) {
            const std::string told =
                fmt::format("slice {} (iterations {}..{}) of shard {}/2 is missing", number, 4 + 4 * std::stoi(number),
                            7 + 4 * std::stoi(number), (std::stoi(number) - 1) % 2 + 1);
            EXPECT_TRUE(contains(result.err, told)) << told << " is not in: " << result.err;
        }
        if (!gone.empty()) {
            expect_failure(merge(name, "none.exr", {"--complete"}), 66, {"slice " + gone.front(), "is missing"},
                           "--complete");
            EXPECT_FALSE(fs::exists(folder_ / "none.exr"));
        }
        pictures[name] = read_exr(folder_ / (name + ".exr"));
        iterations[name] = std::stod(attribute(name + ".exr", "iterations_done"));
        EXPECT_EQ(iterations[name], 28.0 - 4.0 * double(gone.size()));
        expect_done(run({"status", name}));
    }
    // Without 2 and 5 less without 2 is what 5 has added, and so on: slice 2 from all, slice 5 from those without 2.
    const auto sum = [&](const std::string& name, std::size_t i) {
        return iterations.at(name) * glm::dvec3(pictures.at(name).rgb[i]);
    };
    copy("job", "five");
    fs::remove(folder_ / "five" / "slice_0005.sums");
    expect_done(merge("five", "five.exr", {"--quiet"}));
    const Image five = read_exr(folder_ / "five.exr");
    for (std::size_t i = 0; i < five.rgb.size(); ++i) {
        const glm::dvec3 wanted = sum("0gone", i) - (sum("1gone", i) - sum("2gone", i));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(24.0 * five.rgb[i][c], wanted[c], 1e-5 * wanted[c]) << "pixel " << i;
    }
    // The pilot alone is a render of as many iterations.
    expect_done(run({scene("slab_floor"), "-o", "plain.exr", "--size", "32x24", "--photons", "500", "--iterations", "8",
                     "--quiet"}));
    const Image plain = read_exr(folder_ / "plain.exr");
    for (std::size_t i = 0; i < plain.rgb.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(pictures.at("5gone").rgb[i][c], plain.rgb[i][c]) << "pixel " << i;
    }
    // What is missing is rendered again alone.
    expect_done(shard("2gone", "2/5"));
    expect_done(shard("2gone", "5/5"));
    expect_done(merge("2gone", "again.exr", {"--complete"}));
    expect_done(merge("job", "whole.exr", {"--complete"}));
    EXPECT_TRUE(bytes("again.exr") == bytes("whole.exr"));
    // No picture is one without the pilot.
    fs::remove(folder_ / "job" / "slice_0000.sums");
    expect_failure(merge("job", "none.exr"), 66, {"the pilot", "missing", "planned the job"});
    write_bytes(folder_ / "job" / "pilot.ckpt", "nothing");
    plan("job", {"--shards", "2"});
    expect_done(merge("job", "mended.exr", {"--complete"}));
    EXPECT_TRUE(bytes("mended.exr") == bytes("whole.exr"));
}

TEST_F(ManyMachines, AnotherSeedSceneOrPilotIsRefused) {
    plan("job");
    plan("other", {"--seed", "2"});
    expect_done(shard("other", "2/5"));
    fs::copy(folder_ / "other/slice_0002.sums", folder_ / "job/slice_0002.sums");
    const Words told{"slice_0002.sums is of another render", "seed: 2 in the checkpoint, 1 asked", "pilot_hash"};
    expect_failure(merge("job", "none.exr"), 2, told, "merge");
    expect_failure(shard("job", "1/1"), 2, told, "render-shard");
    expect_failure(run({"status", "job"}), 2, told, "status");
    fs::remove(folder_ / "job/slice_0002.sums");
    // Another slice by its name.
    fs::copy(folder_ / "other/slice_0002.sums", folder_ / "other/slice_0003.sums");
    expect_failure(merge("other", "none.exr"), 2, {"iterations: 12..15 in the checkpoint, 16..19 asked"}, "slice");
    // Planned again: the same is left as it is, another is told.
    const auto before = fs::last_write_time(folder_ / "job/job.json");
    plan("job");
    EXPECT_EQ(fs::last_write_time(folder_ / "job/job.json"), before);
    expect_failure(run(plan_words("job", {"--seed", "2", "--knn", "12"})), 2,
                   {"seed: 1 in the job, 2 asked", "knn: 10 in the job, 12 asked"}, "plan");
    // The scene changes between plan and shard.
    write_bytes(folder_ / "s.gltf", read_bytes(scene("slab_floor")));
    expect_done(run({"plan", "s.gltf", "-o", "moved", "--size", "16x12", "--photons", "200", "--quiet"}));
    std::string text = bytes("s.gltf");
    text.replace(text.find("0.8"), 3, "0.7");
    write_bytes(folder_ / "s.gltf", text);
    expect_failure(shard("moved", "1/99"), 2, {"moved is of another render", "scene_hash"}, "scene");
    // A job and the files about it may be moved together.
    fs::create_directory(folder_ / "there");
    fs::rename(folder_ / "moved", folder_ / "there/moved");
    write_bytes(folder_ / "there/s.gltf", read_bytes(scene("slab_floor")));
    expect_done(shard("there/moved", "12/12"));
    // Of another version, or no job.
    Json json = Json::parse(bytes("job/job.json"));
    json["version"] = "0.0.1";
    write_bytes(folder_ / "job/job.json", json.dump());
    expect_failure(shard("job", "1/1"), 2, {"job.json is of version 0.0.1, this is "}, "version");
    for (const char* broken : {"", "{}", "[1]", "{\"version\": 3}"}) {
        write_bytes(folder_ / "job/job.json", broken);
        expect_failure(shard("job", "1/1"), 65, {"job.json is no job of vkcppm"}, broken);
    }
    expect_failure(shard("none", "1/1"), 66, {"none/job.json", "vkcppm plan"}, "no job");
}

TEST_F(ManyMachines, ABrokenSliceIsToldAndRenderedAgain) {
    plan("job", {"--shards", "5"});
    expect_done(shard("job", "1/1"));
    expect_done(merge("job", "whole.exr"));
    const std::string good = bytes("job/slice_0003.sums");
    std::string flipped = good;
    flipped[good.size() / 2] ^= 1;
    for (const std::string& bad : {good.substr(0, good.size() - 1), flipped, std::string("nothing")}) {
        write_bytes(folder_ / "job/slice_0003.sums", bad);
        const ProcessResult result = merge("job", "part.exr");
        expect_done(result);
        EXPECT_TRUE(contains(result.err, "slice 3 (iterations 16..19) of shard 3/5 is broken")) << result.err;
        expect_failure(merge("job", "none.exr", {"--complete"}), 65, {"slice 3", "shard 3/5", "broken"});
        const ProcessResult status = run({"status", "job", "--json"});
        const Json json = Json::parse(status.out);
        EXPECT_EQ(json["broken"], Json({3}));
        EXPECT_EQ(json["slices_done"], 4);
        EXPECT_EQ(json["iterations_done"], 24);
        EXPECT_FALSE(json["complete"]);
        EXPECT_EQ(json["shards"][2]["slices_done"], 0);
    }
    const ProcessResult again = shard("job", "3/5");
    expect_done(again);
    EXPECT_TRUE(contains(again.err, "slice_0003.sums")) << again.err;
    expect_done(merge("job", "again.exr", {"--complete"}));
    EXPECT_TRUE(bytes("again.exr") == bytes("whole.exr"));
    EXPECT_TRUE(Json::parse(run({"status", "job", "--json"}).out)["complete"]);
    // The pilot is needed to render, not to add.
    std::string pilot = bytes("job/pilot.ckpt");
    pilot[pilot.size() / 2] ^= 1;
    write_bytes(folder_ / "job/pilot.ckpt", pilot);
    fs::remove(folder_ / "job/slice_0001.sums");
    expect_failure(shard("job", "1/1"), 65, {"pilot.ckpt", "damaged"});
}

// Killed at any moment, and two at once on the same shard.
TEST_F(ManyMachines, AWorkerThatIsKilledGoesOnAndTwoDoNoHarm) {
    plan("job");
    copy("job", "calm");
    expect_done(shard("calm", "1/1"));
    expect_done(merge("calm", "calm.exr"));
    std::mt19937 random(3);
    std::uniform_int_distribution<int> moment(0, 700'000);  // microseconds since the start of the program
    const Words words{test::program(), "render-shard", "job", "--shard", "1/1"};
    for (int kill = 0; kill < 8; ++kill) {
        Process first(words, folder_.path()), second(words, folder_.path());
        std::this_thread::sleep_for(std::chrono::microseconds(moment(random)));
        first.send(SIGKILL);
        second.send(kill % 2 == 0 ? SIGKILL : SIGTERM);
        first.wait();
        const ProcessResult ended = second.wait();
        if (kill % 2 != 0 && ended.signal == 0 && ended.exit_code != 0) {
            EXPECT_EQ(ended.exit_code, 130) << ended.err;
            EXPECT_TRUE(contains(ended.err, "the same command goes on")) << ended.err;
        }
    }
    Process first(words, folder_.path()), second(words, folder_.path());
    expect_done(first.wait());
    expect_done(second.wait());
    expect_done(merge("job", "killed.exr", {"--complete"}));
    EXPECT_TRUE(bytes("killed.exr") == bytes("calm.exr"));
}

TEST_F(ManyMachines, AJobIsExtended) {
    plan("job");
    plan("long", {}, "36");
    expect_done(shard("job", "1/1"));
    expect_done(run({"plan", "--extend", "8", "-o", "job", "--quiet"}));
    const ProcessResult status = run({"status", "job", "--json"});
    EXPECT_EQ(Json::parse(status.out)["iterations"], 36);
    EXPECT_EQ(Json::parse(status.out)["missing"], Json({6, 7}));
    expect_done(shard("job", "1/1"));
    expect_done(shard("long", "1/1"));
    expect_done(merge("job", "job.exr", {"--complete"}));
    expect_done(merge("long", "long.exr", {"--complete"}));
    EXPECT_EQ(read_exr(folder_ / "job.exr"), read_exr(folder_ / "long.exr"));
    expect_failure(run({"plan", scene("slab_floor"), "--extend", "8", "-o", "job"}), 2, {"--extend excludes SCENE"});
    expect_failure(run({"plan", "--extend", "8", "-o", "none"}), 66, {"none/job.json"});
}

TEST_F(ManyMachines, WhatCannotBeDoneIsRefusedBeforeAnyTimeIsSpent) {
    expect_failure(run({"plan", "-o", "job"}), 2, {"SCENE"});
    const Words beginning{"plan", scene("slab_floor"), "-o", "job"};
    const auto refused = [&](Words more, const Words& told) {
        more.insert(more.begin(), beginning.begin(), beginning.end());
        expect_failure(run(more), 2, told, told.front());
    };
    refused({"--iterations", "16"}, {"--iterations 16", "nothing is left to share"});
    refused({"--pilot", "7"}, {"--pilot 7 is below 8"});
    refused({"--slice", "0"}, {"--slice 0"});
    refused({"--shards", "0"}, {"--shards", "'0'"});
    refused({"--slice", "1", "--iterations", "1073741823"}, {"--slice 1", "1040187392 slices"});
    for (const char* wrong : {"0/3", "4/3", "1", "1/", "/2", "1/2x", "-1/2"}) {
        expect_failure(run({"render-shard", "job", "--shard", wrong}), 2, {"--shard", "K/N"}, wrong);
    }
    EXPECT_FALSE(fs::exists(folder_ / "job"));
    refused({"--estimator", "none"}, {"none"});
    EXPECT_FALSE(fs::exists(folder_ / "job/job.json"));
    plan("job");
    expect_failure(merge("job", "job/slice_0001.sums"), 2, {"-o"}, "an input");
    expect_failure(merge("job", "job/job.json"), 2, {"-o"}, "the job");
}

// What a plan would not have written is believed as little as any other file.
TEST_F(ManyMachines, AForgedJobIsRefused) {
    plan("job", {"--shards", "2"});
    const std::string good = bytes("job/job.json");
    const auto refused = [&](const std::function<void(Json&)>& forge, int code, const Words& told) {
        Json json = Json::parse(good);
        forge(json);
        write_bytes(folder_ / "job/job.json", json.dump());
        expect_failure(shard("job", "1/1"), code, told, told.front());
        expect_failure(merge("job", "none.exr"), code, told, told.front());
        expect_failure(run({"status", "job"}), code, told, told.front());
    };
    const auto with = [](Words words) {
        return [words](Json& json) {
            for (const std::string& word : words) json["command"].push_back(word);
        };
    };
    refused(with({"--rings", "200"}), 65, {"--rings 200", "job.json"});
    refused(with({"--sectors", "5000"}), 65, {"--sectors 5000"});
    refused(with({"--aperture", "0.1"}), 65, {"--aperture 0.1", "--focus-distance"});
    refused([](Json& json) { json["size"] = {0, 24}; }, 65, {"--size: width 0"});
    refused([](Json& json) { json["photons"] = 1u << 31; }, 65, {"--photons 2147483648"});
    refused([](Json& json) { json["ends"] = {1'000'000'000}; }, 65, {"--slice 4", "the limit is 1048576"});
    refused([](Json& json) { json["slice"] = 0; }, 65, {"out of range"});
    refused(
        [](Json& json) {
            for (Json& word : json["command"]) word = word == "2" ? "0" : word;
        },
        2, {"--shards"});
    write_bytes(folder_ / "job/job.json", good);
    expect_done(shard("job", "1/1"));
}

}  // namespace
}  // namespace vkcppm
