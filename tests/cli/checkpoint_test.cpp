// Renders that are ended at any moment and taken up again, through the program.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <random>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "core/fnv1a.h"
#include "io/exr.h"
#include "render/estimators.h"
#include "support/files/files.h"

namespace vkcppm {
namespace {

using Json = nlohmann::json;
using namespace test;

class Checkpoint : public ProgramTest {
protected:
    static Words words(Words more, const std::string& size = "32x24") {
        Words words{scene("slab_floor"), "--size", size, "--photons", "500"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    ProcessResult render(Words more) const { return run(words(std::move(more))); }

    std::string bytes(const std::string& name) const { return read_bytes(folder_ / name); }
    std::string done(const std::string& name) const {
        for (const auto& [key, value] : read_exr_attributes(folder_ / name)) {
            if (key == "vkcppm.iterations_done") return value;
        }
        return "";
    }
    /// The last line of --hash.
    static std::string picture_hash(const ProcessResult& result) {
        const std::vector<std::string> lines = lines_of(result.out);
        return lines.empty() ? "nothing on standard output" : lines.back();
    }
};

TEST_F(Checkpoint, EveryEstimatorGoesOnWithTheSameBytes) {
    for (const EstimatorRow& row : estimators()) {
        const std::string name(row.name);
        SCOPED_TRACE(name);
        const Words common{"--estimator", name, "--aovs", "--quiet"};
        const auto with = [&](Words more) {
            more.insert(more.end(), common.begin(), common.end());
            return render(more);
        };
        expect_done(with({"--iterations", "7", "-o", name + ".exr"}));
        expect_done(with({"--iterations", "3", "-o", "cut.exr", "--checkpoint", name + ".ckpt"}));
        expect_done(with({"--iterations", "7", "-o", "resumed.exr", "--resume", name + ".ckpt"}));
        EXPECT_TRUE(bytes(name + ".exr") == bytes("resumed.exr")) << "the files differ";
        EXPECT_FALSE(bytes(name + ".exr") == bytes("cut.exr"));
    }
}

// kill -9 at 20 moments: ten after a random time since the start of the program, ten after one since it began to write
// a checkpoint of 2 MB, which it does after every submission. Nothing is asked of the moments.
TEST_F(Checkpoint, SurvivesBeingKilledAtAnyMoment) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> since_start(0, 300'000), since_write(0, 12'000);  // microseconds
    const auto pause = [](int microseconds) { std::this_thread::sleep_for(std::chrono::microseconds(microseconds)); };
    const auto there = [&](std::string_view ending) {
        const std::set<std::string> names = names_in(folder_.path());
        return std::ranges::any_of(names, [&](const std::string& name) { return name.ends_with(ending); });
    };
    const std::string size = "160x120";
    Words next{"--checkpoint", "a.ckpt"};
    int hits_in_writing = 0;
    for (int kill = 0; kill < 20; ++kill) {
        Words all = words({"--iterations", "1073741823", "--checkpoint-every", "0.001ms", "-o", "a.exr"}, size);
        all.insert(all.begin(), test::program());
        all.insert(all.end(), next.begin(), next.end());
        Process process(all, folder_.path());
        if (kill % 2 == 0) {
            ASSERT_TRUE(process.wait_for_message(" iterations")) << process.wait().err;
            for (int i = 0; i < 20'000 && !there(kill == 0 ? ".ckpt" : ".part"); ++i) pause(50);
            pause(since_write(random));
        } else {
            pause(since_start(random));
        }
        process.send(SIGKILL);
        const ProcessResult result = process.wait();
        ASSERT_EQ(result.signal, SIGKILL) << "kill " << kill << ": " << result.err;
        std::set<std::string> names = names_in(folder_.path());
        if (names.erase("a.ckpt") > 0) {
            next = {"--resume", "a.ckpt"};
        }
        // The part of a checkpoint that was being written, or the file by which the start of the program tries whether
        // the checkpoint and the picture can be written.
        for (const std::string& name : names) {
            const bool of_an_output = name.starts_with("a.ckpt.") || name.starts_with("a.exr.");
            EXPECT_TRUE(of_an_output && name.ends_with(".part")) << name;
            std::filesystem::remove(folder_ / name);
            ++hits_in_writing;
        }
    }
    ASSERT_EQ(next.front(), "--resume") << "no checkpoint was ever written";
    // On a busy machine no process may have come further than one iteration: two or more are to be gone on from.
    expect_done(run(words({"--iterations", "2", "--resume", "a.ckpt", "-o", "a.exr"}, size)));
    const ProcessResult resumed =
        run(words({"--iterations", "1", "--resume", "a.ckpt", "-o", "a.exr", "--hash"}, size));
    expect_done(resumed);
    EXPECT_TRUE(contains(resumed.err, "more than --iterations 1")) << resumed.err;
    const ProcessResult whole = run(words({"--iterations", done("a.exr"), "-o", "b.exr", "--hash"}, size));
    expect_done(whole);
    EXPECT_EQ(picture_hash(resumed), picture_hash(whole)) << "after " << done("a.exr") << " iterations";
    EXPECT_EQ(read_exr(folder_ / "a.exr"), read_exr(folder_ / "b.exr"));
    RecordProperty("iterations", done("a.exr"));
    RecordProperty("kills_in_writing", hits_in_writing);
}

class CheckpointSignal : public Checkpoint, public testing::WithParamInterface<int> {};

TEST_P(CheckpointSignal, KeepsTheStateToo) {
    Words all = words({"--iterations", "1073741823", "--checkpoint", "a.ckpt", "-o", "a.exr"});
    all.insert(all.begin(), test::program());
    Process process(all, folder_.path());
    ASSERT_TRUE(process.wait_for_message(" iterations")) << process.wait().err;
    process.send(GetParam());
    expect_done(process.wait());
    const std::string cut = done("a.exr"), more = std::to_string(std::stoull(cut) + 5);
    expect_done(render({"--iterations", more, "--resume", "a.ckpt", "-o", "resumed.exr"}));
    expect_done(render({"--iterations", more, "-o", "whole.exr"}));
    EXPECT_TRUE(bytes("resumed.exr") == bytes("whole.exr")) << "interrupted after " << cut << " of " << more;
}

INSTANTIATE_TEST_SUITE_P(, CheckpointSignal, testing::Values(SIGINT, SIGTERM),
                         [](const auto& info) { return info.param == SIGINT ? "SIGINT" : "SIGTERM"; });

TEST_F(Checkpoint, AFinishedRenderIsWrittenAgainAndTakesMoreIterations) {
    expect_done(render({"--iterations", "4", "-o", "whole.exr"}));
    const ProcessResult first = render({"--iterations", "4", "-o", "first.exr", "--checkpoint", "a.ckpt"});
    expect_done(first);
    EXPECT_TRUE(contains(first.err, "wrote a.ckpt")) << first.err;
    const ProcessResult again = render({"--iterations", "4", "-o", "again.exr", "--resume", "a.ckpt", "--hash"});
    expect_done(again);
    EXPECT_EQ(lines_of(again.out).size(), 1u) << "it ran iterations:\n" << again.out;
    EXPECT_TRUE(contains(again.err, "goes on after 4 iterations")) << again.err;
    EXPECT_TRUE(bytes("again.exr") == bytes("whole.exr"));

    // To another file the old one is left alone.
    const std::string before = bytes("a.ckpt");
    expect_done(render({"--iterations", "6", "-o", "more.exr", "--resume", "a.ckpt", "--checkpoint", "b.ckpt"}));
    EXPECT_TRUE(bytes("a.ckpt") == before);
    expect_done(render({"--iterations", "9", "-o", "more.exr", "--resume", "b.ckpt"}));
    expect_done(render({"--iterations", "9", "-o", "nine.exr"}));
    EXPECT_TRUE(bytes("more.exr") == bytes("nine.exr"));

    // The time of all runs counts: none is left here.
    expect_done(render({"--time", "0.001ms", "-o", "late.exr", "--resume", "a.ckpt"}));
    EXPECT_EQ(done("late.exr"), "4");
    EXPECT_EQ(read_exr(folder_ / "late.exr"), read_exr(folder_ / "whole.exr"));
}

TEST_F(Checkpoint, OfAnotherDeviceIsTakenWithAWarning) {
    expect_done(render({"--iterations", "2", "-o", "a.exr", "--checkpoint", "a.ckpt"}));
    std::string file = bytes("a.ckpt"), device;
    for (const auto& [key, value] : read_exr_attributes(folder_ / "a.exr")) {
        if (key == "vkcppm.device") device = value;
    }
    const std::size_t at = file.find(device);
    ASSERT_TRUE(!device.empty() && at != std::string::npos);
    file[at] = '?';
    const std::uint64_t hash = fnv1a_of(std::span<const char>(file.data(), file.size() - 8));
    std::memcpy(file.data() + file.size() - 8, &hash, sizeof(hash));
    write_bytes(folder_ / "a.ckpt", file);
    const ProcessResult result = render({"--iterations", "3", "-o", "a.exr", "--resume", "a.ckpt"});
    expect_done(result);
    EXPECT_TRUE(contains(result.err, "warning: a.ckpt was written on ?" + device.substr(1))) << result.err;
    EXPECT_FALSE(contains(render({"--iterations", "4", "-o", "a.exr", "--resume", "a.ckpt"}).err, "warning: a.ckpt"));
}

TEST_F(Checkpoint, KeepsTheCurveOfAMeasuredRender) {
    expect_done(render({"--iterations", "3", "--seed", "2", "-o", "ref.exr"}));
    expect_done(render({"--iterations", "9", "-o", "a.exr", "--stats", "whole.json", "--reference", "ref.exr"}));
    expect_done(render({"--iterations", "5", "-o", "a.exr", "--checkpoint", "a.ckpt", "--reference", "ref.exr"}));
    expect_done(render({"--iterations", "9", "-o", "a.exr", "--stats", "resumed.json", "--resume", "a.ckpt",
                        "--reference", "ref.exr"}));
    Json whole = Json::parse(bytes("whole.json")), resumed = Json::parse(bytes("resumed.json"));
    for (Json* curve : {&whole["curve"], &resumed["curve"]}) {
        for (Json& point : *curve) {
            EXPECT_GT(point["seconds"].get<double>(), 0.0);
            point.erase("seconds");
        }
    }
    EXPECT_EQ(whole["curve"].size(), 5u) << "after 1, 2, 4, 8 and 9 iterations";
    EXPECT_EQ(whole["curve"], resumed["curve"]);
    for (const char* total : {"iterations", "emitted_paths", "stored_photons"}) {
        EXPECT_EQ(whole["totals"][total], resumed["totals"][total]) << total;
    }
    // An error that was reached stays reached.
    const double reached = whole["curve"][2]["relmse"];
    expect_done(render({"--iterations", "9", "-o", "b.exr", "--checkpoint", "b.ckpt", "--reference", "ref.exr",
                        "--stop-at", fmt::format("relmse={}", reached)}));
    expect_done(render({"--iterations", "9", "-o", "c.exr", "--resume", "b.ckpt", "--reference", "ref.exr", "--stop-at",
                        fmt::format("relmse={}", reached)}));
    EXPECT_EQ(done("b.exr"), done("c.exr"));
}

TEST_F(Checkpoint, OfAnotherRenderIsRefusedWithWhatDiffers) {
    expect_done(render({"--iterations", "1", "-o", "ref.exr"}));
    expect_done(render({"--iterations", "1", "-o", "a.exr", "--checkpoint", "a.ckpt"}));
    const std::string before = bytes("a.ckpt");
    const auto refused = [&](Words more, const Words& told) {
        more.insert(more.end(), {"-o", "b.exr", "--resume", "a.ckpt"});
        expect_failure(render(more), 2, told, told.front());
    };
    refused({"--estimator", "sppm"}, {"estimator: cppm in the checkpoint, sppm asked", "a.ckpt"});
    refused({"--seed", "2"}, {"seed: 1 in the checkpoint, 2 asked"});
    refused({"--max-depth", "5"}, {"max_depth: 64 in the checkpoint, 5 asked"});
    refused({"--knn", "9"}, {"knn: 10 in the checkpoint, 9 asked"});
    refused({"--alpha", "0.5"}, {"alpha: 0.66", "0.5 asked"});
    refused({"--k", "0.7"}, {"k: 0.8 in the checkpoint, 0.7 asked"});
    refused({"--beta", "1.5"}, {"beta: 1.2 in the checkpoint, 1.5 asked"});
    refused({"--significance", "0.1"}, {"significance: 0.05 in the checkpoint, 0.1 asked"});
    refused({"--rings", "3"}, {"rings: 2 in the checkpoint, 3 asked"});
    refused({"--sectors", "8"}, {"sectors: 6 in the checkpoint, 8 asked"});
    refused({"--aperture", "0.1", "--focus-distance", "2"},
            {"aperture: 0", "focus_distance: absent in the checkpoint, 2"});
    refused({"--aovs"}, {"aovs: false in the checkpoint, true asked"});
    refused({"--thin-glass", "solid"}, {"thin_glass: thin in the checkpoint, solid asked"});
    refused({"--environment", "ref.exr"}, {"scene_hash: "});
    refused({"--reference", "ref.exr"}, {"reference_hash: absent in the checkpoint"});
    refused({"--seed", "2", "--knn", "9"}, {"seed: 1 in", "knn: 10 in"});
    const auto refused_as = [&](const std::string& name, const std::string& size, const std::string& photons,
                                const std::string& told) {
        expect_failure(run({scene(name), "--size", size, "--photons", photons, "-o", "b.exr", "--resume", "a.ckpt"}), 2,
                       {told}, told);
    };
    refused_as("slab_floor", "32x24", "501", "photons: 500 in the checkpoint, 501 asked");
    refused_as("slab_floor", "24x32", "500", "size: 32x24 in the checkpoint, 24x32 asked");
    refused_as("slab", "32x24", "500", "scene_hash: ");
    EXPECT_TRUE(bytes("a.ckpt") == before);

    // The scene is what is in it, not where it lies.
    std::filesystem::copy_file(scene("slab_floor"), folder_ / "moved.gltf");
    expect_done(run({"moved.gltf", "--size", "32x24", "--photons", "500", "-o", "b.exr", "--resume", "a.ckpt"}));

    expect_failure(render({"-o", "b.exr", "--resume", "none.ckpt"}), 66, {"none.ckpt"});
    expect_failure(render({"-o", "b.exr", "--resume", "ref.exr"}), 65, {"ref.exr", "no checkpoint"});
    write_bytes(folder_ / "cut.ckpt", before.substr(0, before.size() - 1));
    expect_failure(render({"-o", "b.exr", "--resume", "cut.ckpt"}), 65, {"cut.ckpt", "damaged"});
    expect_failure(render({"-o", "a.ckpt", "--resume", "a.ckpt"}), 2, {"a.ckpt"},
                   "the picture in the checkpoint's place");
    expect_failure(render({"--checkpoint-every", "1s"}), 2, {"--checkpoint-every"});
}

TEST_F(Checkpoint, AFullDiskKeepsTheOldOneAndThePicture) {
    if (test::limit_stops_the_driver(64)) GTEST_SKIP() << test::memory_in_files;
    expect_done(render({"--iterations", "2", "-o", "a.exr", "--checkpoint", "a.ckpt"}));
    const std::string before = bytes("a.ckpt");
    // 32 KiB hold the picture, but no checkpoint.
    ASSERT_GT(before.size(), 40'000u);
    ASSERT_LT(bytes("a.exr").size(), 25'000u);
    const auto result =
        run_process({"/bin/sh", "-c",
                     "ulimit -f 64; exec \"$0\" \"$1\" --size 32x24 --photons 500 --iterations 6 -o a.exr "
                     "--resume a.ckpt --checkpoint-every 0.001ms",
                     test::program(), scene("slab_floor")},
                    folder_.path());
    expect_failure(result, 73, {"a.ckpt", "cannot write"});
    EXPECT_TRUE(contains(result.err, "warning: no checkpoint after 6 iterations: cannot write a.ckpt")) << result.err;
    EXPECT_TRUE(bytes("a.ckpt") == before) << "the old checkpoint was touched";
    EXPECT_EQ(done("a.exr"), "6");
    EXPECT_EQ(names_in(folder_.path()), (std::set<std::string>{"a.exr", "a.ckpt"}));
    // What is there goes on.
    expect_done(render({"--iterations", "6", "-o", "b.exr", "--resume", "a.ckpt"}));
    EXPECT_TRUE(bytes("a.exr") == bytes("b.exr"));
}

// Threads of lavapipe and its SIMD width are the driver's matter, whose kernels are compiled anew for each width.
TEST_F(Checkpoint, HashesAreTheSameForAllThreadsAndWidths) {
    std::string expected;
    // Vectors of 128 bits without the optimiser, which dies of them in LLVM 19 (Mesa 25.0.7).
    const std::vector<Words> environments = {{"LP_NUM_THREADS=1"},
                                             {"LP_NUM_THREADS=2"},
                                             {"LP_NUM_THREADS=3"},
                                             {"LP_NATIVE_VECTOR_WIDTH=128", "GALLIVM_PERF=nopt"}};
    for (const Words& environment : environments) {
        Words all = {"/usr/bin/env"};
        all.insert(all.end(), environment.begin(), environment.end());
        all.push_back(test::program());
        const Words more = words({"--iterations", "3", "-o", "a.exr", "--hash"});
        all.insert(all.end(), more.begin(), more.end());
        const ProcessResult result = run_process(all, folder_.path());
        expect_done(result);
        const std::vector<std::string> lines = lines_of(result.out);
        ASSERT_EQ(lines.size(), 3u * 7u + 1u) << result.out;
        EXPECT_TRUE(lines[0].starts_with("1 photon ") && lines[20].starts_with("3 update ")) << result.out;
        if (expected.empty()) expected = result.out;
        EXPECT_EQ(result.out, expected) << "under " << environment.back();
    }
}

}  // namespace
}  // namespace vkcppm
