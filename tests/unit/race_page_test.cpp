// The files of a race: page, JSON and CSV.

#include "app/race/page.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/race/data.h"
#include "app/race/pictures.h"
#include "core/metrics.h"
#include "render/sums.h"
#include "unit/race_result.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> ten = {"sppm",     "cppm",      "appm",  "cppm:beta=1.5", "cppm-lf",
                                      "cppm-gof", "cppm-fold", "ftest", "sppm-kz",       "cppm:k=0.7:beta=1.1"};

struct Files {
    explicit Files(const std::vector<std::string>& names) : result(test::made_up_race(names)) {
        options.command = "vkcppm race 'a </script> b.gltf' -o out";
        scene.file = "</script><!-- &amp; .gltf";
        pictures = race_pictures(result, reference, {});
        json = race_json(options, {scene, "references/a.exr", {{"vkcppm.relmse", "0.001"}}}, result, pictures);
        page = race_page(json, pictures);
    }

    RaceOptions options;
    Scene scene;
    RaceResult result;
    Image reference{{8, 6}, std::vector<glm::vec3>(48, glm::vec3(0.5f))};
    RacePictures pictures;
    Json json;
    std::string page;
};

/// What stands in the element with that id, up to the end of the element.
std::string element(const std::string& page, const std::string& id, const std::string& end) {
    const std::size_t at = page.find("id=\"" + id + "\">");
    EXPECT_NE(at, std::string::npos) << id;
    const std::size_t begin = page.find('>', at) + 1;
    return page.substr(begin, page.find(end, begin) - begin);
}

/// Tags that are not closed in order, one a line. The content of script and style is skipped as a browser does.
std::vector<std::string> unbalanced(const std::string& page) {
    static const std::regex tag(R"re(<(!DOCTYPE[^>]*|(/?)([a-zA-Z][a-zA-Z0-9]*)((?:[^>"]|"[^"]*")*?)(/?))>)re");
    std::vector<std::string> open, found;
    std::size_t at = 0;
    for (std::smatch match; std::regex_search(page.begin() + std::ptrdiff_t(at), page.end(), match, tag);) {
        at += std::size_t(match.position() + match.length());
        const std::string name = match[3];
        if (name.empty() || match[5] == "/") continue;
        if (match[2] == "/") {
            if (open.empty() || open.back() != name) found.push_back("</" + name + ">");
            else open.pop_back();
            continue;
        }
        open.push_back(name);
        if (name == "script" || name == "style") at = page.find("</" + name, at);
    }
    found.insert(found.end(), open.begin(), open.end());
    return found;
}

TEST(RacePage, TheCheckOfTagsFindsWhatIsWrong) {
    EXPECT_TRUE(unbalanced("<!DOCTYPE html><p a=\"<b>\">x<br /></p><script>if (a<b) \"<p>\"</script>").empty());
    EXPECT_EQ(unbalanced("<p><b></p></b>").size(), 2u);
    EXPECT_EQ(unbalanced("<script>\"</script>\"</script>").size(), 1u) << "an end that a string did not hide";
}

TEST(RacePage, IsWellFormedAndNeedsNoNetwork) {
    const Files files(ten);
    for (const std::string& tag : unbalanced(files.page)) ADD_FAILURE() << tag << " is not balanced";
    EXPECT_EQ(files.page.find('@' + std::string("race@")), std::string::npos);
    static const std::regex address(R"re(https?://[^"' )<]+)re");
    for (std::sregex_iterator it(files.page.begin(), files.page.end(), address), end; it != end; ++it) {
        EXPECT_EQ(it->str(), "http://www.w3.org/2000/svg") << "a namespace alone may look like an address";
    }
    for (const char* loading : {"@import", "<link rel=\"stylesheet", "src=\"//", "fetch(", "XMLHttpRequest"}) {
        EXPECT_EQ(files.page.find(loading), std::string::npos) << loading;
    }
    EXPECT_FALSE(std::regex_search(files.page, std::regex(R"(url\((?!#))"))) << "an url() that is no place on the page";
}

TEST(RacePage, HoldsTheDataWithoutTheCurvesOfSeeds) {
    const Files files(ten);
    Json expected = files.json;
    for (Json& entrant : expected["entrants"]) {
        for (Json& run : entrant["runs"]) EXPECT_EQ(run.erase("curve"), 1u);
    }
    EXPECT_EQ(Json::parse(element(files.page, "race", "</script>")), expected);
    const Json pictures = Json::parse(element(files.page, "pictures", "</script>"));
    ASSERT_EQ(pictures["entrants"].size(), ten.size());
    for (const Json& entrant : pictures["entrants"]) {
        for (const char* view : {"picture", "difference", "radius"}) {
            EXPECT_TRUE(entrant[view].get<std::string>().starts_with("data:image/png;base64,iVBORw0KGgo")) << view;
        }
    }
}

TEST(RaceData, HoldsEveryEntrantAndMetric) {
    const Files files(ten);
    EXPECT_EQ(files.json["baseline"], "sppm");
    EXPECT_EQ(files.json["seeds"], Json({7, 8}));
    EXPECT_EQ(files.json["reference"]["file"], "references/a.exr");
    EXPECT_EQ(files.json["reference"]["attributes"], Json({{"vkcppm.relmse", "0.001"}}));
    ASSERT_EQ(files.json["entrants"].size(), ten.size());
    for (std::size_t e = 0; e < ten.size(); ++e) {
        const Json& entrant = files.json["entrants"][e];
        SCOPED_TRACE(ten[e]);
        EXPECT_EQ(entrant["name"], ten[e]);
        ASSERT_EQ(entrant["runs"].size(), 2u);
        EXPECT_EQ(entrant["runs"][1]["curve"].size(), 7u);
        EXPECT_EQ(entrant["runs"][1]["seconds"], 0.64 * double(e + 1));
        EXPECT_EQ(entrant["runs"][0]["pass_seconds"]["scan_sums"], 0.2);
        EXPECT_NEAR(entrant["pixels_won"].get<double>(), e < 8 ? 5.0 / 48.0 : 4.0 / 48.0, 1e-12);
        for (const Metric& metric : metrics()) {
            const Json& told = entrant["metrics"][std::string(metric.name)];
            const double part = metric.part == &Measure::trimmed ? 0.9 : 1.0;
            const double first = std::sqrt((0.01 + 0.005 * double(e)) * (0.011 + 0.005 * double(e)));
            EXPECT_NEAR(told["final"]["mean"].get<double>(), part * first / 16.0, 1e-12) << metric.name;
            EXPECT_NEAR(told["against_iterations"]["slope"]["mean"].get<double>(), -2.0 / 3.0, 1e-12) << metric.name;
            EXPECT_EQ(told["against_seconds"]["points"].size(), 7u) << metric.name;
            if (e == 0) EXPECT_EQ(told["equal_seconds"]["speedup"]["mean"], 1.0);
            else EXPECT_EQ(told["equal_seconds"]["reached"], 0) << "it is behind at every iteration";
        }
    }
}

TEST(RaceData, FilesAreNamedAfterEntrants) {
    EXPECT_EQ(file_stem({"cppm:beta=1.5:k=0.7", {}}), "cppm-beta-1.5-k-0.7");
    EXPECT_EQ(file_stem({"sppm-kz", {}}), "sppm-kz");
}

TEST(RaceData, CurvesHaveEverySnapshotToTheLastBit) {
    const RaceResult result = test::made_up_race({"cppm", "cppm:k=0.7"});
    std::istringstream csv(curves_csv(result));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line.substr(0, 42), "entrant,seed,iterations,seconds,mse,mse_tr");
    for (const RaceRun& run : result.runs) {
        for (std::size_t s = 0; s < result.seeds.size(); ++s) {
            for (const CurvePoint& point : run.curves[s]) {
                ASSERT_TRUE(std::getline(csv, line));
                std::vector<std::string> cells;
                std::istringstream stream(line);
                for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
                ASSERT_EQ(cells.size(), 4 + metrics().size()) << line;
                EXPECT_EQ(cells[0], run.entrant.name);
                EXPECT_EQ(cells[1], std::to_string(result.seeds[s]));
                EXPECT_EQ(cells[2], std::to_string(point.iterations));
                EXPECT_EQ(std::stod(cells[3]), point.seconds);
                for (std::size_t m = 0; m < metrics().size(); ++m) {
                    EXPECT_EQ(std::stod(cells[4 + m]), metrics()[m].of(point.error)) << metrics()[m].name;
                }
            }
        }
    }
    EXPECT_FALSE(std::getline(csv, line)) << line;
}

TEST(RacePictures, LayersAreShownWhereTheyAreTold) {
    RaceResult result = test::made_up_race({"sppm", "cppm"});
    const Image reference{{8, 6}, std::vector<glm::vec3>(48, glm::vec3(0.5f))};
    const auto views_of = [&](std::size_t entrant) {
        const RacePictures pictures = race_pictures(result, reference, {});
        std::vector<std::string> views;
        for (const auto& [view, bitmap] : pictures.entrants[entrant]) views.push_back(view);
        return views;
    };
    RaceRun& run = result.runs[1];
    run.entrant.settings.aovs = true;
    for (const char* colour : {"R", "G", "B"}) {
        for (const char* layer : layer_names) run.aovs[fmt::format("{}.{}", layer, colour)].assign(48, 0.0f);
        run.aovs[fmt::format("caustic.{}", colour)].assign(48, 1.0f);
    }
    EXPECT_EQ(views_of(0), (std::vector<std::string>{"difference", "picture", "radius"}));
    EXPECT_EQ(views_of(1), (std::vector<std::string>{"caustic", "difference", "direct", "picture", "radius", "rest"}));
    std::vector<std::string> named = entrant_views(run.entrant.settings);
    std::ranges::sort(named);
    EXPECT_EQ(named, views_of(1)) << "files are written for these";
    const EntrantPictures views = race_pictures(result, reference, {}).entrants[1];
    EXPECT_EQ(views.at("caustic").rgb[7], glm::u8vec3(255));
    EXPECT_EQ(views.at("direct").rgb[7], glm::u8vec3(0));
}

TEST(RacePictures, DifferencesAndRadiiShareTheirScales) {
    const RaceResult result = test::made_up_race({"sppm", "cppm", "appm"});  // pictures of 0.25, 0.5, 0.75
    const Image reference{{8, 6}, std::vector<glm::vec3>(48, glm::vec3(0.5f))};
    const RacePictures pictures = race_pictures(result, reference, {ToneMap::none, 1.0});
    EXPECT_EQ(pictures.difference.high, 0.25);
    EXPECT_EQ(pictures.entrants[0].at("difference").rgb[0], false_colour(1.0));
    EXPECT_EQ(pictures.entrants[1].at("difference").rgb[0], false_colour(0.0));
    EXPECT_EQ(pictures.entrants[0].at("radius").rgb[0], false_colour(0.0));
    EXPECT_EQ(pictures.entrants[2].at("radius").rgb[0], false_colour(1.0));
    EXPECT_EQ(pictures.entrants[1].at("picture").rgb[0], glm::u8vec3(255)) << "0.5 a stop brighter";
    for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(pictures.winner.map.rgb[i], entrant_colour(i % 3)) << "pixel " << i;
}

}  // namespace
}  // namespace vkcppm
