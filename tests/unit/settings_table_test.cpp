// Every row of render/settings_table.h, through all that follows from it: an option that is forgotten in one place
// would be seen here without a line of its own.

#include <array>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/checkpoint_file.h"
#include "app/options.h"
#include "app/provenance.h"
#include "render/estimators.h"
#include "render/settings_rows.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/scenes.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

using setting::Kind;
using Words = std::vector<std::string>;

// Two values that a row takes.
template <typename T> std::array<T, 2> two_of(const T&, const setting::Within<T>& range) {
    return {range.low, range.high};
}
std::array<double, 2> two_of(double, setting::Between range) {
    return {range.low + (range.high - range.low) / 4.0, range.low + (range.high - range.low) / 2.0};
}
template <typename T, std::size_t N> std::array<T, 2> two_of(const T&, const setting::OneOf<T, N>& list) {
    return {list.values[0], list.values[1]};
}
std::array<Extent, 2> two_of(const Extent&, setting::Pixels) { return {{{8, 4}, {8, 5}}}; }
std::array<std::string, 2> two_of(const std::string&, setting::AnEstimator) {
    return {std::string(estimators()[0].name), std::string(estimators()[1].name)};
}
template <std::size_t N> std::array<std::string, 2> two_of(const std::string&, const setting::Words<N>& words) {
    return {words.values[0].name, words.values[1].name};
}
std::array<std::string, 2> two_of(const std::string&, setting::Any) { return {"0", "1"}; }
std::array<std::uint32_t, 2> two_of(std::uint32_t, setting::Any) { return {1, 2}; }
std::array<double, 2> two_of(double, setting::Any) { return {0.25, 0.5}; }
std::array<bool, 2> two_of(bool, setting::Any) { return {false, true}; }
template <typename T, typename Values> auto two_of(const std::optional<T>&, const Values& values) {
    return two_of(T(), values);
}

/// The default settings with the first and with the second value of a row.
std::array<Settings, 2> two_settings(const auto& row) {
    std::array<Settings, 2> settings;
    const auto values = two_of(settings[0].*row.member, row.values);
    for (int i = 0; i < 2; ++i) settings[i].*row.member = values[i];
    return settings;
}

/// The words that give the option of that name the value that `settings` has, as JSON tells it.
Words words_of(const std::string& name, const Settings& settings) {
    const nlohmann::ordered_json json = settings_json(settings);
    const auto value = json.find(json_name(name));
    if (value == json.end()) return {};
    const std::string option = fmt::format("--{}", name);
    if (value->is_boolean()) return *value ? Words{option} : Words{};
    return {option, value->is_string() ? value->get<std::string>() : json_text(*value)};
}

Options parse(Words words) {
    std::vector<const char*> argv{"vkcppm"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    return parse_options(int(argv.size()), argv.data());
}

bool is_taken(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    const auto error = test::thrown_by([&] { parse(words); });
    if (error) {
        EXPECT_EQ(error->code(), ExitCode::usage) << error->what();
    }
    return !error;
}

const Scene& scene() {
    static const Scene scene = [] {
        Scene scene = test::project_scene("point_plane");
        scene.cameras.push_back(scene.cameras.front());
        return scene;
    }();
    return scene;
}

Identity identity_of(const Settings& settings) { return identity_of({}, scene(), settings, nullptr); }

TEST(SettingsTable, NamesAreThoseOfNothingElse) {
    std::set<std::string> names = {"version",
                                   "kernels",
                                   "scene_hash",
                                   "thin_glass",
                                   "reference_hash",
                                   "scene",
                                   "device",
                                   "driver",
                                   "environment",
                                   "animation",
                                   "at",
                                   "variant",
                                   "set",
                                   "punctual_units",
                                   "environment_rotation",
                                   "environment_strength"};
    setting::for_each([&](const auto& row) { EXPECT_TRUE(names.insert(json_name(row.name)).second) << row.name; });
}

TEST(SettingsTable, AnotherValueIsAnotherRenderUnlessItIsABound) {
    std::set<std::string> bounds;
    setting::for_each([&](const auto& row) {
        const auto [first, second] = two_settings(row);
        ASSERT_NE(first, second) << row.name;
        const Identity a = identity_of(first), b = identity_of(second);
        if (a == b) {
            bounds.insert(row.name);
            return;
        }
        ASSERT_EQ(a.size(), b.size()) << row.name;
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].first, b[i].first);
            EXPECT_EQ(a[i].second != b[i].second, a[i].first == json_name(row.name)) << row.name << ", " << a[i].first;
        }
    });
    EXPECT_EQ(bounds, (std::set<std::string>{"iterations", "time"}));
}

TEST(SettingsTable, ACheckpointOfAnotherValueIsRefusedUnlessItIsABound) {
    const test::TemporaryFolder folder;
    Checkpoint checkpoint;
    checkpoint.report.iterations = 1;
    setting::for_each([&](const auto& row) {
        const auto [first, second] = two_settings(row);
        // The third is the one that says nothing of it, of an optional setting.
        const std::array<Settings, 3> all = {first, second, Settings()};
        for (const Settings& there : all) {
            write_checkpoint(folder / "a", identity_of(there), checkpoint);
            for (const Settings& asked : all) {
                const auto error = test::thrown_by([&] { read_checkpoint(folder / "a", identity_of(asked), 1); });
                const bool same = there == asked || row.kind == Kind::bound;
                ASSERT_EQ(!error, same) << row.name;
                if (same) continue;
                const std::string line = error->what();
                EXPECT_EQ(error->code(), ExitCode::usage) << line;
                EXPECT_NE(line.find(json_name(row.name) + ": "), line.npos) << row.name << " is not in: " << line;
            }
        }
    });
}

TEST(SettingsTable, TheCommandLineTakesBackWhatARecordTells) {
    Settings all;
    Words all_words = {"s.gltf"};
    setting::for_each([&](const auto& row) {
        if (row.kind == Kind::internal) return;
        for (const Settings& settings : two_settings(row)) {
            Words words = {"s.gltf"};
            for (const std::string& word : words_of(row.name, settings)) words.push_back(word);
            const Settings got = std::get<RenderOptions>(parse(words)).settings;
            EXPECT_EQ(got.*row.member, settings.*row.member) << row.name;
        }
        all.*row.member = two_settings(row)[1].*row.member;
        for (const std::string& word : words_of(row.name, all)) all_words.push_back(word);
    });
    Settings got = std::get<RenderOptions>(parse(all_words)).settings;
    EXPECT_EQ(got, all);
    got.fstop = all.fstop = std::nullopt;  // which goes without an aperture
    EXPECT_EQ(resolve_settings(got, scene()), all) << "every value is in its range";
}

TEST(SettingsTable, EveryCommandTakesTheKindsThatItShould) {
    setting::for_each([&](const auto& row) {
        SCOPED_TRACE(row.name);
        const bool common =
            row.kind == Kind::bound || row.kind == Kind::picture || row.kind == Kind::paths || row.kind == Kind::view;
        Words words = words_of(row.name, two_settings(row)[1]);
        EXPECT_EQ(is_taken({"s.gltf"}, words), row.kind != Kind::internal);
        EXPECT_EQ(is_taken({"plan", "s.gltf", "-o", "d"}, words),
                  row.kind != Kind::internal && (row.kind != Kind::bound || row.name == std::string("iterations")));
        EXPECT_EQ(is_taken({"race", "s.gltf", "-o", "d"}, words),
                  common || row.kind == Kind::parameter || row.kind == Kind::layers);
        EXPECT_EQ(is_taken({"reference", "s.gltf", "-o", "r.exr"}, words), common);
        words.push_back("");
        const std::string entrant = std::string("cppm:") + row.name + "=" + words[1];
        EXPECT_EQ(is_taken({"race", "s.gltf", "-o", "d", "--estimators", entrant}, {}),
                  row.kind == Kind::parameter || row.kind == Kind::paths);
    });
}

TEST(SettingsTable, WhatAReferenceShowsIsWhatTheCameraSees) {
    std::set<std::string> views;
    setting::for_each([&](const auto& row) {
        if (row.kind == Kind::view) views.insert(row.name);
        EXPECT_TRUE(row.kind != Kind::view || setting::is_of_reference(row.kind)) << row.name;
    });
    EXPECT_EQ(views, (std::set<std::string>{"camera", "aperture", "fstop", "focus-distance"}));
}

TEST(SettingsTable, HelpTellsEveryDefaultAndChoice) {
    const std::string help = std::get<TextOptions>(parse({"--help"})).text;
    EXPECT_EQ(help.find_first_of("{}"), help.npos) << help;
    setting::for_each([&](const auto& row) {
        EXPECT_EQ(help.find(std::string("--") + row.name + " ") != help.npos, row.kind != Kind::internal) << row.name;
    });
    for (const EstimatorRow& row : estimators())
        EXPECT_NE(help.find(fmt::format("{}: {}", row.name, row.summary)), help.npos) << row.name;
}

}  // namespace
}  // namespace vkcppm
