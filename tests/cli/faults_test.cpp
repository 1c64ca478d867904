// The program on a device that fails: exit code, one line, the last good picture kept. And on one whose memory the host
// does not see: the same bits.

#include <cstdint>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "io/exr.h"
#include "support/drivers.h"
#include "support/files/files.h"

namespace vkcppm {
namespace {

using namespace test;

/// What tests/cli/fault_layer does to the device, and what is to come of it.
struct Fault {
    const char* name;
    const char* text;  // VKCPPM_FAULT
    int code;
    Words told;
};

void PrintTo(const Fault& fault, std::ostream* stream) { *stream << fault.text; }

class FaultLayer : public ProgramTest {
protected:
    /// policy: VKCPPM_POLICY.
    ProcessResult run_on(const char* fault, Words more, const char* policy = "") const {
        Words words{"/usr/bin/env",
                    "VK_LAYER_PATH=" + test::fault_layer_folder(),
                    "VK_INSTANCE_LAYERS=VK_LAYER_VKCPPM_fault",
                    std::string("VKCPPM_FAULT=") + fault,
                    std::string("VKCPPM_POLICY=") + policy,
                    test::program()};
        words.insert(words.end(), more.begin(), more.end());
        return run_process(words, folder_.path());
    }
};

class Faults : public FaultLayer, public testing::WithParamInterface<Fault> {};

TEST_P(Faults, EndInALineAndKeepTheGoodPicture) {
    write_bytes(folder_ / "good.exr", "good");
    const auto result = run_on(GetParam().text, {scene("slab"), "--size", "16x12", "--iterations", "64", "--photons",
                                                 "500", "--quiet", "-o", "good.exr", "--png", "new.png"});
    expect_failure(result, GetParam().code, GetParam().told, GetParam().text);
    EXPECT_TRUE(read_bytes(folder_ / "good.exr") == "good") << "the good picture is lost";
    EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"good.exr"});
}

const std::vector<Fault> faults = {
    {"LostAtTheFirstSubmission", "vkQueueSubmit 1 -4", 75, {"the device was lost while running kernels"}},
    {"LostInTheRender", "vkQueueSubmit 4 -4", 75, {"the device was lost while running kernels"}},
    {"LostWhileItIsWaitedFor", "vkWaitForFences 3 -4", 75, {"the device was lost while running kernels"}},
    {"ThatDoesNothing", "idle", 75, {"does not run its kernels: 0 of 1 iterations are complete"}},
    {"MemoryForTheFirstBuffer",
     "vkAllocateMemory 1 -2",
     71,
     {"out of device memory while allocating buffer '", "bytes are allocated"}},
    {"MemoryForALaterBuffer", "vkAllocateMemory 20 -2", 71, {"out of device memory while allocating buffer '"}},
    {"HostMemoryOfTheDriver", "vkAllocateMemory 20 -1", 71, {"out of host memory while allocating buffer '"}},
    {"MemoryForAKernel", "vkCreateComputePipelines 3 -2", 71, {"out of device memory while creating kernel '"}},
    {"AnErrorWithoutAName", "vkCreateComputePipelines 1 -13", 70, {"Vulkan failed while creating kernel '"}},
    {"ASmallDevice", "heap 0 200000", 71, {"the render needs ", "; it has 1 MB: "}},
};

INSTANTIATE_TEST_SUITE_P(, Faults, testing::ValuesIn(faults),
                         [](const auto& info) { return std::string(info.param.name); });

// A program that fails with the layer would pass the tests above whatever it did.
TEST_F(FaultLayer, TheLayerItselfIsNoFault) {
    expect_done(run_on(
        "", {scene("slab"), "--size", "16x12", "--iterations", "2", "--photons", "500", "--quiet", "-o", "a.exr"}));
    EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"a.exr"});
}

// All that the host reads and writes then goes through staging copies: scene, parameters, passes, picture, checkpoint.
TEST_F(FaultLayer, ACardGivesTheSameBits) {
    const auto hashes_on = [&](const char* device, const char* policy = "") {
        const auto render = [&](const Words& more) {
            Words words{scene("slab"), "--size", "16x12", "--photons", "500",          "--quiet",
                        "--aovs",      "--hash", "-o",    "a.exr",     "--checkpoint", "a.checkpoint"};
            words.insert(words.end(), more.begin(), more.end());
            const ProcessResult result = run_on(device, words, policy);
            expect_done(result);
            return result.out;
        };
        const std::string first = render({"--iterations", "3"});
        return first + render({"--iterations", "6", "--resume", "a.checkpoint"});
    };
    const std::string seen = hashes_on("");
    EXPECT_EQ(lines_of(seen).size(), 2 * (3 * 7 + 1));
    EXPECT_EQ(hashes_on("card 8000000 4000000;texels 0 2097152"), seen)
        << "some buffers lie in the window, others do not, with as few texels as are asked for";
    EXPECT_EQ(hashes_on("card 0 268435456;stamps 0 36", "gpu"), seen) << "all of a card's way";
    if (faults_where_texels_are_storage(run({"devices"}).out)) GTEST_SKIP() << why_storage_faults;
    EXPECT_EQ(hashes_on("texels 0 65536"), seen) << "texels are read as storage";
    EXPECT_EQ(hashes_on("card 300000000 60000000;stamps 0 36;texels 0 65536", "gpu"), seen) << "all that is small";
}

// A card whose window is full long before its memory.
TEST_F(FaultLayer, ALargeRenderFitsACardWithASmallWindow) {
    expect_done(run_on("card 0 1000000", {scene("slab"), "--size", "256x192", "--iterations", "1", "--photons", "2000",
                                          "--quiet", "-o", "a.exr"}));
}

// Clocks that begin again in the render, and those that are not there: what passes take stays near what all took.
TEST_F(FaultLayer, TimeStampsMayBeginAgainOrBeMissing) {
    for (const char* device : {"stamps 0 36", "stamps 0 0"}) {
        SCOPED_TRACE(device);
        const ProcessResult result =
            run_on(device, {scene("slab"), "--size", "16x12", "--photons", "2000", "--iterations", "64", "--quiet",
                            "-o", "a.exr", "--stats", "a.json"});
        expect_done(result);
        const auto stats = nlohmann::json::parse(read_bytes(folder_ / "a.json"));
        double seconds = 0.0;
        for (const auto& pass : stats.at("passes")) seconds += pass.at("device_seconds").get<double>();
        EXPECT_GT(seconds, 0.0);
        // The wall's clock stands still while pipelines are compiled, which takes seconds.
        EXPECT_LT(seconds, stats.at("totals").at("wall_seconds").get<double>() + 30.0);
    }
}

// What a render may have made in hours is not lost with the memory for longer paths.
TEST_F(FaultLayer, MemoryThatIsFullInTheRenderLeavesThePictureSoFar) {
    const Words words{scene("box"), "--size", "16x12", "--photons", "500", "--quiet"};
    Words cut = words, whole = words;
    cut.insert(cut.end(), {"--iterations", "64", "-o", "cut.exr"});
    const ProcessResult result = run_on("full 3 20000", cut);
    expect_failure(result, 71,
                   {"out of device memory while allocating buffer 'photons'", "cut.exr is the picture after "});
    std::uint32_t done = 0;
    const std::string last = lines_of(result.err).back();
    std::istringstream(last.substr(last.find("after ") + 6)) >> done;
    ASSERT_GT(done, 0u);
    ASSERT_LT(done, 64u);
    whole.insert(whole.end(), {"--iterations", std::to_string(done), "-o", "whole.exr"});
    expect_done(run_on("", whole));
    EXPECT_EQ(read_exr(folder_ / "cut.exr"), read_exr(folder_ / "whole.exr"));
}

}  // namespace
}  // namespace vkcppm
