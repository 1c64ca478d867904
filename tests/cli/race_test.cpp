// vkcppm race as a user meets it.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "io/exr.h"
#include "support/files/files.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace test;

class RaceCli : public ProgramTest {
protected:
    /// A race that takes a moment, into `out`.
    test::ProcessResult race(const std::string& out, Words more) const {
        Words words{"race", scene("torus"), "-o", out, "--photons", "1000", "--iterations", "5", "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    /// ref.exr of 32x24 pixels, of the torus.
    void make_reference() const {
        const auto result = run({scene("torus"), "-o", "ref.exr", "--size", "32x24", "--photons", "4000",
                                 "--iterations", "9", "--seed", "77", "--quiet"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }

    /// The lines of a curves.csv without their seconds.
    std::vector<std::string> curves(const std::string& file) const {
        std::vector<std::string> lines;
        std::istringstream stream(test::read_bytes(folder_ / file));
        for (std::string line; std::getline(stream, line);) {
            std::vector<std::string> cells;
            std::istringstream of_line(line);
            for (std::string cell; std::getline(of_line, cell, ',');) cells.push_back(cell);
            std::string kept;
            for (std::size_t i = 0; i < cells.size(); ++i) kept += i == 3 ? "" : cells[i] + ",";
            lines.push_back(kept);
        }
        return lines;
    }

    Json json(const std::string& file) const { return Json::parse(test::read_bytes(folder_ / file)); }
};

TEST_F(RaceCli, TwiceGivesTheSameCurvesAndPictures) {
    make_reference();
    const Words words{"--reference", "ref.exr", "--estimators", "cppm,sppm:alpha=0.5", "--seeds", "2"};
    for (const char* out : {"a", "b/c"}) {
        const auto result = race(out, words);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.out + result.err, "");
    }
    const std::vector<std::string> first = curves("a/curves.csv");
    EXPECT_EQ(first.size(), 1u + 2 * 2 * 4) << "after 1, 2, 4 and 5 iterations, two entrants, two seeds";
    EXPECT_EQ(curves("b/c/curves.csv"), first);
    EXPECT_EQ(test::names_in(folder_ / "a"),
              (std::set<std::string>{"cppm-difference.png", "cppm-radius.png", "cppm.exr", "cppm.png", "curves.csv",
                                     "index.html", "race.json", "reference.exr", "reference.png",
                                     "sppm-alpha-0.5-difference.png", "sppm-alpha-0.5-radius.png", "sppm-alpha-0.5.exr",
                                     "sppm-alpha-0.5.png", "winner-around.png", "winner.png"}));
    for (const std::string& name : test::names_in(folder_ / "a")) {
        if (!name.ends_with(".exr") && !name.ends_with(".png")) continue;
        EXPECT_EQ(test::read_bytes(folder_ / "a" / name), test::read_bytes(folder_ / "b" / "c" / name)) << name;
    }
    const Json told = json("a/race.json");
    EXPECT_EQ(told["width"], 32);
    EXPECT_EQ(told["baseline"], "sppm:alpha=0.5");
    EXPECT_EQ(told["seeds"], Json({1, 2}));
    EXPECT_EQ(told["entrants"][1]["settings"]["alpha"], 0.5);
    EXPECT_EQ(told["interrupted"], false);
    EXPECT_TRUE(contains(told["command"], "vkcppm race ")) << told["command"];
}

TEST_F(RaceCli, TellsTheLayersOfEveryEntrant) {
    make_reference();
    const auto result = race("layers", {"--reference", "ref.exr", "--estimators", "cppm", "--aovs"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::set<std::string> names = test::names_in(folder_ / "layers");
    for (const char* layer : {"direct", "caustic", "rest"}) {
        EXPECT_TRUE(names.contains(fmt::format("cppm-{}.png", layer))) << layer;
    }
    const auto plain = race("plain", {"--reference", "ref.exr", "--estimators", "cppm"});
    ASSERT_EQ(plain.exit_code, 0) << plain.err;
    EXPECT_EQ(test::read_bytes(folder_ / "layers/cppm.png"), test::read_bytes(folder_ / "plain/cppm.png"));
    const ExrChannels channels = read_exr_channels(folder_ / "layers/cppm.exr", "");
    for (std::size_t i = 0; i < channels.extent.pixels(); ++i) {
        double sum = 0.0;
        for (const char* layer : {"direct.R", "caustic.R", "rest.R"}) sum += channels.values.at(layer)[i];
        const double whole = channels.values.at("R")[i];
        EXPECT_NEAR(sum, whole, 1e-5 * std::abs(whole) + 1e-7) << "pixel " << i;
    }
}

TEST_F(RaceCli, GoesOnWithMoreIterationsAndSeeds) {
    make_reference();
    const auto with = [&](const std::string& out, Words more) {
        Words words{"race", scene("torus"), "-o", out, "--photons", "1000", "--quiet", "--reference", "ref.exr"};
        words.insert(words.end(), {"--estimators", "cppm,sppm"});
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    expect_done(with("a", {"--iterations", "3", "--checkpoint"}));
    EXPECT_EQ(test::names_in(folder_ / "a/states"), (std::set<std::string>{"cppm-1.ckpt", "sppm-1.ckpt"}));
    expect_done(with("b", {"--iterations", "5", "--seeds", "2", "--resume", "a"}));
    expect_done(with("whole", {"--iterations", "5", "--seeds", "2"}));
    const auto ends = [&](const std::string& folder) {
        std::vector<std::string> lines = curves(folder + "/curves.csv");
        std::erase_if(lines, [](const std::string& line) { return !contains(line, ",5,"); });
        return lines;
    };
    EXPECT_EQ(ends("whole").size(), 4u);
    EXPECT_EQ(ends("b"), ends("whole"));
    EXPECT_EQ(test::names_in(folder_ / "b/states").size(), 4u);
    for (const char* picture : {"cppm.exr", "sppm.exr", "winner.png"})
        EXPECT_EQ(test::read_bytes(folder_ / "b" / picture), test::read_bytes(folder_ / "whole" / picture)) << picture;
    expect_failure(with("c", {"--iterations", "5", "--resume", "a", "--knn", "12"}), 2, {"another render", "knn: 10"});
    expect_failure(with("c", {"--iterations", "5", "--resume", "whole"}), 66, {"no states in whole", "--checkpoint"});
}

TEST_F(RaceCli, ThePictureIsThatOfARenderAndTheErrorThatOfCompare) {
    make_reference();
    ASSERT_EQ(race("out", {"--reference", "ref.exr", "--estimators", "appm,cppm"}).exit_code, 0);
    ASSERT_EQ(run({scene("torus"), "-o", "alone.exr", "--size", "32x24", "--photons", "1000", "--iterations", "5",
                   "--estimator", "appm", "--quiet"})
                  .exit_code,
              0);
    EXPECT_EQ(read_exr(folder_ / "alone.exr"), read_exr(folder_ / "out/appm.exr"));
    const ExrAttributes alone = read_exr_attributes(folder_ / "alone.exr");
    EXPECT_EQ(read_exr_attributes(folder_ / "out/appm.exr"), alone) << "the same settings make it again";
    EXPECT_EQ(read_exr(folder_ / "out/reference.exr"), read_exr(folder_ / "ref.exr"));
    const Json told = json("out/race.json")["entrants"][0]["runs"][0]["curve"].back();
    const auto compared = run({"compare", "alone.exr", "ref.exr", "--json"});
    for (const char* metric : {"mse", "relmse_trimmed", "srgb_mse"}) {
        EXPECT_EQ(told[metric], Json::parse(compared.out)[metric]) << metric;
    }
}

TEST_F(RaceCli, AReferenceBesideTheSceneIsFoundAndTellsTheSize) {
    make_reference();
    fs::copy_file(scene("torus"), folder_ / "mine.gltf");
    const Words words{"race", "mine.gltf", "-o", "out", "--photons", "500", "--iterations", "2", "--quiet"};
    expect_failure(run(words), 2, {"references/mine.exr", "mine.gltf", "--reference"});
    EXPECT_FALSE(fs::exists(folder_ / "out")) << "nothing is made of a wrong command";
    fs::create_directory(folder_ / "references");
    fs::rename(folder_ / "ref.exr", folder_ / "references/mine.exr");
    const auto result = run(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_exr(folder_ / "out/cppm.exr").extent, (Extent{32, 24}));
    EXPECT_EQ(json("out/race.json")["entrants"].size(), 3u);
}

TEST_F(RaceCli, RefusesReferencesThatDoNotFit) {
    make_reference();
    expect_failure(race("out", {"--reference", "none.exr"}), 66, {"none.exr"});
    expect_failure(race("out", {"--reference", "ref.exr", "--size", "32x23"}), 2, {"ref.exr", "32x24", "32x23"});
    expect_failure(race("out", {"--reference", scene("torus")}), 65, {"torus.gltf"});
    expect_failure(race("out", {"--reference", "ref.exr", "--estimators", "cppm,sppm:alpha=1"}), 2,
                   {"--alpha 1", "sppm:alpha=1"});
    expect_failure(race("out", {"--reference", "ref.exr", "--estimators", "cppm,cppm"}), 2, {"cppm", "twice"});
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    test::write_bytes(folder_ / "file", "");
    expect_failure(race("file/out", {"--reference", "ref.exr"}), 73, {"file/out"});
}

TEST_F(RaceCli, MakesItsReferenceWithASeedThatDoesNotRace) {
    const auto made = race("out", {"--make-reference", "1ms", "--size", "16x12", "--seeds", "2", "--seed", "4"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json told = json("out/race.json");
    EXPECT_EQ(told["reference"]["attributes"]["vkcppm.seed"], "6") << "4 and 5 race";
    EXPECT_EQ(told["reference"]["attributes"]["vkcppm.size"], "16x12");
    EXPECT_EQ(told["reference_made"], true);
    EXPECT_EQ(told["reference"]["file"], "out/reference.exr");
    EXPECT_GT(std::stod(told["reference"]["attributes"]["vkcppm.relmse"].get<std::string>()), 0.0);
    // The same race against the picture that was made.
    fs::rename(folder_ / "out/reference.exr", folder_ / "made.exr");
    const std::vector<std::string> before = curves("out/curves.csv");
    const auto again = race("again", {"--reference", "made.exr", "--seeds", "2", "--seed", "4"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(again.err, "") << "its attributes fit the race";
    EXPECT_EQ(curves("again/curves.csv"), before);
}

TEST_F(RaceCli, WarnsOfAReferenceThatShowsSomethingElse) {
    make_reference();
    const auto same = race("out", {"--reference", "ref.exr"});
    EXPECT_EQ(same.err, "");
    const auto lens = race("out", {"--reference", "ref.exr", "--aperture", "0.1", "--focus-distance", "3"});
    EXPECT_EQ(lens.exit_code, 0);
    EXPECT_TRUE(contains(lens.err, "warning: ref.exr has aperture 0.0, the race 0.1")) << lens.err;
    const auto other = run({"race", scene("caustic"), "-o", "out", "--photons", "500", "--iterations", "1",
                            "--reference", "ref.exr", "--quiet"});
    EXPECT_TRUE(contains(other.err, "warning: ref.exr has scene_hash")) << other.err;
}

TEST_F(RaceCli, EndsEarlyAndWritesWhatThereIs) {
    make_reference();
    test::Process process({test::program(), "race", scene("torus"), "-o", "out", "--reference", "ref.exr", "--photons",
                           "1000", "--time", "1h", "--seeds", "3"},
                          folder_.path());
    ASSERT_TRUE(process.wait_for_message(" left; relMSE without the worst 0.1 % cppm "));
    process.send(SIGINT);
    const auto result = process.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "interrupted: wrote what there is to out/index.html")) << result.err;
    const Json told = json("out/race.json");
    EXPECT_EQ(told["interrupted"], true);
    EXPECT_EQ(told["seeds"], Json({1}));
    for (const Json& entrant : told["entrants"]) EXPECT_GE(entrant["runs"][0]["iterations"], 1) << entrant["name"];
}

}  // namespace
}  // namespace vkcppm
