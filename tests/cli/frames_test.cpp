// Frames of an animation, and pictures on the way, through the program.

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "cli/program.h"
#include "io/exr.h"
#include "support/files/files.h"
#include "support/scenes/gltf_builder.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using namespace test;

class Frames : public ProgramTest {
protected:
    /// A lit triangle that moves from x = 0 to x = 2 in a second.
    Frames() {
        GltfBuilder b = one_triangle();
        const int times = b.accessor(b.view(std::vector<float>{0, 1}), "SCALAR", 5126, 2);
        b.document["accessors"][times].update({{"min", {0}}, {"max", {1}}});
        b.add("animations", {{"name", "slide"},
                             {"samplers", {{{"input", times}, {"output", b.float3({{0, 0, 0}, {2, 0, 0}})}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
        b.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 20}}};
        b.add("nodes", {{"translation", {0.5, 0.5, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
        b.add("nodes", {{"translation", {1, 0.5, 3}}, {"camera", 0}});
        write_bytes(folder_ / "s.gltf", b.gltf());
    }

    ProcessResult render(Words more, const char* seed = "1") const {
        Words words{"s.gltf", "--animation", "slide", "--size", "16x12", "--photons", "200", "--iterations", "2"};
        words.insert(words.end(), {"--seed", seed});
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    std::string bytes(const std::string& name) const { return read_bytes(folder_ / name); }
};

TEST_F(Frames, EachHasTheBytesOfItsTimeAlone) {
    expect_done(render({"--frames", "2..4", "--fps", "8", "-o", "f_%03d.exr", "--png", "p%d.png", "--stats",
                        "s_%02d.json", "--quiet"}));
    EXPECT_EQ(names_in(folder_.path()),
              (std::set<std::string>{"s.gltf", "f_002.exr", "f_003.exr", "f_004.exr", "p2.png", "p3.png", "p4.png",
                                     "s_02.json", "s_03.json", "s_04.json"}));
    for (int i = 2; i <= 4; ++i) {
        expect_done(render({"--at", fmt::format("{}", i / 8.0), "-o", "one.exr", "--png", "one.png", "--quiet"}));
        EXPECT_TRUE(bytes("one.exr") == bytes(fmt::format("f_{:03}.exr", i))) << "frame " << i;
        EXPECT_TRUE(bytes("one.png") == bytes(fmt::format("p{}.png", i))) << "frame " << i;
    }
    EXPECT_FALSE(bytes("f_002.exr") == bytes("f_003.exr"));
}

TEST_F(Frames, ThoseThatAreThereAreSkipped) {
    const Words all{"--frames", "0..4", "-o", "f%d.exr", "--png", "p%d.png"};
    const ProcessResult first = render(all);
    expect_done(first);
    EXPECT_NE(first.err.find("frame 3 of 0..4, at 0.125 s"), first.err.npos) << first.err;
    const auto times = [&] {
        std::vector<fs::file_time_type> times;
        for (int i = 0; i <= 4; ++i) times.push_back(fs::last_write_time(folder_ / fmt::format("f{}.exr", i)));
        return times;
    };
    const auto before = times();
    const ProcessResult again = render(all);
    expect_done(again);
    EXPECT_EQ(lines_of(again.err).back(), "frames 0..4 are there, of this render: skipped") << again.err;
    EXPECT_EQ(times(), before);
    // One is gone, one is no picture, of one the PNG is gone: these are rendered, to the same bytes.
    const std::string right = bytes("f1.exr");
    fs::remove(folder_ / "f1.exr");
    write_bytes(folder_ / "f2.exr", bytes("f2.exr").substr(0, 500));
    fs::remove(folder_ / "p4.png");
    const ProcessResult mended = render(all);
    expect_done(mended);
    EXPECT_NE(mended.err.find("frame 0 is there, of this render: skipped\nframe 1 of"), mended.err.npos) << mended.err;
    EXPECT_NE(mended.err.find("frame 3 is there, of this render: skipped\nframe 4 of"), mended.err.npos) << mended.err;
    EXPECT_TRUE(bytes("f1.exr") == right);
    // What another seed, another material or fewer iterations made is rendered over.
    EXPECT_EQ(render(all, "2").err.find("skipped"), std::string::npos);
    EXPECT_NE(render({"--frames", "0..0", "-o", "f%d.exr"}, "2").err.find("skipped"), std::string::npos);
    for (const Words& other : {Words{"--set", "0:ior=2"}, Words{"--aperture", "0.1"}, Words{"--fps", "25"}}) {
        Words words{"--frames", "1..1", "-o", "f%d.exr"};
        words.insert(words.end(), other.begin(), other.end());
        EXPECT_EQ(render(words, "2").err.find("skipped"), std::string::npos)
            << fmt::format("{}", fmt::join(words, " "));
    }
}

TEST_F(Frames, AreRefusedWithoutAPlaceForTheirNumber) {
    const auto refused = [&](Words words, const std::vector<std::string>& told) {
        expect_failure(render(words), 2, told, fmt::format("{}", fmt::join(words, " ")));
        EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"s.gltf"});
    };
    refused({"--frames", "0..1", "-o", "f.exr"}, {"-o", "f.exr", "out_%04d.exr"});
    refused({"--frames", "0..1", "-o", "f%d_%d.exr"}, {"-o", "f%d_%d.exr"});
    refused({"--frames", "0..1", "-o", "f%s.exr"}, {"-o", "f%s.exr"});
    refused({"--frames", "0..1", "-o", "%d/f.exr"}, {"-o", "%d/f.exr"});
    refused({"--frames", "0..1", "-o", "f%d.exr", "--png", "p.png"}, {"--png", "p.png"});
    refused({"--frames", "0..1", "-o", "-"}, {"-o", "-"});
    refused({"--frames", "0..1", "-o", "f%d.png"}, {"-o", "f0.png", ".exr"});
    for (const char* range : {"1..0", "1", "a..b", "0..1x", "-1..2", "0..2000000"}) {
        refused({"--frames", range}, {"--frames", range, "FIRST..LAST"});
    }
    refused({"--frames", "0..1", "--fps", "0"}, {"--fps", "'0'"});
    refused({"--frames", "0..1", "--at", "1"}, {"--frames", "--at"});
    refused({"--frames", "0..1", "--target", "noise=2%"}, {"--frames", "--target"});
    refused({"--frames", "0..1", "--checkpoint", "c"}, {"--frames", "--checkpoint"});
    refused({"--fps", "25"}, {"--fps", "--frames"});
    expect_failure(run({"s.gltf", "--frames", "0..1"}), 2, {"--frames", "--animation"}, "at rest");
}

TEST_F(Frames, SnapshotsAreWholePicturesOnTheWay) {
    Words words{test::program(), "s.gltf", "--size", "64x48", "--photons", "2000",  "--iterations", "1000000",
                "--snapshot",    "100ms",  "-o",     "a.exr", "--png",     "a.png", "--quiet"};
    Process process(words, folder_.path());
    const auto done = [&] {
        for (const auto& [name, value] : read_exr_attributes(folder_ / "a.exr")) {
            if (name == "vkcppm.iterations_done") return std::stoi(value);
        }
        return 0;
    };
    const auto wait_for = [&](const auto& holds) {
        for (int i = 0; i < 6000 && !holds(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return holds();
    };
    EXPECT_TRUE(wait_for([&] { return fs::exists(folder_ / "a.png"); }));
    const int first = done();
    EXPECT_GT(first, 0);
    EXPECT_TRUE(wait_for([&] { return done() > first; }));
    EXPECT_EQ(read_exr(folder_ / "a.exr").extent, (Extent{64, 48}));
    process.send(SIGTERM);
    expect_done(process.wait());
    EXPECT_GT(done(), first);
    // The picture is what it is without them.
    const int iterations = done();
    const std::string with = bytes("a.exr");
    expect_done(run({"s.gltf", "--size", "64x48", "--photons", "2000", "--iterations", fmt::format("{}", iterations),
                     "-o", "b.exr", "--quiet"}));
    EXPECT_TRUE(read_exr(folder_ / "a.exr").rgb == read_exr(folder_ / "b.exr").rgb);
    expect_failure(run({"s.gltf", "--snapshot", "1s", "-o", "-"}), 2, {"--snapshot", "standard output"}, "-o -");
}

}  // namespace
}  // namespace vkcppm
