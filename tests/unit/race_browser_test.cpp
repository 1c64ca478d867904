// The page of a race in a browser: Chromium without a window, where there is one.

#include <algorithm>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/race/data.h"
#include "app/race/page.h"
#include "app/race/pictures.h"
#include "support/files/browser.h"
#include "support/files/files.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"
#include "unit/race_result.h"

namespace vkcppm {
namespace {

using Json = nlohmann::ordered_json;
using test::between;

std::string without_tags(const std::string& html) { return std::regex_replace(html, std::regex("<[^>]*>"), " "); }

std::string percent_decode(const std::string& text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_code = text[i] == '%';
        decoded += is_code ? char(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
        if (is_code) i += 2;
    }
    return decoded;
}

class RaceInBrowser : public testing::Test {
protected:
    void SetUp() override {
        browser_ = test::chromium();
        if (!browser_) GTEST_SKIP() << "no chromium in PATH";
    }

    /// Writes the page of a made-up race.
    void write(const std::vector<std::string>& names, const std::optional<StopAt>& stop_at = {}) {
        RaceOptions options;
        options.race.stop_at = stop_at;
        options.command = "vkcppm race \"scene\" <&> -o out";
        Scene scene;
        scene.file = "a </script> & b.gltf";
        const RaceResult result = test::made_up_race(names);
        const RacePictures pictures = race_pictures(result, {{8, 6}, std::vector<glm::vec3>(48, glm::vec3(0.5f))}, {});
        json_ = race_json(options, {scene, "a.exr", {{"vkcppm.relmse", "0.002"}}}, result, pictures);
        test::write_bytes(folder_ / "index.html", race_page(json_, pictures));
    }

    /// The page after its script ran, with what follows # in its address.
    std::string drawn(const std::string& hash) { return test::drawn_page(*browser_, folder_.path(), hash); }

    test::TemporaryFolder folder_;
    Json json_;
    std::optional<std::string> browser_;
};

void expect_plots(const std::string& page, const std::string& metric, std::size_t curves, std::size_t points) {
    for (const char* axis : {"iterations", "seconds"}) {
        const std::string plot = between(page, std::string("id=\"plot-") + axis + "\"", "</figure>");
        EXPECT_EQ(test::all(plot, "data-metric=\"([a-z_]+)\""), std::vector<std::string>{metric}) << axis;
        const std::vector<std::string> lines = test::all(plot, "<path class=\"line\"[^>]* d=\"([^\"]*)\"");
        ASSERT_EQ(lines.size(), curves) << axis;
        for (const std::string& line : lines) {
            EXPECT_TRUE(std::regex_match(line, std::regex(R"(M-?\d+\.\d,-?\d+\.\d(L-?\d+\.\d,-?\d+\.\d)*)"))) << line;
            EXPECT_EQ(test::all(line, R"((-?\d+\.\d),)").size(), points) << line;
        }
        EXPECT_EQ(plot.find("NaN"), std::string::npos) << axis;
        EXPECT_EQ(plot.find("Infinity"), std::string::npos) << axis;
        EXPECT_EQ(test::all(plot, "class=\"slope\"[^>]*>(slope [^<]*)<").size(), curves) << axis;
    }
}

TEST_F(RaceInBrowser, DrawsTenEntrants) {
    const std::vector<std::string> names = {"cppm",      "sppm",      "appm",  "cppm-lf",    "cppm-gof",
                                            "cppm-fold", "cppm-null", "ftest", "ftest-fold", "cppm:beta=1.5"};
    write(names);
    const std::string page = drawn("");
    expect_plots(page, "relmse_trimmed", 10, 7);
    EXPECT_NE(between(page, "<h1 id=\"heading\">", "</h1>").find("Race: script&gt; &amp; b.gltf"), std::string::npos);
    EXPECT_EQ(between(page, "<pre id=\"command\" tabindex=\"0\">", "</pre>"),
              "vkcppm race \"scene\" &lt;&amp;&gt; -o out");
    for (const std::string& name : names) {
        EXPECT_NE(between(page, "<table id=\"equal\">", "</table>").find(">" + name + "<"), std::string::npos) << name;
        EXPECT_NE(between(page, "<table id=\"cost\">", "</table>").find(">" + name + "<"), std::string::npos) << name;
        EXPECT_NE(page.find("class=\"tile\" data-name=\"" + name + "\""), std::string::npos) << name;
    }
    // Ten marks that differ.
    std::vector<std::string> marks = test::all(between(page, "id=\"chips\"", "</div>"), "<path d=\"([^\"]*)\"");
    std::sort(marks.begin(), marks.end());
    EXPECT_EQ(marks.size(), 10u);
    EXPECT_TRUE(std::adjacent_find(marks.begin(), marks.end()) == marks.end());
}

// The errors of cppm end below those of the others, at 0.01 and 0.011 times 64^(-2/3), trimmed 0.9 times that.
TEST_F(RaceInBrowser, SaysWhoComesFirstToAnError) {
    const double end = 0.9 * std::pow(64.0, -2.0 / 3.0);
    write({"cppm", "sppm", "appm"}, StopAt{&default_metric(), 0.0115 * end});
    const std::string metric(default_metric().title);
    const auto verdict = [&] {
        const std::string page = drawn("");
        EXPECT_EQ(page.find("This page failed"), std::string::npos);
        return without_tags(between(page, "<p id=\"verdict\">", "</p>"));
    };
    EXPECT_EQ(json_["entrants"][1]["seconds_to_stop"], Json());
    EXPECT_NE(verdict().find("cppm  comes first to " + metric), std::string::npos) << verdict();
    write({"cppm", "sppm"}, StopAt{&default_metric(), 0.0105 * end});
    EXPECT_NE(verdict().find("Nobody comes to " + metric), std::string::npos) << verdict() << ": one seed does";
}

TEST_F(RaceInBrowser, NumbersAreThoseOfTheData) {
    write({"sppm", "cppm", "appm"});
    const std::string page = drawn("#metric=relmse");
    EXPECT_EQ(test::all(page, "data-noise=\"([0-9.]*)\"").size(), 2u)
        << "the reference's own error, where that is known";
    const std::string table = between(page, "<table id=\"equal\">", "</table>");
    for (const Json& entrant : json_["entrants"]) {
        const std::string name = entrant["name"];
        const std::string row = without_tags(between(table, "<tr data-name=\"" + name + "\">", "</tr>"));
        std::istringstream words(row.substr(row.find(name) + name.size()));
        std::string word;
        words >> word;
        if (word == "baseline") words >> word;
        const double mean = entrant["metrics"]["relmse"]["final"]["mean"];
        EXPECT_NEAR(std::stod(word), mean, 0.005 * mean) << row;
        words >> word;  // low–high, of 3 digits
        EXPECT_NEAR(std::stod(word), entrant["metrics"]["relmse"]["final"]["low"].get<double>(), 0.005 * mean) << row;
        int iterations = 0;
        double seconds = 0.0;
        words >> iterations >> seconds;
        EXPECT_EQ(iterations, 64) << row;
        const double own = entrant["runs"][0]["seconds"];
        EXPECT_NEAR(seconds, own, 0.005 * own) << row;
        EXPECT_EQ(row.find("not reached") != std::string::npos, name != "sppm") << row;
    }
}

TEST_F(RaceInBrowser, APlotIsSavedAsAFileOfItsOwn) {
    write({"sppm", "cppm"});
    const std::string page = drawn("#metric=mse");
    EXPECT_EQ(test::all(page, "download=\"(mse-[a-z]+\\.svg)\""),
              (std::vector<std::string>{"mse-iterations.svg", "mse-seconds.svg"}));
    const std::string svg = percent_decode(between(page, "href=\"data:image/svg+xml,", "\""));
    EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"")) << svg.substr(0, 80);
    EXPECT_TRUE(svg.ends_with("</svg>"));
    EXPECT_NE(svg.find(">sppm, slope −"), std::string::npos) << "entrants are named in it";
    EXPECT_NE(svg.find(">cppm, slope −"), std::string::npos);
    EXPECT_EQ(svg.find("class="), std::string::npos) << "nothing is left to a style sheet";
    EXPECT_EQ(svg.find("var("), std::string::npos);
    EXPECT_NE(svg.find("fill=\"rgb(89, 98, 109)\""), std::string::npos) << "labels as on the light page";
    EXPECT_EQ(test::all(svg, "<path[^>]* fill=\"(none)\"").size(), 2u) << "a line each, not filled";
}

TEST_F(RaceInBrowser, TheAddressChoosesMetricViewCropAndCurves) {
    write({"sppm", "cppm", "appm"});
    const std::string page = drawn("#metric=smape_trimmed&view=radius&crop=5,-3,4&hide=cppm");
    expect_plots(page, "smape_trimmed", 2, 7);
    EXPECT_NE(between(page, "data-view=\"radius\"", ">").find("aria-pressed=\"true\""), std::string::npos);
    EXPECT_NE(between(page, "data-view=\"picture\"", ">").find("aria-pressed=\"false\""), std::string::npos);
    // The only size of a crop that such a small picture has is 6; 5 columns to the right it would stand out.
    EXPECT_EQ(between(page, "<span id=\"crop-place\" class=\"quiet\">", "</span>"), "from column 2, row 0");
    const std::string tile = between(page, "class=\"tile\" data-name=\"appm\"", "</figure>");
    EXPECT_NE(between(tile, "class=\"frame\"", ">").find("left: 25%"), std::string::npos) << "2 of 8 columns";
    const std::vector<std::string> shown = test::all(tile, "src=\"([^\"]*)\"");
    ASSERT_EQ(shown.size(), 2u) << "the picture and its crop";
    EXPECT_EQ(shown[0], shown[1]);
    const std::string whole = test::read_bytes(folder_ / "index.html");
    const Json pictures = Json::parse(between(whole, "id=\"pictures\">", "</script>"));
    EXPECT_EQ(shown[0], pictures["entrants"][2]["radius"].get<std::string>());
}

TEST_F(RaceInBrowser, TellsWhereItFails) {
    write({"sppm", "cppm"});
    std::string page = test::read_bytes(folder_ / "index.html");
    page.replace(page.find("drawHead();\n"), 10, "undrawable");
    test::write_bytes(folder_ / "index.html", page);
    const test::ProcessResult result =
        test::run_process({*browser_, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                           "--user-data-dir=" + (folder_ / "profile").string(), "--virtual-time-budget=5000",
                           "--dump-dom", "file://" + (folder_ / "index.html").string()},
                          folder_.path());
    EXPECT_NE(between(result.out, "<div id=\"alert\"", "</div>").find("This page failed: "), std::string::npos);
}

}  // namespace
}  // namespace vkcppm
