// The built program as a user meets it: exit codes, messages, files.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "core/image.h"
#include "core/metrics.h"
#include "io/exr.h"
#include "support/files/files.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"
#include "support/files/viewer.h"
#include "support/hostile/faults.h"
#include "support/scenes/everything.h"
#include "support/scenes/scenes.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace test;

std::string shown(const Words& words) {
    std::string text = "vkcppm";
    for (const std::string& word : words) text += " " + word;
    return text;
}

class Cli : public ProgramTest {
protected:
    /// A picture that takes a moment: 16x12 pixels, two iterations of 500 paths.
    test::ProcessResult render(Words more) const {
        Words words{scene("caustic"), "--size", "16x12", "--iterations", "2", "--photons", "500", "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    /// The same by a shell in the folder; $0 is the program, $1 a scene, for redirections.
    test::ProcessResult shell(const std::string& script) const {
        return test::run_process({"/bin/sh", "-c", script, test::program(), scene("caustic")}, folder_.path());
    }

    std::map<std::string, std::string> attributes(const std::string& name) const {
        const ExrAttributes list = read_exr_attributes(folder_ / name);
        return {list.begin(), list.end()};
    }
};

// ---- Help, version and the listing commands

TEST_F(Cli, HelpAndVersionGoToStandardOutput) {
    for (const Words& words : {Words{"--help"}, Words{"-h"}, Words{"race", "--help"}, Words{"compare", "--help"},
                               Words{"check", "--help"}, Words{"info", "--help"}, Words{"devices", "--help"}}) {
        const auto result = run(words);
        expect_done(result);
        EXPECT_TRUE(contains(result.out, "Usage: vkcppm")) << shown(words) << "\n" << result.out;
        EXPECT_EQ(result.err, "");
    }
    const auto version = run({"--version"});
    expect_done(version);
    EXPECT_TRUE(version.out.starts_with("vkcppm ")) << version.out;
    EXPECT_EQ(lines_of(version.out).size(), 1u);
}

TEST_F(Cli, DevicesAreListed) {
    const auto result = run({"devices", "--json"});
    expect_done(result);
    const Json devices = Json::parse(result.out);
    ASSERT_TRUE(devices.is_array());
    ASSERT_FALSE(devices.empty()) << "these tests need a Vulkan device";
    const auto plain = run({"devices"});
    expect_done(plain);
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(devices[i].at("index"), i);
        EXPECT_EQ(devices[i].at("uuid").get<std::string>().size(), 36u) << devices[i];
        EXPECT_EQ(devices[i].at("usable").get<bool>(), devices[i].at("unusable_because") == "");
        EXPECT_TRUE(contains(plain.out, devices[i].at("name").get<std::string>())) << plain.out;
        EXPECT_TRUE(contains(plain.out, "uuid:" + devices[i].at("uuid").get<std::string>())) << plain.out;
    }
}

TEST_F(Cli, TheDoctorTellsWhatARenderHangsOn) {
    const auto plain = run({"doctor"});
    expect_done(plain);
    for (const char* part : {"processor: ", "memory: ", "Vulkan loader: ", "device 0: ", "validation layer: "}) {
        EXPECT_TRUE(contains(plain.out, part)) << part << " is not in: " << plain.out;
    }
    const Json json = Json::parse(run({"doctor", "--json"}).out);
    EXPECT_EQ(json.at(0).at("what"), "program");
    // A machine without a driver: the advice names a package.
    const auto none = shell("VK_ICD_FILENAMES=/none.json VK_DRIVER_FILES=/none.json \"$0\" doctor");
    EXPECT_EQ(none.exit_code, 69) << none.err;
    EXPECT_TRUE(contains(none.out, "mesa-vulkan-drivers")) << none.out;
    const auto render = shell("VK_ICD_FILENAMES=/none.json VK_DRIVER_FILES=/none.json \"$0\" \"$1\"");
    expect_failure(render, 69, {"Vulkan", "mesa-vulkan-drivers"});
}

TEST_F(Cli, InfoTellsWhatIsInTheScene) {
    const auto result = run({"info", scene("point_plane"), "--json"});
    expect_done(result);
    const Json info = Json::parse(result.out);
    EXPECT_EQ(info.at("triangles"), 2);
    EXPECT_EQ(info.at("bounds").at("min"), Json({-4.0, 0.0, -4.0}));
    EXPECT_EQ(info.at("bounds").at("max"), Json({4.0, 0.0, 4.0}));
    ASSERT_EQ(info.at("lights").size(), 1u);
    EXPECT_EQ(info.at("lights")[0].at("kind"), "point");
    ASSERT_EQ(info.at("cameras").size(), 1u);
    const Json file = Json::parse(test::read_bytes(scene("point_plane")));
    const Json& light = file.at("extensions").at("KHR_lights_punctual").at("lights")[0];
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(info.at("lights")[0].at("intensity")[c].get<double>(),
                    light.at("intensity").get<double>() * light.at("color")[c].get<double>(), 1e-4)
            << "channel " << c;
    }
    const double yfov = file.at("cameras")[0].at("perspective").at("yfov");
    EXPECT_NEAR(info.at("cameras")[0].at("yfov_degrees").get<double>() * std::numbers::pi / 180.0, yfov, 1e-9);
    EXPECT_EQ(info.at("hash").get<std::string>().size(), 16u);
}

TEST_F(Cli, InfoTellsHowMaterialsAreTreated) {
    const auto result = run({"info", scene("caustic"), "--json"});
    expect_done(result);
    const Json info = Json::parse(result.out);
    ASSERT_EQ(info.at("materials").size(), 6u);
    std::map<std::string, std::string> treatment;
    std::size_t triangles = 0;
    for (const Json& material : info.at("materials")) {
        treatment[material.at("name")] = material.at("treatment");
        triangles += material.at("triangles").get<std::size_t>();
    }
    EXPECT_EQ(triangles, info.at("triangles").get<std::size_t>());
    EXPECT_NE(treatment.at("plaster"), "");
    EXPECT_NE(treatment.at("glass"), treatment.at("plaster"));
    EXPECT_NE(treatment.at("gold"), treatment.at("plaster"));
    const auto plain = run({"info", scene("caustic")});
    expect_done(plain);
    for (const auto& [name, text] : treatment) {
        EXPECT_TRUE(contains(plain.out, "'" + name + "'")) << plain.out;
        EXPECT_TRUE(contains(plain.out, text)) << plain.out;
    }
}

TEST_F(Cli, InfoTellsWhatARenderTakes) {
    // Three bands: a pixel of a band is there for a third of the picture.
    const auto result = run(
        {"info", scene("cornell"), "--memory", "--size", "2048x1200", "--photons", "10000", "--knn", "20", "--json"});
    expect_done(result);
    const Json memory = Json::parse(result.out).at("memory");
    std::map<std::string, Json> of;
    std::uint64_t sum = 0;
    for (const Json& row : memory.at("of")) {
        of[row.at("of")] = row;
        sum += row.at("bytes").get<std::uint64_t>();
    }
    EXPECT_EQ(memory.at("bytes"), sum);
    EXPECT_EQ(of.at("pixel").at("count"), 2048 * 1200);
    EXPECT_EQ(of.at("pixel of a band").at("count"), 2048 * 400);
    EXPECT_LT(sum, memory.at("device_memory_bytes").get<std::uint64_t>());
    const auto plain = run({"info", scene("cornell"), "--memory", "--size", "2048x1200"});
    expect_done(plain);
    EXPECT_TRUE(contains(plain.out, "a render of 2048x1200 takes ")) << plain.out;
    EXPECT_TRUE(contains(plain.out, "  pixel: 2457600 times 120.0 bytes, 294.9 MB")) << plain.out;
}

// ---- Comparing

TEST_F(Cli, InfoTellsOfTheEnvironment) {
    // Four rings of directions: the one round the pole has (1 - cos 45 degrees) / 2 of the sphere.
    write_exr(folder_ / "sky.exr", Image{{1, 4}, {{8, 0, 0}, {0, 8, 0}, {0, 0, 8}, {0, 0, 8}}});
    const auto result = run({"info", scene("caustic"), "--environment", "sky.exr", "--json"});
    expect_done(result);
    const Json info = Json::parse(result.out);
    const Json& environment = info.at("environment");
    EXPECT_EQ(environment.at("width"), 1);
    EXPECT_EQ(environment.at("height"), 4);
    const double pole = 0.5 * (1.0 - std::numbers::sqrt2 / 2.0);
    EXPECT_NEAR(environment.at("mean_radiance")[0].get<double>(), 8.0 * pole, 1e-12);
    EXPECT_NEAR(environment.at("mean_radiance")[1].get<double>(), 8.0 * (0.5 - pole), 1e-12);
    EXPECT_NEAR(environment.at("mean_radiance")[2].get<double>(), 4.0, 1e-12);
    EXPECT_EQ(info.at("vertex_attributes"), Json({"POSITION", "NORMAL"}));
    EXPECT_EQ(info.at("images"), Json::array());

    const auto plain = run({"info", scene("caustic"), "--environment", "sky.exr"});
    expect_done(plain);
    EXPECT_TRUE(contains(plain.out, "environment of 1x4, mean radiance (1.17157, 2.82843, 4)")) << plain.out;
    const auto without = run({"info", scene("caustic"), "--json"});
    expect_done(without);
    EXPECT_TRUE(Json::parse(without.out).at("environment").is_null());
    EXPECT_NE(Json::parse(without.out).at("hash"), info.at("hash"));
}

TEST_F(Cli, CompareGivesTheMeasures) {
    write_exr(folder_ / "a.exr", Image{{2, 1}, {{1.5f, 0.5f, 0.5f}, {0.5f, 0.0f, 0.25f}}});
    write_exr(folder_ / "r.exr", Image{{2, 1}, {{1.0f, 0.5f, 0.0f}, {1.0f, 0.5f, 0.25f}}});
    const auto result = run({"compare", "a.exr", "r.exr", "--json"});
    expect_done(result);
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("mean_ratio"), Json({1.0, 0.5, 3.0}));
    EXPECT_NEAR(json.at("mse").get<double>(), 1.0 / 6.0, 1e-15);
    EXPECT_NEAR(json.at("relmse").get<double>(), (0.5 / 1.01 + 25.0 + 0.25 / 0.26) / 6.0, 1e-12);
    EXPECT_TRUE(json.contains("relmse_trimmed") && json.contains("srgb_mse") && json.contains("psnr")) << json;
    const auto plain = run({"compare", "a.exr", "r.exr"});
    expect_done(plain);
    EXPECT_TRUE(contains(plain.out, "1.000000 0.500000 3.000000")) << plain.out;
}

TEST_F(Cli, CompareFindsNoErrorInTheSamePicture) {
    write_exr(folder_ / "a.exr", Image{{1, 2}, {{1.5f, 0.5f, 0.5f}, {0.5f, 0.1f, 0.25f}}});
    const auto result = run({"compare", "a.exr", "a.exr", "--json"});
    expect_done(result);
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json.at("mean_ratio"), Json({1.0, 1.0, 1.0}));
    EXPECT_EQ(json.at("relmse"), 0.0);
    EXPECT_TRUE(json.at("psnr").is_null()) << "infinite, which JSON cannot say: " << json;
}

TEST_F(Cli, CompareRefusesWhatItCannotCompare) {
    write_exr(folder_ / "a.exr", Image{{2, 1}, std::vector<glm::vec3>(2, glm::vec3(1.0f))});
    write_exr(folder_ / "b.exr", Image{{1, 2}, std::vector<glm::vec3>(2, glm::vec3(1.0f))});
    test::write_bytes(folder_ / "text.exr", "no picture");
    expect_failure(run({"compare", "a.exr", "b.exr"}), 2, {"2x1", "1x2"}, "sizes");
    expect_failure(run({"compare", "a.exr", "missing.exr"}), 66, {"missing.exr"}, "missing");
    expect_failure(run({"compare", "text.exr", "a.exr"}), 65, {"text.exr"}, "no picture");
    expect_failure(run({"compare", "a.exr"}), 2, {"REFERENCE"}, "one picture");
}

TEST_F(Cli, CompareCountsNonFinitePixels) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    write_exr(folder_ / "a.exr", Image{{2, 1}, {glm::vec3(nan), glm::vec3(1.0f)}});
    write_exr(folder_ / "r.exr", Image{{2, 1}, {glm::vec3(1.0f), glm::vec3(1.0f)}});
    const auto result = run({"compare", "a.exr", "r.exr", "--json"});
    expect_done(result);
    EXPECT_EQ(Json::parse(result.out).at("image_non_finite"), 1);
    EXPECT_EQ(Json::parse(result.out).at("mse"), 0.0);
    EXPECT_TRUE(contains(result.err, "warning: 1 pixels of the image")) << result.err;
}

// ---- Check

class CheckCli : public Cli {
protected:
    /// A grey picture with noise of standard error 0.01, of another seed each time.
    void write_noisy(const std::string& name, float grey, std::uint32_t seed, bool errors = true) const {
        std::mt19937 engine(seed);
        std::normal_distribution<float> noise(0.0f, 0.01f);
        Image image{{32, 24}, {}};
        for (std::size_t i = 0; i < image.extent.pixels(); ++i) image.rgb.emplace_back(grey + noise(engine));
        ExrChannels channels = to_channels(image);
        if (errors) {
            channels.values["StdErr"].assign(image.extent.pixels(), 0.01f);
            channels.values["StdErr.8"].assign(image.extent.pixels(), 0.01f / 8.0f);
            channels.values["StdErr.64"].assign(image.extent.pixels(), 0.01f / 27.7f);
        }
        write_exr(folder_ / name, channels, {{"vkcppm.batches", "64"}});
    }
};

/// Exit code `code`, one line on standard output that begins with `begin` and holds `told`.
void expect_verdict(const test::ProcessResult& result, int code, const std::string& begin, const Words& told = {}) {
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.exit_code, code) << result.out << result.err;
    EXPECT_EQ(lines_of(result.out).size(), 1u) << result.out;
    EXPECT_TRUE(result.out.starts_with(begin)) << result.out;
    for (const std::string& part : told) EXPECT_TRUE(contains(result.out, part)) << result.out;
}

TEST_F(CheckCli, NoiseExplainsAnotherSeedAndNotAnotherGrey) {
    write_noisy("a.exr", 0.5f, 1);
    write_noisy("r.exr", 0.5f, 2);
    write_noisy("brighter.exr", 0.51f, 3);
    expect_verdict(run({"check", "a.exr", "r.exr"}), 0,
                   "passes: ", {"noise explains all 781 pixels and blocks", "level 1 %"});
    expect_verdict(run({"check", "brighter.exr", "r.exr"}), 1,
                   "differs: ", {"more than noise is in the mean of the whole picture", "sigma"});
    const auto json = run({"check", "brighter.exr", "r.exr", "--json", "--level", "5%"});
    EXPECT_EQ(json.exit_code, 1);
    EXPECT_EQ(Json::parse(json.out).at("noise").at("level"), 0.05);
    EXPECT_EQ(Json::parse(json.out).at("passes"), false);
}

TEST_F(CheckCli, BoundsDecideWhereTheyAreGiven) {
    write_noisy("a.exr", 0.5f, 1, false);
    write_noisy("r.exr", 0.5f, 2, false);
    expect_verdict(run({"check", "a.exr", "r.exr", "--max", "relmse=0.01", "--max", "flip=0.5"}), 0, "passes: relmse",
                   {"is within 0.01; flip"});
    expect_verdict(run({"check", "a.exr", "r.exr", "--max", "relmse=1e-6", "--max", "flip=0.5"}), 1, "differs: relmse",
                   {"is above 1e-06"});
    expect_verdict(run({"check", "a.exr", "r.exr", "--max-pixels", "0.1%", "--pixel-bound", "20%"}), 0, "passes: 0 of");
    expect_failure(run({"check", "a.exr", "r.exr"}), 2, {"a.exr has no channel StdErr", "--max relmse="}, "no bounds");
    expect_failure(run({"check", "a.exr", "r.exr", "--max", "flip=1", "--level", "1%"}), 2, {"StdErr"}, "a level");
    expect_failure(run({"check", "a.exr", "missing.exr", "--max", "flip=1"}), 66, {"missing.exr"}, "missing");
    write_exr(folder_ / "nan.exr", {{1, 1}, {glm::vec3(NAN)}});
    expect_verdict(run({"check", "nan.exr", "nan.exr", "--max", "mse=1"}), 1, "differs: mse is no number; no pixel");
}

TEST_F(CheckCli, ErrorsThatAreNoNumbersExplainNothing) {
    write_noisy("a.exr", 0.5f, 1);
    ExrChannels channels = read_exr_channels(folder_ / "a.exr", "");
    for (const float error : {NAN, INFINITY, -1.0f}) {
        channels.values["StdErr"][33] = error;
        write_exr(folder_ / "r.exr", channels, {});
        expect_failure(run({"check", "a.exr", "r.exr"}), 65, {"r.exr: StdErr is ", "column 1, row 1", "0 or more"});
        expect_verdict(run({"check", "a.exr", "r.exr", "--max", "mse=1"}), 0, "passes: ");
        for (const char* colour : {"R", "G", "B"}) channels.values[colour][33] = NAN;
        write_exr(folder_ / "holed.exr", channels, {});
        expect_verdict(run({"check", "holed.exr", "holed.exr"}), 0, "passes: noise explains all 780 pixels");
        for (const char* colour : {"R", "G", "B"}) channels.values[colour][33] = 0.5f;
    }
}

TEST_F(CheckCli, LeavesAPageAndXmlAndNeverOverwritesAPicture) {
    write_noisy("a.exr", 0.5f, 1);
    write_noisy("r.exr", 0.6f, 2);
    expect_verdict(run({"check", "a.exr", "r.exr", "--report", "out", "--junit", "junit.xml"}), 1, "differs: ");
    EXPECT_EQ(test::names_in(folder_ / "out"), (std::set<std::string>{"check.json", "index.html"}));
    EXPECT_TRUE(test::read_bytes(folder_ / "out/index.html").starts_with("<!DOCTYPE html>"));
    EXPECT_TRUE(contains(test::read_bytes(folder_ / "junit.xml"), "<failure message="));
    expect_failure(run({"check", "a.exr", "r.exr", "--junit", "r.exr"}), 2, {"--junit", "r.exr"}, "over the reference");
}

TEST_F(CheckCli, UpdateReplacesTheReferenceByThePicture) {
    write_noisy("a.exr", 0.5f, 1);
    write_noisy("r.exr", 0.6f, 2);
    const std::string bytes = test::read_bytes(folder_ / "a.exr");
    expect_verdict(run({"check", "a.exr", "r.exr", "--update"}), 0, "r.exr is now a.exr: relmse 0.");
    EXPECT_EQ(test::read_bytes(folder_ / "r.exr"), bytes);
    expect_verdict(run({"check", "a.exr", "new.exr", "--update"}), 0, "new.exr is now a.exr\n");
    EXPECT_EQ(test::read_bytes(folder_ / "new.exr"), bytes);
    test::write_bytes(folder_ / "text.exr", "no picture");
    expect_failure(run({"check", "text.exr", "r.exr", "--update"}), 65, {"text.exr"}, "no picture");
    EXPECT_EQ(test::read_bytes(folder_ / "r.exr"), bytes) << "what is no picture replaces nothing";
    expect_failure(run({"check", "a.exr", "./a.exr", "--update"}), 2, {"REFERENCE", "a.exr"}, "itself");
}

TEST_F(Cli, PngsAreExposedByTheMedianAndSayWhatTheyClip) {
    const auto result = render({"-o", "a.exr", "--png", "a.png", "--exposure", "auto", "--tone-map", "agx",
                                "--png-depth", "16", "--stats", "a.json"});
    expect_done(result);
    EXPECT_EQ(int(test::read_bytes(folder_ / "a.png").at(24)), 16);
    const Json stats = Json::parse(test::read_bytes(folder_ / "a.json"));
    EXPECT_EQ(stats.at("png").at("tone_map"), "agx");
    EXPECT_TRUE(stats.at("png").at("exposure").is_number());
    const auto bright = render({"-o", "a.exr", "--png", "a.png", "--exposure", "9"});
    expect_done(bright);
    EXPECT_TRUE(contains(bright.err, "warning: a.png: ")) << bright.err;
    EXPECT_TRUE(contains(bright.err, "are clipped; with --exposure ")) << bright.err;
}

// ---- Misuse of the render

struct Misuse {
    Words words;  // after the scene
    int code;
    Words told;
};

TEST_F(Cli, EveryMisuseHasItsExitCodeAndItsLine) {
    const std::vector<Misuse> all = {
        {{"--bogus"}, 2, {"--bogus"}},
        {{"another.gltf"}, 2, {"another.gltf"}},
        {{"--photons", "-1"}, 2, {"--photons", "-1"}},
        {{"--photons", "many"}, 2, {"--photons", "many"}},
        {{"--photons", "0"}, 2, {"photons", "0"}},
        {{"--photons", "16777217"}, 2, {"photons", "16777217", "16777216"}},
        {{"--iterations", "0"}, 2, {"iterations", "0"}},
        {{"--iterations", "1073741824"}, 2, {"iterations", "1073741824", "1073741823"}},
        {{"--time", "-1"}, 2, {"--time", "-1"}},
        {{"--time", "soon"}, 2, {"--time", "soon"}},
        {{"--size", "0x0"}, 2, {"--size", "width 0"}},
        {{"--size", "16x0"}, 2, {"--size", "height 0"}},
        {{"--size", "4000000000x4000000000"}, 2, {"--size", "4000000000"}},
        {{"--size", "large"}, 2, {"--size", "large"}},
        {{"--estimator", "magic"}, 2, {"estimator", "magic", "cppm", "sppm-kz"}},
        {{"--camera", "nowhere"}, 2, {"camera", "nowhere"}},
        {{"--camera", "99"}, 2, {"camera", "99"}},
        {{"--aperture", "-1", "--focus-distance", "1"}, 2, {"--aperture", "-1"}},
        {{"--aperture", "0.1"}, 2, {"--aperture 0.1", "--focus-distance"}},
        {{"--focus-distance", "1"}, 2, {"--focus-distance 1", "--aperture"}},
        {{"--aperture", "0.1", "--focus-distance", "0"}, 2, {"--focus-distance", "0"}},
        {{"--thin-glass", "thick"}, 2, {"--thin-glass", "thick"}},
        {{"--environment", "missing.hdr"}, 66, {"missing.hdr"}},
        {{"--environment", scene("caustic")}, 65, {"caustic.gltf", "OpenEXR"}},
        {{"--environment", "caustic.exr"}, 2, {"-o", "caustic.exr"}},
        {{"--max-depth", "0"}, 2, {"max-depth", "0"}},
        {{"--max-depth", "1025"}, 2, {"max-depth", "1025", "1024"}},
        {{"--knn", "0"}, 2, {"knn", "0"}},
        {{"--knn", "257"}, 2, {"knn", "257", "256"}},
        {{"--alpha", "0"}, 2, {"alpha", "0"}},
        {{"--alpha", "1"}, 2, {"alpha", "1"}},
        {{"--alpha", "nan"}, 2, {"alpha", "nan"}},
        {{"--k", "1.5"}, 2, {"--k", "1.5"}},
        {{"--beta", "0.5"}, 2, {"beta", "0.5"}},
        {{"--significance", "1"}, 2, {"significance", "1"}},
        {{"--rings", "0"}, 2, {"rings", "0"}},
        {{"--sectors", "0"}, 2, {"sectors", "0"}},
        {{"--exposure", "1"}, 2, {"--exposure", "--png"}},
        {{"--reference", "missing.exr"}, 66, {"missing.exr"}},
        {{"--reference", scene("caustic")}, 65, {"caustic.gltf"}},
        {{"--reference", "caustic.exr"}, 2, {"-o", "caustic.exr", "input"}},
        {{"--stop-at", "relmse=1"}, 2, {"--stop-at", "--reference"}},
        {{"--reference", "r.exr", "--stop-at", "worst=1"}, 2, {"--stop-at", "worst", "relmse_trimmed"}},
        {{"--environment", ""}, 2, {"--environment is empty"}},
        {{"-o", ""}, 2, {"-o is empty"}},
        {{"--target", "relmse"}, 2, {"--target", "'relmse'", "noise=2%"}},
        {{"--target", "psnr=30"}, 2, {"--target", "'psnr=30'", "relmse_trimmed"}},
        {{"--target", "noise=0"}, 2, {"--target", "noise=0", "greater than 0"}},
        {{"--confidence", "90"}, 2, {"--confidence", "--target"}},
        {{"--target", "noise=2%", "--confidence", "100"}, 2, {"--confidence", "'100'", "below 100"}},
        {{"--png", "caustic.exr"}, 2, {"--png", "caustic.exr"}},
        {{"-o", scene("caustic")}, 2, {"-o", "caustic.gltf"}},
        {{"--device", "no such device"}, 69, {"no such device"}},
        {{"--device", "uuid:ffffffff-ffff-ffff-ffff-ffffffffffff"}, 69, {"ffffffff-ffff"}},
        {{"-o", "missing/out.exr"}, 73, {"missing/out.exr"}},
        {{"-o", "/proc/out.exr"}, 73, {"/proc/out.exr"}},
        {{"-o", "."}, 73, {"folder"}},
        {{"-o", "./p.exr", "--png", "p.exr"}, 2, {"--png", "p.exr", "another output"}},
        {{"-o", "q.exr", "--stats", "./q.exr"}, 2, {"--stats", "q.exr", "another output"}},
        {{"-o", "./w", "--checkpoint", "w"}, 2, {"--checkpoint", "w", "another output"}},
        {{"-o", "o.png"}, 2, {"-o", "o.png", ".exr"}},
        {{"-o", "o.TIFF"}, 2, {"-o", "o.TIFF", ".exr"}},
        {{"--png", "p.exr"}, 2, {"--png", "p.exr", ".png"}},
        {{"--stats", "s.png"}, 2, {"--stats", "s.png", ".json"}},
        {{"--checkpoint", "c.exr"}, 2, {"--checkpoint", "c.exr", "a format of its own"}},
        {{"-o", "-", "--png", "-"}, 2, {"--png", "-", "another output"}},
        {{"-o", "-", "--stats", "/dev/stdout"}, 2, {"--stats", "/dev/stdout", "another output"}},
        {{"-o", "-", "--hash"}, 2, {"-o", "standard output"}},
        {{"--checkpoint", "-"}, 2, {"--checkpoint", "standard output"}},
        {{"--resume", scene("caustic")}, 2, {"--resume", "caustic.gltf", "input"}},
        {{"--at", "1"}, 2, {"--at", "--animation"}},
        {{"--animation", "walk"}, 2, {"--animation 'walk'", "there are none"}},
        {{"--variant", "red"}, 2, {"--variant 'red'", "there are none"}},
        {{"--set", "glas:ior=1.3"}, 2, {"--set 'glas'", "none of the materials", "'glass'"}},
        {{"--set", "glass:index=1.3"}, 2, {"--set 'glass:index=1.3'", "'index' is none of", "clearcoatFactor"}},
        {{"--set", "glass:ior=0"}, 2, {"--set 'glass:ior=0'", "1 or more"}},
        {{"--punctual-units", "lux"}, 2, {"--punctual-units", "'lux'", "radiometric, photometric or auto"}},
        {{"--environment-strength", "2"}, 2, {"--environment-strength", "--environment"}},
        {{"--root", "missing"}, 66, {"--root missing", "no such folder"}},
        {{"--png", "missing/out.png"}, 73, {"missing/out.png"}},
        {{"--size", "65536x65536"}, 2, {"--size", "4294967296 pixels", "2147483648"}},
        {{"--size", "65536x32768"},
         71,
         {"the render needs ", " for 65536x32768 pixels", "on the device '", "; it has ", ": --size ", " would fit"}},
        {{"--stats", "missing/out.json"}, 73, {"missing/out.json"}},
    };
    for (const Misuse& misuse : all) {
        Words words{scene("caustic")};
        words.insert(words.end(), misuse.words.begin(), misuse.words.end());
        expect_failure(run(words), misuse.code, misuse.told, shown(words));
        EXPECT_TRUE(test::names_in(folder_.path()).empty()) << shown(words) << " left a file behind";
    }
}

TEST_F(Cli, NothingThatASceneNamesIsWrittenOver) {
    test::GltfBuilder builder = test::one_triangle();
    builder.add("images", {{"uri", "unused.png"}});
    test::write_bytes(folder_ / "s.gltf", builder.gltf_with_uri("data.exr"));
    test::write_bytes(folder_ / "data.exr", builder.bytes());
    test::write_bytes(folder_ / "unused.png", "a picture");
    fs::create_directory_symlink(".", folder_ / "here");
    const Words words{"s.gltf", "--size", "4x4", "--iterations", "1", "--photons", "16", "--quiet"};
    for (const Words& outputs : std::vector<Words>{{"-o", "data.exr"},
                                                   {"-o", "here/data.exr"},
                                                   {"-o", "a.exr", "--png", "unused.png"},
                                                   {"-o", "a.exr", "--checkpoint", "s.gltf"},
                                                   {"-o", "a.exr", "--png", "here/a.exr"}}) {
        Words all = words;
        all.insert(all.end(), outputs.begin(), outputs.end());
        expect_failure(run(all), 2, {outputs.back(), "is an input or another output"}, shown(all));
        EXPECT_EQ(test::read_bytes(folder_ / "data.exr"), builder.bytes()) << shown(all);
        EXPECT_EQ(test::read_bytes(folder_ / "unused.png"), "a picture") << shown(all);
        EXPECT_FALSE(fs::exists(folder_ / "a.exr")) << shown(all);
    }
    expect_failure(run({"reference", "s.gltf", "-o", "data.exr", "--size", "4x4"}), 2, {"data.exr"}, "a reference");
    fs::rename(folder_ / "unused.png", folder_ / "winner.png");
    builder.document["images"][0]["uri"] = "winner.png";
    test::write_bytes(folder_ / "s.gltf", builder.gltf_with_uri("data.exr"));
    expect_failure(run({"race", "s.gltf", "-o", ".", "--size", "4x4", "--make-reference", "1s"}), 2, {"winner.png"},
                   "a race");
    EXPECT_EQ(test::read_bytes(folder_ / "winner.png"), "a picture");
}

TEST_F(Cli, APictureGoesIntoAPipeByADash) {
    const std::string settings = " --size 16x12 --iterations 2 --photons 500 --quiet";
    for (const char* name : {"-", "/dev/stdout"}) {
        expect_done(shell(std::string("\"$0\" \"$1\" -o ") + name + settings + " --stats s.json | cat > piped.exr"));
        expect_done(shell("\"$0\" \"$1\" -o file.exr" + settings));
        EXPECT_EQ(test::read_bytes(folder_ / "piped.exr"), test::read_bytes(folder_ / "file.exr")) << name;
        EXPECT_FALSE(fs::exists(folder_ / "-"));
    }
    expect_done(shell("\"$0\" \"$1\" -o a.exr --stats -" + settings + " > s.json"));
    EXPECT_TRUE(Json::parse(test::read_bytes(folder_ / "s.json")).contains("totals"));
    const auto closed = shell("(\"$0\" \"$1\" -o -" + settings + "; echo $? > code) | true; exit $(cat code)");
    EXPECT_TRUE(closed.exit_code == 73 || closed.exit_code == 0) << closed.err;  // 0: the pipe took all before its end
    // A file of that name is still one that can be named.
    expect_done(shell("\"$0\" \"$1\" -o ./-" + settings));
    EXPECT_TRUE(fs::exists(folder_ / "-"));
}

TEST_F(Cli, APictureIsShownOnItsWay) {
    Words words{scene("caustic"), "--size", "150x90", "--iterations", "8", "--photons", "2000", "--quiet"};
    const auto with = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    Viewer viewer;
    expect_done(with({"-o", "a.exr", "--live", "127.0.0.1:" + viewer.port()}));
    viewer.stop();
    EXPECT_EQ(viewer.fault, "");
    EXPECT_EQ(viewer.name, "a.exr");
    EXPECT_EQ(viewer.image.rgb, read_exr(folder_ / "a.exr").rgb) << "the last picture is that of the file";
    const auto alone = with({"-o", "b.exr", "--live", "127.0.0.1:" + viewer.port()});
    EXPECT_EQ(alone.exit_code, 0);
    EXPECT_EQ(lines_of(alone.err).size(), 1u) << alone.err;
    EXPECT_TRUE(contains(alone.err, "warning: --live 127.0.0.1:")) << alone.err;
    EXPECT_EQ(read_exr(folder_ / "b.exr").rgb, viewer.image.rgb);
}

TEST_F(Cli, WhatIsNoFileOrNoFolderAnyLongerIsSaidInALine) {
    const std::string settings = " --size 4x4 --iterations 1 --photons 16 --quiet";
    expect_done(shell("\"$0\" \"$1\" -o /dev/null" + settings));
    expect_failure(shell("\"$0\" \"$1\" -o /dev/full" + settings), 73, {"/dev/full: No space left on device"});
    expect_failure(shell("cat \"$1\" | \"$0\" /dev/stdin -o a.exr" + settings), 66,
                   {"/dev/stdin: it is not a regular file"});
    expect_failure(shell("mkdir gone; cd gone; rmdir ../gone; \"$0\" s.gltf -o /dev/null" + settings), 66,
                   {"s.gltf: no such file"});
    expect_failure(shell("ln -s l.exr l.exr; \"$0\" \"$1\" -o l.exr" + settings), 73, {"cannot write l.exr"});
    expect_failure(run({"help"}), 66, {"help: no such file, nor a command"});
    expect_failure(run({scene("caustic"), "--environment", "."}), 66, {"it is a folder"});
    write_exr(folder_ / "nan.exr", Image{{1, 1}, {glm::vec3(NAN)}});
    expect_failure(run({"compare", "nan.exr", "nan.exr"}), 65, {"no pixel is finite in both"});
}

TEST_F(Cli, WarningsEndAStrictRunAndStandInTheStatistics) {
    test::GltfBuilder builder = test::one_triangle();
    test::write_bytes(folder_ / "s.gltf", builder.gltf());
    const Words words{"s.gltf", "--size", "4x4", "--iterations", "1", "--photons", "16", "-o", "a.exr"};
    Words strict = words;
    strict.push_back("--strict");
    expect_failure(run(strict), 65, {"s.gltf", "warnings", "--strict"}, "a warning");
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
    expect_failure(run({"info", "s.gltf", "--strict"}), 65, {"--strict"}, "info");
    Words plain = words;
    plain.insert(plain.end(), {"--stats", "s.json"});
    const auto result = run(plain);
    expect_done(result);
    const Json warnings = Json::parse(test::read_bytes(folder_ / "s.json")).at("warnings");
    std::vector<std::string> told;
    for (const std::string& line : lines_of(result.err)) {
        if (line.starts_with("warning: ")) told.push_back(line.substr(9));
    }
    EXPECT_EQ(warnings.get<std::vector<std::string>>(), told);
    EXPECT_FALSE(told.empty());
}

TEST_F(Cli, ASceneIsNeeded) {
    test::write_bytes(folder_ / "text.gltf", "no scene");
    test::write_bytes(folder_ / "cut.gltf", test::read_bytes(scene("caustic")).substr(0, 2000));
    test::write_bytes(folder_ / "empty.glb", "");
    for (const Words& words : {Words{}, Words{"info"}}) {
        const auto with = [&](const std::string& file) {
            Words all = words;
            all.push_back(file);
            return run(all);
        };
        expect_failure(run(words), 2, {"SCENE"}, shown(words));
        expect_failure(with("missing.gltf"), 66, {"missing.gltf"}, "missing");
        expect_failure(with("."), 66, {}, "a folder");
        expect_failure(with("text.gltf"), 65, {"text.gltf"}, "text");
        expect_failure(with("cut.gltf"), 65, {"cut.gltf"}, "cut");
        expect_failure(with("empty.glb"), 65, {"empty.glb"}, "empty");
    }
}

struct Hostile {
    std::string file;
    int code;
    Words told;  // of the error
    std::string bytes;
};

std::string faulty(std::string_view name) {
    test::GltfBuilder builder = test::one_triangle();
    std::ranges::find(test::faults(), name, &test::Fault::name)->make(builder);
    return builder.gltf();
}

TEST_F(Cli, HostileFilesHaveTheirExitCodeAndTheirLine) {
    const test::GltfBuilder triangle = test::one_triangle();
    std::string cut = triangle.glb();
    cut.resize(cut.size() - 8);
    const std::vector<Hostile> all = {
        {"missing_bin.gltf", 65, {"buffers[0]", "gone.bin", "no such file"}, triangle.gltf_with_uri("gone.bin")},
        {"other_host.gltf", 65, {"buffers[0] is absent", "http://a.b"}, triangle.gltf_with_uri("http://a.b/c.bin")},
        {"ancestor.gltf", 65, {"nodes[0]", "ancestor"}, faulty("Cycle")},
        {"index.gltf", 65, {"nodes[0].children[0] is -1"}, faulty("Child")},
        {"vertex.gltf", 65, {"indices"}, faulty("IndexRange")},
        {"huge.gltf", 65, {"bufferViews[0].byteOffset is 18446744073709551600"}, faulty("ViewOverflow")},
        {"type.gltf", 65, {"meshes is 3", "array"}, faulty("WrongTypeOfArray")},
        {"cut.glb", 65, {"GLB length"}, cut},
        {"cut.gltf", 65, {"cut.gltf"}, triangle.gltf().substr(0, 100)},
        {"triangle.gltf", 0, {}, triangle.gltf()},
        {"everything.glb", 0, {}, test::everything().glb()},
    };
    for (const Hostile& hostile : all) {
        SCOPED_TRACE(hostile.file);
        test::write_bytes(folder_ / hostile.file, hostile.bytes);
        const auto result =
            run({hostile.file, "-o", "out.exr", "--size", "8x6", "--iterations", "2", "--photons", "500", "--quiet"});
        if (hostile.code == 0) {
            expect_done(result);
            EXPECT_FALSE(contains(result.err, "error: ")) << result.err;
        } else {
            expect_failure(result, hostile.code, hostile.told, hostile.file);
            EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
        }
        EXPECT_EQ(fs::remove(folder_ / "out.exr"), hostile.code == 0) << "whether there is a picture";
    }
}

TEST_F(Cli, AFailureLeavesAGoodPictureAlone) {
    test::write_bytes(folder_ / "good.exr", "good");
    test::write_bytes(folder_ / "text.gltf", "no scene");
    EXPECT_EQ(run({"text.gltf", "-o", "good.exr"}).exit_code, 65);
    EXPECT_EQ(run({"missing.gltf", "-o", "good.exr"}).exit_code, 66);
    EXPECT_EQ(run({scene("caustic"), "-o", "good.exr", "--alpha", "7"}).exit_code, 2);
    EXPECT_EQ(run({scene("caustic"), "-o", "good.exr", "--device", "no such device"}).exit_code, 69);
    EXPECT_EQ(test::read_bytes(folder_ / "good.exr"), "good");
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"good.exr", "text.gltf"}));
}

TEST_F(Cli, AFullDiskIsNoticedAndLeavesNothing) {
    if (test::limit_stops_the_driver(4)) GTEST_SKIP() << test::memory_in_files;
    test::write_bytes(folder_ / "good.exr", "good");
    // The shell's own limit on the size of files, in blocks of 512 bytes; the picture needs 49 KiB before compression.
    const auto result =
        shell("ulimit -f 4; exec \"$0\" \"$1\" --size 64x64 --iterations 1 --photons 5000 --quiet -o good.exr");
    expect_failure(result, 73, {"good.exr", "File too large"}, "full disk");
    EXPECT_EQ(test::read_bytes(folder_ / "good.exr"), "good");
    EXPECT_EQ(test::names_in(folder_.path()), std::set<std::string>{"good.exr"});
    const auto both = shell(
        "ulimit -f 4; exec \"$0\" \"$1\" --size 64x64 --iterations 1 --photons 5000 --quiet -o good.exr --png "
        "black.png "
        "--exposure -128 --stats /dev/full");
    expect_failure(both, 73, {"good.exr: File too large; cannot write /dev/full"}, "each file that cannot be written");
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"black.png", "good.exr"})) << "the one that can";
    fs::remove(folder_ / "black.png");
    const auto reference = shell(
        "ulimit -f 4; exec \"$0\" reference \"$1\" --size 64x48 --samples 128 --iterations 32 "
        "--photons 500 --quiet -o good.exr");
    expect_failure(reference, 73, {"good.exr", "File too large"}, "a reference on a full disk");
    EXPECT_EQ(test::read_bytes(folder_ / "good.exr"), "good");
    EXPECT_EQ(test::names_in(folder_.path()), std::set<std::string>{"good.exr"});
}

// ---- Streams that take nothing

TEST_F(Cli, UnwritableStandardOutputIsAnError) {
    for (const char* script : {"exec \"$0\" devices > /dev/full", "exec \"$0\" devices >&-",
                               "exec \"$0\" info \"$1\" --json > /dev/full", "exec \"$0\" --help > /dev/full"}) {
        const auto result = shell(script);
        EXPECT_EQ(result.exit_code, 73) << script << "\n" << result.err;
        EXPECT_TRUE(contains(result.err, "error: cannot write to standard output")) << script << "\n" << result.err;
    }
    expect_failure(shell("exec \"$0\" missing.gltf -o - >&-"), 73, {"cannot write -", "closed"},
                   "a picture, before the scene is looked for");
}

TEST_F(Cli, ClosedStreamsDoNotHurtThePicture) {
    const std::string options = " \"$1\" --size 16x12 --iterations 2 --photons 500 ";
    expect_done(shell("exec \"$0\"" + options + "-o plain.exr"));
    expect_done(shell("exec \"$0\"" + options + "-o closed.exr <&- >&- 2>&-"));
    expect_done(shell("exec \"$0\"" + options + "-o full.exr 2> /dev/full"));
    // Pipes whose readers have gone: the exit code is kept in a file.
    for (const char* command : {"devices", "info \"$1\"", "--help"}) {
        shell(std::string("(sleep 0.2; \"$0\" ") + command + " 2> error; echo $? > code) | true");
        EXPECT_EQ(test::read_bytes(folder_ / "code"), "73\n") << command;
        EXPECT_EQ(test::read_bytes(folder_ / "error"), "error: cannot write to standard output: Broken pipe\n");
    }
    shell("(\"$0\"" + options + "-o pipe.exr 2>&1; echo $? > code) | true");
    EXPECT_EQ(test::read_bytes(folder_ / "code"), "0\n");
    const std::string plain = test::read_bytes(folder_ / "plain.exr");
    EXPECT_FALSE(plain.empty());
    for (const char* name : {"closed.exr", "full.exr", "pipe.exr"}) {
        EXPECT_TRUE(test::read_bytes(folder_ / name) == plain) << name << " differs";
    }
}

// ---- Rendering

TEST_F(Cli, WritesPictureViewAndStatistics) {
    const auto result =
        render({"-o", "a.exr", "--png", "a.png", "--exposure", "1", "--stats", "a.json", "--seed", "3"});
    expect_done(result);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"a.exr", "a.png", "a.json"}));

    const Image image = read_exr(folder_ / "a.exr");
    EXPECT_EQ(image.extent, (Extent{16, 12}));
    EXPECT_TRUE(std::any_of(image.rgb.begin(), image.rgb.end(), [](const glm::vec3& p) { return p.g > 0.0f; }));
    EXPECT_TRUE(test::read_bytes(folder_ / "a.png").starts_with("\x89PNG\r\n"));

    const auto text = attributes("a.exr");
    const std::map<std::string, std::string> expected = {{"vkcppm.scene", "caustic.gltf"},
                                                         {"vkcppm.estimator", "cppm"},
                                                         {"vkcppm.seed", "3"},
                                                         {"vkcppm.iterations", "2"},
                                                         {"vkcppm.iterations_done", "2"},
                                                         {"vkcppm.photons", "500"},
                                                         {"vkcppm.size", "16x12"},
                                                         {"vkcppm.emitted_photons", "1000"},
                                                         {"vkcppm.max_depth", "64"},
                                                         {"vkcppm.knn", "10"},
                                                         {"vkcppm.k", "0.8"},
                                                         {"vkcppm.beta", "1.2"},
                                                         {"vkcppm.significance", "0.05"},
                                                         {"vkcppm.rings", "2"},
                                                         {"vkcppm.sectors", "6"},
                                                         {"vkcppm.aperture", "0.0"},
                                                         {"vkcppm.thin_glass", "thin"}};
    for (const auto& [name, value] : expected) {
        ASSERT_TRUE(text.contains(name)) << name;
        EXPECT_EQ(text.at(name), value) << name;
    }
    EXPECT_DOUBLE_EQ(std::stod(text.at("vkcppm.alpha")), 2.0 / 3.0);
    for (const char* name : {"vkcppm.device", "vkcppm.driver", "vkcppm.version", "vkcppm.camera"}) {
        ASSERT_TRUE(text.contains(name)) << name;
    }
    EXPECT_NE(text.at("vkcppm.device"), "");

    const Json stats = Json::parse(test::read_bytes(folder_ / "a.json"));
    const Json& totals = stats.at("totals");
    EXPECT_EQ(totals.at("iterations"), 2);
    EXPECT_EQ(totals.at("emitted_paths"), 1000);
    for (const char* name : {"stored_photons", "rays", "wall_seconds", "cpu_seconds", "setup_seconds",
                             "peak_memory_bytes", "device_memory_bytes"}) {
        EXPECT_GT(totals.at(name).get<double>(), 0.0) << name;
    }
    EXPECT_EQ(stats.at("device"), text.at("vkcppm.device"));
    EXPECT_EQ(stats.at("driver"), text.at("vkcppm.driver"));
    EXPECT_EQ(stats.at("version"), text.at("vkcppm.version"));
    EXPECT_EQ(stats.at("scene").at("hash"), text.at("vkcppm.scene_hash"));
    EXPECT_EQ(stats.at("settings").at("photons"), 500);
    ASSERT_FALSE(stats.at("passes").empty());
    double device_seconds = 0.0;
    for (const Json& pass : stats.at("passes")) {
        EXPECT_NE(pass.at("name"), "");
        EXPECT_GT(pass.at("calls").get<int>(), 0) << pass;
        device_seconds += pass.at("device_seconds").get<double>();
    }
    EXPECT_GT(device_seconds, 0.0);
    std::map<std::string, Json> memory;
    std::uint64_t bytes = 0;
    for (const Json& row : stats.at("memory")) {
        memory[row.at("of")] = row;
        bytes += row.at("bytes").get<std::uint64_t>();
        EXPECT_DOUBLE_EQ(row.at("bytes_each").get<double>() * row.at("count").get<double>(), row.at("bytes")) << row;
    }
    EXPECT_EQ(bytes, totals.at("device_memory_bytes")) << stats.at("memory");
    EXPECT_EQ(memory.at("pixel").at("count"), 16 * 12);
    EXPECT_EQ(memory.at("triangle").at("count"), stats.at("scene").at("triangles"));
    EXPECT_EQ(memory.at("triangle").at("bytes_each"), 64) << "geometry and shading";
    EXPECT_EQ(memory.at("photon slot").at("bytes_each"), 80) << "place and flux, twice, and two keys to sort by";
    EXPECT_EQ(memory.at("node").at("bytes_each"), 64);
}

TEST_F(Cli, AReferenceTellsItsErrorAndHowToMakeItAgain) {
    const Words words{"reference", scene("caustic"), "--size", "16x12",   "--samples", "128",        "--iterations",
                      "32",        "--photons",      "500",    "--quiet", "--json",    "--validate", "-o"};
    const auto with = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        return run(all);
    };
    const auto result = with({"a.exr", "--stats", "a.json"});
    expect_done(result);
    EXPECT_EQ(result.err, "");
    const Json summary = Json::parse(result.out);
    const Json& error = summary.at("error");
    EXPECT_EQ(error.at("samples_done"), 128);
    EXPECT_EQ(error.at("iterations_done"), 32);
    for (const char* name : {"mse", "srgb_mse", "relmse", "relmse_paths", "relmse_caustics", "caustic_share",
                             "median_error", "error_99"}) {
        EXPECT_GT(error.at(name).get<double>(), 0.0) << name;
    }
    EXPECT_EQ(read_exr(folder_ / "a.exr").extent, (Extent{16, 12}));
    const auto text = attributes("a.exr");
    for (const auto& [name, value] : std::map<std::string, std::string>{{"vkcppm.scene", "caustic.gltf"},
                                                                        {"vkcppm.samples_done", "128"},
                                                                        {"vkcppm.iterations_done", "32"},
                                                                        {"vkcppm.photons", "500"},
                                                                        {"vkcppm.size", "16x12"},
                                                                        {"vkcppm.trust", "0.05"}}) {
        ASSERT_TRUE(text.contains(name)) << name;
        EXPECT_EQ(text.at(name), value) << name;
    }
    EXPECT_EQ(Json::parse(test::read_bytes(folder_ / "a.json")).at("passes").at(0).at("name"), "path");

    // Again, and small; a picture measures against it.
    expect_done(with({"b.exr"}));
    EXPECT_EQ(test::read_bytes(folder_ / "a.exr"), test::read_bytes(folder_ / "b.exr"));
    expect_done(with({"c.exr", "--half"}));
    EXPECT_LT(fs::file_size(folder_ / "c.exr"), 0.7 * double(fs::file_size(folder_ / "a.exr")));
    expect_done(run({"compare", "c.exr", "a.exr"}));
}

TEST_F(Cli, AReferenceRefusesWhatItCannotMake) {
    const auto reference = [&](Words more) {
        more.insert(more.begin(), {"reference", scene("caustic"), "--size", "8x6", "-o", "a.exr"});
        return run(more);
    };
    expect_failure(reference({"--samples", "127"}), 2, {"--samples 127", "128"}, "too few paths");
    expect_failure(reference({"--iterations", "31"}), 2, {"--iterations 31", "32"}, "too few iterations");
    expect_failure(reference({"--trust", "0"}), 2, {"--trust 0"}, "no trust");
    expect_failure(run({"reference", scene("caustic"), "-o", scene("caustic")}), 2, {"-o", "input"}, "its own input");
    expect_failure(run({"reference", scene("caustic")}), 2, {"-o"}, "nowhere to write");
}

TEST_F(Cli, StatsNameTheEnvironmentAndTheLens) {
    write_exr(folder_ / "sky.exr", Image{{2, 1}, {{1, 1, 1}, {2, 2, 2}}});
    expect_done(render({"-o", "a.exr", "--stats", "a.json", "--environment", (folder_ / "sky.exr").string(),
                        "--thin-glass", "solid", "--aperture", "0.125", "--focus-distance", "2.5"}));
    const auto text = attributes("a.exr");
    EXPECT_EQ(text.at("vkcppm.environment"), "sky.exr");
    EXPECT_EQ(text.at("vkcppm.thin_glass"), "solid");
    EXPECT_EQ(text.at("vkcppm.aperture"), "0.125");
    EXPECT_EQ(text.at("vkcppm.focus_distance"), "2.5");
    const Json stats = Json::parse(test::read_bytes(folder_ / "a.json"));
    EXPECT_EQ(stats.at("scene").at("environment"), (folder_ / "sky.exr").string());
    EXPECT_EQ(stats.at("scene").at("thin_glass"), "solid");
    EXPECT_EQ(stats.at("settings").at("focus_distance"), 2.5);

    expect_done(render({"-o", "b.exr"}));
    EXPECT_FALSE(attributes("b.exr").contains("vkcppm.environment"));
    EXPECT_FALSE(attributes("b.exr").contains("vkcppm.focus_distance"));
    EXPECT_NE(attributes("b.exr").at("vkcppm.scene_hash"), text.at("vkcppm.scene_hash"));
    expect_failure(render({"-o", "sky.exr", "--environment", "sky.exr"}), 2, {"-o", "sky.exr", "input"}, "overwrite");
}

TEST_F(Cli, ThePictureIsNamedAfterTheScene) {
    expect_done(render({}));
    EXPECT_EQ(test::names_in(folder_.path()), std::set<std::string>{"caustic.exr"});
}

TEST_F(Cli, OneSeedGivesTheSameBytesAndAnotherDoesNot) {
    expect_done(render({"-o", "a.exr", "--seed", "7"}));
    expect_done(render({"-o", "b.exr", "--seed", "7"}));
    expect_done(render({"-o", "c.exr", "--seed", "8"}));
    EXPECT_TRUE(test::read_bytes(folder_ / "a.exr") == test::read_bytes(folder_ / "b.exr"));
    EXPECT_NE(read_exr(folder_ / "a.exr"), read_exr(folder_ / "c.exr"));
}

TEST_F(Cli, EveryEstimatorRenders) {
    for (const char* estimator : {"cppm", "sppm", "sppm-kz"}) {
        expect_done(render({"-o", std::string(estimator) + ".exr", "--estimator", estimator}));
        EXPECT_EQ(attributes(std::string(estimator) + ".exr").at("vkcppm.estimator"), estimator);
    }
}

TEST_F(Cli, TheTimeLimitEndsTheRender) {
    const auto result = run({scene("caustic"), "--size", "16x12", "--photons", "500", "--time", "300ms", "--quiet"});
    expect_done(result);
    const auto text = attributes("caustic.exr");
    EXPECT_EQ(text.at("vkcppm.iterations"), "1073741823");
    EXPECT_EQ(text.at("vkcppm.time"), "0.3");
    EXPECT_GE(std::stoull(text.at("vkcppm.iterations_done")), 1u);
}

TEST_F(Cli, ProgressIsPlainLinesWithoutATerminalAndNothingWhenQuiet) {
    const Words words{scene("caustic"), "--size", "16x12", "--photons", "500", "--iterations", "3"};
    const auto result = run(words);
    expect_done(result);
    EXPECT_TRUE(contains(result.err, "/3 iterations (")) << result.err;
    EXPECT_TRUE(contains(result.err, "3 iterations in ")) << result.err;
    EXPECT_TRUE(contains(result.err, "wrote caustic.exr")) << result.err;
    EXPECT_FALSE(contains(result.err, "\r") || contains(result.err, "\x1b")) << result.err;

    const auto quiet = render({});
    EXPECT_FALSE(contains(quiet.err, "iterations") || contains(quiet.err, "wrote")) << quiet.err;

    const auto verbose = render({"--verbose"});
    EXPECT_TRUE(contains(verbose.err, "device s")) << verbose.err;
    EXPECT_TRUE(contains(verbose.err, "1000 emitted paths")) << verbose.err;
}

// ---- Measuring on the way

class CliReference : public Cli {
protected:
    void SetUp() override { expect_done(plain({"-o", "ref.exr", "--seed", "2", "--iterations", "64"})); }

    /// A render of the reference's size and another seed, against it.
    test::ProcessResult measured(Words more) const {
        more.insert(more.begin(), {"--reference", "ref.exr"});
        return plain(more);
    }

    /// The same without the reference.
    test::ProcessResult plain(Words more) const {
        Words words{scene("caustic"), "--size", "16x12", "--photons", "500"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    Json stats(const std::string& name) const { return Json::parse(test::read_bytes(folder_ / name)); }

    /// The errors of a picture as compare tells them.
    Json compared(const std::string& name) const {
        const auto result = run({"compare", name, "ref.exr", "--json"});
        expect_done(result);
        return Json::parse(result.out);
    }

    /// What the snapshot after `iterations` should be: the errors of a picture of as many iterations.
    Json errors_after(std::uint64_t iterations) const {
        expect_done(plain({"-o", "short.exr", "--iterations", std::to_string(iterations), "--quiet"}));
        return compared("short.exr");
    }
};

std::vector<std::uint64_t> iterations_of(const Json& curve) {
    std::vector<std::uint64_t> iterations;
    for (const Json& point : curve) iterations.push_back(point.at("iterations"));
    return iterations;
}

/// Every metric of the snapshot is that of the comparison, to the last bit.
void expect_same_errors(const Json& point, const Json& comparison) {
    for (const Metric& metric : metrics()) {
        EXPECT_EQ(point.at(metric.name), comparison.at(metric.name))
            << metric.name << " after " << point.at("iterations") << " iterations";
    }
}

TEST_F(CliReference, TheCurveHoldsTheErrorsOfThePicturesOnTheWay) {
    const auto result = measured({"-o", "a.exr", "--stats", "a.json", "--iterations", "11"});
    expect_done(result);
    const Json text = stats("a.json");
    const Json& curve = text.at("curve");
    ASSERT_EQ(iterations_of(curve), (std::vector<std::uint64_t>{1, 2, 4, 8, 11}));
    for (const Json& point : curve) expect_same_errors(point, errors_after(point.at("iterations")));
    expect_same_errors(curve.back(), compared("a.exr"));
    EXPECT_TRUE(test::read_bytes(folder_ / "short.exr") == test::read_bytes(folder_ / "a.exr"))
        << "the picture, or what it says of itself, is another where it is measured";

    // On the clock are the passes of iterations: all that the table of passes has but the snapshots themselves.
    double seconds = 0.0;
    for (const Json& point : curve) {
        EXPECT_GT(point.at("seconds").get<double>(), seconds) << point;
        seconds = point.at("seconds");
    }
    double passes = 0.0, snapshots = 0.0;
    for (const Json& pass : text.at("passes")) {
        (pass.at("name") == "resolve" ? snapshots : passes) += pass.at("device_seconds").get<double>();
    }
    EXPECT_NEAR(seconds, passes, 1e-9 * passes) << snapshots << " s of resolve";

    EXPECT_EQ(text.at("reference"), "ref.exr");
    EXPECT_FALSE(text.contains("stop_at"));
    EXPECT_TRUE(contains(lines_of(result.err).front(), ", relmse ")) << result.err;
    const std::string last = fmt::format(", relmse {:.3g}\n", curve.back().at("relmse").get<double>());
    EXPECT_TRUE(contains(result.err, "11 iterations in ") && contains(result.err, last)) << last << result.err;
}

TEST_F(CliReference, TheSameRenderHasTheSameCurve) {
    for (const char* name : {"a", "b"}) {
        expect_done(measured({"-o", "a.exr", "--stats", std::string(name) + ".json", "--iterations", "70", "--quiet"}));
    }
    Json a = stats("a.json").at("curve"), b = stats("b.json").at("curve");
    ASSERT_EQ(iterations_of(a), (std::vector<std::uint64_t>{1, 2, 4, 8, 16, 32, 64, 70}));
    for (Json* curve : {&a, &b}) {
        for (Json& point : *curve) point.erase("seconds");
    }
    EXPECT_EQ(a, b);
}

TEST_F(CliReference, TheCurveOfALimitedTimeEndsWithTheLastIteration) {
    expect_done(measured({"-o", "a.exr", "--stats", "a.json", "--time", "50ms", "--quiet"}));
    const Json text = stats("a.json");
    EXPECT_EQ(text.at("curve").back().at("iterations"), text.at("totals").at("iterations"));
    expect_same_errors(text.at("curve").back(), compared("a.exr"));
}

TEST_F(CliReference, StopsAfterTheFirstIterationThatIsNearEnough) {
    // A render of 1, 2, 3, ... iterations each; the level is the error of the seventh.
    std::vector<double> errors;
    for (std::uint64_t i = 1; i <= 7; ++i) errors.push_back(errors_after(i).at("smape_trimmed"));
    const double level = errors.back();
    const std::string errors_text = Json(errors).dump();
    ASSERT_EQ(std::count_if(errors.begin(), errors.end(), [&](double error) { return error <= level; }), 1)
        << "the seventh is not the first below its own level, choose another: " << errors_text;
    const std::string goal = "smape_trimmed=" + Json(level).dump();
    const auto result = measured({"-o", "a.exr", "--stats", "a.json", "--stop-at", goal});
    expect_done(result);
    EXPECT_EQ(attributes("a.exr").at("vkcppm.iterations_done"), "7") << goal << " of " << errors_text;
    EXPECT_EQ(read_exr(folder_ / "a.exr"), read_exr(folder_ / "short.exr"));
    const Json text = stats("a.json");
    EXPECT_EQ(iterations_of(text.at("curve")), (std::vector<std::uint64_t>{1, 2, 4, 7}));
    EXPECT_EQ(text.at("stop_at"), Json({{"metric", "smape_trimmed"}, {"value", level}, {"reached", true}}));
    EXPECT_TRUE(contains(result.err, "7 iterations in ")) << result.err;
    EXPECT_TRUE(contains(result.err, "was reached")) << result.err;
}

TEST_F(CliReference, SaysWhereTheErrorWasNotReached) {
    const auto result =
        measured({"-o", "a.exr", "--stats", "a.json", "--iterations", "3", "--stop-at", "mse=1e-9", "--quiet"});
    expect_done(result);
    EXPECT_TRUE(contains(result.err, "warning: mse ") && contains(result.err,
                                                                  " after 3 iterations: --stop-at 1e-09 "
                                                                  "was not reached"))
        << result.err;
    EXPECT_EQ(stats("a.json").at("stop_at").at("reached"), false);
}

TEST_F(CliReference, RefusesAReferenceThatItCannotMeasureBy) {
    Image image = read_exr(folder_ / "ref.exr");
    image.rgb[16 * 3 + 5].g = std::numeric_limits<float>::quiet_NaN();
    image.rgb[16 * 4].b = std::numeric_limits<float>::infinity();
    write_exr(folder_ / "nan.exr", image);
    test::write_bytes(folder_ / "text.exr", "no picture");
    expect_failure(run({scene("caustic"), "--reference", "ref.exr", "--size", "16x13"}), 2,
                   {"ref.exr", "16x12", "16x13"}, "size");
    expect_failure(plain({"--reference", "nan.exr"}), 65, {"nan.exr", "2 of 192", "column 5, row 3"}, "NaN");
    expect_failure(plain({"--reference", "text.exr"}), 65, {"text.exr"}, "no picture");
    expect_failure(plain({"--reference", "ref.exr", "-o", "ref.exr"}), 2, {"-o", "ref.exr", "input"}, "the picture");
    expect_failure(plain({"--reference", "ref.exr", "--stats", "./ref.exr"}), 2, {"--stats", "ref.exr"}, "statistics");
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"nan.exr", "ref.exr", "text.exr"}));
}

class CliSignal : public Cli, public testing::WithParamInterface<int> {};

TEST_P(CliSignal, KeepsWhatThereIs) {
    test::Process process({test::program(), scene("caustic"), "--size", "16x12", "--photons", "500", "--time", "600s",
                           "-o", "a.exr", "--stats", "a.json"},
                          folder_.path());
    ASSERT_TRUE(process.wait_for_message(" iterations")) << process.wait().err;
    process.send(GetParam());
    const auto result = process.wait();
    expect_done(result);
    const std::string done = attributes("a.exr").at("vkcppm.iterations_done");
    EXPECT_TRUE(contains(result.err, "interrupted after " + done + " iterations\n")) << result.err;
    EXPECT_TRUE(contains(result.err, "wrote a.exr\n")) << result.err;
    EXPECT_GE(std::stoull(done), 1u);
    const Json stats = Json::parse(test::read_bytes(folder_ / "a.json"));
    EXPECT_EQ(stats.at("totals").at("iterations").dump(), done);
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"a.exr", "a.json"}));
}

INSTANTIATE_TEST_SUITE_P(, CliSignal, testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& info) {
    return info.param == SIGINT ? "SIGINT" : info.param == SIGTERM ? "SIGTERM" : "SIGHUP";
});

TEST_F(Cli, AnInterruptedPictureIsThatOfAsManyIterations) {
    const Words words{scene("caustic"), "--size", "16x12", "--photons", "500", "-o"};
    Words long_words = words;
    long_words.insert(long_words.begin(), test::program());
    long_words.insert(long_words.end(), {"cut.exr", "--iterations", "1073741823"});
    test::Process process(long_words, folder_.path());
    ASSERT_TRUE(process.wait_for_message(" iterations")) << process.wait().err;
    process.send(SIGINT);
    expect_done(process.wait());
    Words short_words = words;
    short_words.insert(short_words.end(),
                       {"whole.exr", "--iterations", attributes("cut.exr").at("vkcppm.iterations_done")});
    expect_done(run(short_words));
    EXPECT_EQ(read_exr(folder_ / "cut.exr"), read_exr(folder_ / "whole.exr"));
}

TEST_F(Cli, TheValidationLayerHasNothingToSay) {
    const auto result = render({"--validate"});
    if (result.exit_code == 69) GTEST_SKIP() << result.err;
    expect_done(result);
}

}  // namespace
}  // namespace vkcppm
