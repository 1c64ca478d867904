// Every option of every command with values that no number, name or file of it has.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/options.h"
#include "render/render.h"
#include "study/reference.h"
#include "support/scenes/scenes.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using Words = std::vector<std::string>;

/// Parses the words and resolves the settings that they give: all that happens before the device is asked for.
void resolve(const Words& words) {
    static const Scene scene = test::project_scene("point_plane");
    std::vector<const char*> argv{"vkcppm"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    const Options options = parse_options(int(argv.size()), argv.data());
    if (const auto* render = std::get_if<RenderOptions>(&options)) resolve_settings(render->settings, scene);
    if (const auto* race = std::get_if<RaceOptions>(&options)) {
        for (const Entrant& entrant : race->race.entrants) resolve_settings(entrant.settings, scene);
    }
    if (const auto* reference = std::get_if<ReferenceOptions>(&options)) resolve_reference(reference->settings, scene);
}

struct NumberOption {
    const char* name;
    Words refused;       // beside what no number is
    Words taken;         // the ends of the range
    Words company = {};  // options that it needs
};

const Words no_whole_numbers = {"",
                                "-1",
                                "-0",
                                "+1",
                                "nan",
                                "inf",
                                "1.5",
                                "1e3",
                                "0x10",
                                " 1",
                                "1 ",
                                "4294967296",
                                "9223372036854775808",
                                "18446744073709551616",
                                "99999999999999999999999999",
                                "many"};
const Words no_real_numbers = {"",       "nan", "-nan",  "inf", "-inf", "infinity", "1e999",
                               "-1e999", "0,5", "0x1p3", " 1",  "1 ",   "many"};

const std::vector<NumberOption> whole_numbers = {
    {"--iterations", {"0", "2147483648", "4294967295"}, {"1", "1073741823"}},
    {"--photons", {"0", "16777217", "2147483648", "4294967295"}, {"1", "16777216"}},
    {"--seed", {}, {"0", "4294967295"}},
    {"--max-depth", {"0", "1025", "2147483648", "4294967295"}, {"1", "1024"}},
    {"--knn", {"0", "1", "257", "2147483648", "4294967295"}, {"2", "256"}},
    {"--rings", {"0", "2147483648", "4294967295"}, {"1"}},
    {"--sectors", {"0", "1", "5", "13", "2147483648", "4294967295"}, {"4", "12"}},
};

const std::vector<NumberOption> real_numbers = {
    {"--alpha", {"0", "1", "-0.5", "1e-320", "0.99999999999", "1e300"}, {"0.5", "1e-30"}},
    {"--k", {"0", "1", "-0.5", "1e-320", "0.99999999999", "1e300"}, {"0.5", "1e-30"}},
    {"--beta", {"0", "0.999", "-1", "1000.001", "1e300"}, {"1", "1000"}},
    {"--significance", {"0", "1", "-0.5", "1e-320", "0.99999999999", "1e300"}, {"1e-30", "0.999999"}},
    {"--aperture", {"-1e-9", "1e10", "1e300"}, {"0.1", "1e9"}, {"--focus-distance", "1"}},
    {"--focus-distance", {"0", "-1", "1e-10", "1e-320", "1e10", "1e300"}, {"1e-9", "1e9"}, {"--aperture", "1"}},
    {"--exposure", {"129", "-129", "1e300"}, {"128", "-128"}, {"--png", "p.png"}},
};

/// Code 2, and a line that names the option and its value.
void expect_refused(const Words& words, const std::string& option, const std::string& value) {
    SCOPED_TRACE(option + " '" + value + "'");
    const auto error = test::thrown_by([&] { resolve(words); });
    ASSERT_TRUE(error) << "it was taken";
    const std::string line = error->what();
    EXPECT_EQ(error->code(), ExitCode::usage) << line;
    EXPECT_NE(line.find(option), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

void expect_range(const NumberOption& option, const Words& no_numbers) {
    const auto with = [&](const std::string& value) {
        Words words = {"s.gltf", std::string(option.name) + "=" + value};
        words.insert(words.end(), option.company.begin(), option.company.end());
        return words;
    };
    for (const Words* values : {&no_numbers, &option.refused}) {
        for (const std::string& value : *values) {
            // CLI11 takes "--option=" for an option without its value; the two words are what a shell's "" gives.
            Words words = {"s.gltf", option.name, value};
            words.insert(words.end(), option.company.begin(), option.company.end());
            expect_refused(words, option.name, value);
        }
    }
    for (const std::string& value : option.taken) {
        const auto error = test::thrown_by([&] { resolve(with(value)); });
        EXPECT_FALSE(error) << option.name << " " << value << ": " << error->what();
    }
}

TEST(OptionValues, WholeNumbersHaveARange) {
    for (const NumberOption& option : whole_numbers) expect_range(option, no_whole_numbers);
}

TEST(OptionValues, RealNumbersHaveARange) {
    for (const NumberOption& option : real_numbers) expect_range(option, no_real_numbers);
}

TEST(OptionValues, TimesHaveARange) {
    for (const char* value :
         {"", "0", "0s", "-1", "nan", "inf", "1e999", "1e300h", "1e9", "1e-320", "s", "5d", "5 s", "1:00"}) {
        expect_refused({"s.gltf", "--time", value}, "--time", value);
    }
    for (const char* value : {"", "0", "-1m", "nan", "inf"}) {
        expect_refused({"race", "s.gltf", "-o", "d", "--make-reference", value}, "--make-reference", value);
    }
}

TEST(OptionValues, SizesHaveARange) {
    for (const char* value : {"",
                              "x",
                              "64",
                              "64x",
                              "x64",
                              "-1x1",
                              "1x-1",
                              "0x1",
                              "1x0",
                              "1.5x1",
                              "nanx1",
                              "infx1",
                              "65537x1",
                              "1x65537",
                              "2147483648x1",
                              "4294967295x4294967295",
                              "4294967296x1",
                              "1x18446744073709551616",
                              "65536x65536",
                              "65536x32769",
                              "64X64",
                              "1x1x1"}) {
        expect_refused({"s.gltf", "--size", value}, "--size", value);
        expect_refused({"reference", "s.gltf", "-o", "r.exr", "--size", value}, "--size", value);
    }
    EXPECT_FALSE(test::thrown_by([] { resolve({"s.gltf", "--size", "65536x32768"}); }));
}

TEST(OptionValues, WordsHaveNoEmptyOne) {
    for (const char* option : {"--camera", "--device", "--estimator", "--thin-glass"}) {
        expect_refused({"s.gltf", option, ""}, option, "");
    }
    expect_refused({"s.gltf", "--reference", "r", "--stop-at", ""}, "--stop-at", "");
    expect_refused({"race", "s.gltf", "-o", "d", "--estimators", ""}, "--estimator", "");
}

TEST(OptionValues, OfARaceAndAReference) {
    for (const char* value : {"0", "10001", "4294967295", "4294967296", "-1", ""}) {
        expect_refused({"race", "s.gltf", "-o", "d", "--seeds", value}, "--seeds", value);
    }
    for (const char* value :
         {"cppm:k=2", "cppm:k=nan", "cppm:knn=-1", "cppm:knn=4294967296", "cppm:k=", "cppm::", ","}) {
        expect_refused({"race", "s.gltf", "-o", "d", "--estimators", value}, "--", value);
    }
    for (const char* value : {"0", "127", "16777217", "4294967295", "4294967296", "-1", ""}) {
        expect_refused({"reference", "s.gltf", "-o", "r.exr", "--samples", value}, "--samples", value);
    }
    for (const char* value : {"0", "-1", "nan", "inf", ""}) {
        expect_refused({"reference", "s.gltf", "-o", "r.exr", "--trust", value}, "--trust", value);
    }
}

}  // namespace
}  // namespace vkcppm
