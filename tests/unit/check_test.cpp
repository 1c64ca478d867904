// The verdict over a picture: bounds, pixels, what is no number, and the files that tell it.

#include "study/check.h"

#include <cmath>
#include <limits>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/check/page.h"
#include "app/check/verdict.h"
#include "support/files/browser.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"

namespace vkcppm {
namespace {

const float nan = std::numeric_limits<float>::quiet_NaN();

NoisyPicture grey(float value, float error = 0.1f) {
    NoisyPicture picture;
    picture.mean = {{16, 16}, std::vector<glm::vec3>(256, glm::vec3(value))};
    picture.standard_error.assign(256, error);
    return picture;
}

CheckSettings bounds(const std::vector<Bound>& bounds) {
    CheckSettings settings;
    settings.bounds = bounds;
    return settings;
}

TEST(Check, HoldsBoundsOnEveryMeasure) {
    const NoisyPicture image = grey(1.1f), reference = grey(1.0f);
    const Check found = check(image, reference, bounds({{"relmse", 0.01}, {"flip", 0.5}, {"mse", 0.009}}));
    EXPECT_FALSE(found.passes());
    ASSERT_EQ(found.conditions.size(), 3u);
    EXPECT_TRUE(found.conditions[0].holds) << "0.01 over 1.01";
    EXPECT_TRUE(found.conditions[1].holds);
    EXPECT_FALSE(found.conditions[2].holds);
    EXPECT_EQ(found.why(), "mse 0.01 is above 0.009");
    EXPECT_TRUE(check(image, reference, bounds({{"relmse", 0.01}})).passes());
    for (const NamedMeasure& measure : named(found.measures)) {
        const double value = measure.value;
        EXPECT_TRUE(check(image, reference, bounds({{std::string(measure.name), value}})).passes()) << measure.name;
        if (value == 0.0) continue;
        const double less = value * (1.0 - 1e-12);
        EXPECT_FALSE(check(image, reference, bounds({{std::string(measure.name), less}})).passes()) << measure.name;
    }
}

TEST(Check, CountsPixelsThatDiffer) {
    NoisyPicture image = grey(1.0f);
    const NoisyPicture reference = grey(1.0f);
    for (std::size_t i = 0; i < 4; ++i) image.mean.rgb[i] = glm::vec3(1.2f);  // 0.2 / sqrt(1.01) = 0.199
    CheckSettings settings;
    settings.max_pixels = 4.0 / 256.0;
    EXPECT_TRUE(check(image, reference, settings).passes());
    settings.max_pixels = 3.0 / 256.0;
    const Check found = check(image, reference, settings);
    EXPECT_FALSE(found.passes());
    EXPECT_NEAR(found.difference[0], 0.2 / std::sqrt(1.01), 1e-6);
    EXPECT_EQ(found.why(), "4 of 256 pixels (1.56 %) differ by more than 5 %, above 1.17188 %");
    settings.pixel_bound = 0.2;
    EXPECT_TRUE(check(image, reference, settings).passes());
}

TEST(Check, WhatIsNoNumberInOnePictureAloneDiffers) {
    NoisyPicture image = grey(1.0f), reference = grey(1.0f);
    image.mean.rgb[7].b = nan;
    const CheckSettings generous = bounds({{"relmse", 1.0}});
    const Check found = check(image, reference, generous);
    EXPECT_FALSE(found.passes());
    EXPECT_EQ(found.unlike, 1u);
    CheckSettings settings = generous;
    settings.max_pixels = 1.0 / 256.0;
    EXPECT_TRUE(check(image, reference, settings).passes()) << "it is the pixel that may differ";
    settings.max_pixels = 0.0;
    EXPECT_FALSE(check(image, reference, settings).passes());
    reference.mean.rgb[7].r = nan;
    const Check masked = check(image, reference, generous);
    EXPECT_TRUE(masked.passes()) << "neither says anything of it";
    EXPECT_EQ(masked.masked, 1u);
    image.mean.rgb.assign(256, glm::vec3(nan));
    reference.mean = image.mean;
    EXPECT_FALSE(check(image, reference, generous).passes()) << "no pixel is left to measure";
}

TEST(Check, AsksNoiseWhereThereIsALevel) {
    CheckSettings settings;
    settings.level = 0.01;
    const Check right = check(grey(1.0f), grey(1.1f), settings);  // 0.7 standard errors that move together
    EXPECT_TRUE(right.passes());
    ASSERT_EQ(right.conditions.size(), 3u) << "pixels, blocks of 8 and the whole";
    const Check wrong = check(grey(1.0f), grey(3.0f), settings);
    EXPECT_FALSE(wrong.passes());
    EXPECT_NE(wrong.why().find("256 of 256 pixels differ by more than noise, the worst 14.1 sigma"), std::string::npos)
        << wrong.why();
}

struct Files {
    explicit Files(float value) : image(grey(value)), reference(grey(1.0f)) {
        image.mean.rgb[20] = glm::vec3(9.0f);
        options.image = "a </script>&\"<b>.exr";
        options.reference = "r.exr";
        CheckSettings settings = bounds({{"flip", 0.5}});
        settings.level = 0.01;
        found = check(image, reference, settings);
        json = check_json(options, found, image.mean.extent);
    }
    NoisyPicture image, reference;
    CheckOptions options;
    Check found;
    nlohmann::ordered_json json;
};

TEST(CheckRecord, HoldsConditionsMeasuresAndPlaces) {
    const Files files(1.0f);
    EXPECT_EQ(files.json["passes"], false);
    EXPECT_EQ(files.json["conditions"].size(), files.found.conditions.size());
    EXPECT_GT(files.json["measures"]["flip"].get<double>(), 0.0);
    const auto& pixels = files.json["noise"]["scales"][0];
    EXPECT_EQ(pixels["differing"], 1);
    EXPECT_EQ(pixels["places"][0]["x"], 4);
    EXPECT_EQ(pixels["places"][0]["y"], 1);
    EXPECT_NEAR(pixels["places"][0]["sigma"].get<double>(), 8.0 / std::sqrt(0.02), 0.1);
    EXPECT_TRUE(verdict_line(files.found).starts_with("differs: 1 of 256 pixels"));
    EXPECT_EQ(verdict_line(files.found).find('\n'), std::string::npos);
}

TEST(CheckRecord, JunitHasACaseForEveryCondition) {
    const Files files(1.0f);
    const std::string xml = junit_xml(files.options, files.found);
    const auto count = [&](const std::string& pattern) {
        const std::regex regex(pattern);
        return std::distance(std::sregex_iterator(xml.begin(), xml.end(), regex), std::sregex_iterator());
    };
    EXPECT_EQ(count("<testcase "), std::ptrdiff_t(files.found.conditions.size()));
    EXPECT_EQ(count("<failure message=\"[^\"<]+\"/>"), 1);
    EXPECT_NE(xml.find("tests=\"4\" failures=\"1\""), std::string::npos) << xml;
    EXPECT_NE(xml.find("a &lt;/script&gt;&amp;&quot;&lt;b&gt;.exr"), std::string::npos) << xml;
}

TEST(CheckPage, NeedsNoNetworkAndHoldsTheVerdict) {
    const Files files(1.0f);
    const std::string page =
        check_page(files.json, files.found, files.image.mean, files.reference.mean, {ToneMap::none, 0.0});
    EXPECT_EQ(page.find("@script@"), std::string::npos);
    static const std::regex address(R"re(https?://[^"' )<]+)re");
    for (std::sregex_iterator it(page.begin(), page.end(), address), end; it != end; ++it) {
        EXPECT_EQ(it->str(), "http://www.w3.org/2000/svg");
    }
    const std::string mark = "<script type=\"application/json\" id=\"check\">";
    const std::size_t begin = page.find(mark) + mark.size();
    const auto told = nlohmann::ordered_json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    EXPECT_EQ(told["noise"], files.json["noise"]);
    const std::string other = "<script type=\"application/json\" id=\"pictures\">";
    const std::size_t from = page.find(other) + other.size();
    const auto pictures = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
    EXPECT_EQ(pictures["maps"].size(), 4u) << "difference, FLIP, sigmas of pixels and of blocks";
    for (const auto& map : pictures["maps"]) {
        EXPECT_TRUE(map["picture"].get<std::string>().starts_with("data:image/png;base64,iVBORw0KGgo"));
    }
}

TEST(CheckPage, ShowsVerdictMapsAndPlacesInABrowser) {
    const std::optional<std::string> browser = test::chromium();
    if (!browser) GTEST_SKIP() << "no chromium in PATH";
    const Files files(1.0f);
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "index.html",
                      check_page(files.json, files.found, files.image.mean, files.reference.mean, {}));
    const std::string page = test::drawn_page(*browser, folder.path(), "#view=2&crop=0,0,8");
    EXPECT_NE(test::between(page, "<p id=\"verdict\"", "</p>").find("Differs"), std::string::npos);
    EXPECT_EQ(test::all(test::between(page, "<table id=\"conditions\">", "</table>"), "(✗ fails)").size(), 1u);
    EXPECT_EQ(test::all(test::between(page, "<table id=\"places\">", "</table>"), "(>pixel<)").size(), 1u);
    EXPECT_EQ(test::all(page, "aria-pressed=\"true\">([^<]*)<"), std::vector<std::string>{"Sigma"});
    EXPECT_EQ(test::all(page, "class=\"tile\" data-name=\"([a-z]+)\"").size(), 3u);
    EXPECT_NE(page.find("from column 0, row 0"), std::string::npos);
    EXPECT_EQ(page.find("NaN,"), std::string::npos);
}

}  // namespace
}  // namespace vkcppm
