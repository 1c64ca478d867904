#include "app/options.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/thrown.h"

namespace vkcppm {
namespace {

Options parse(const std::vector<std::string>& words) {
    std::vector<const char*> argv{"vkcppm"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    return parse_options(int(argv.size()), argv.data());
}

RenderOptions parse_render(std::vector<std::string> words) {
    words.insert(words.begin(), "scene.gltf");
    return std::get<RenderOptions>(parse(words));
}

TEST(Options, DefaultsAreThePapers) {
    const RenderOptions options = parse_render({});
    EXPECT_EQ(options.scene.file, "scene.gltf");
    EXPECT_FALSE(options.scene.environment);
    EXPECT_EQ(options.scene.thin_glass, ThinGlass::thin);
    EXPECT_EQ(options.output, "scene.exr");
    EXPECT_EQ(options.settings.estimator, "cppm");
    EXPECT_EQ(options.settings.iterations, 64u);
    EXPECT_FALSE(options.settings.seconds);
    EXPECT_FALSE(options.settings.photons);
    EXPECT_FALSE(options.settings.size);
    EXPECT_EQ(options.settings.camera, "");
    EXPECT_EQ(options.settings.aperture, 0.0);
    EXPECT_FALSE(options.settings.focus_distance);
    EXPECT_EQ(options.settings.max_depth, 64u);
    EXPECT_EQ(options.settings.knn, 10u);
    EXPECT_DOUBLE_EQ(options.settings.alpha, 2.0 / 3.0);
    EXPECT_DOUBLE_EQ(options.settings.k, 0.8);
    EXPECT_DOUBLE_EQ(options.settings.beta, 1.2);
    EXPECT_DOUBLE_EQ(options.settings.significance, 0.05);
    EXPECT_EQ(options.settings.rings, 2u);
    EXPECT_EQ(options.settings.sectors, 6u);
    EXPECT_EQ(options.device.select, "");
    EXPECT_FALSE(options.device.validate);
    EXPECT_FALSE(options.reference || options.stop_at);
    EXPECT_FALSE(options.png || options.stats || options.quiet || options.verbose);
}

TEST(Options, EveryOptionReachesItsSetting) {
    const RenderOptions options = parse_render({"-o",
                                                "o.exr",
                                                "--png",
                                                "p.png",
                                                "--exposure",
                                                "-1.5",
                                                "--stats",
                                                "s.json",
                                                "--estimator",
                                                "sppm",
                                                "--iterations",
                                                "7",
                                                "--time",
                                                "2m",
                                                "--photons",
                                                "100",
                                                "--size",
                                                "32x16",
                                                "--camera",
                                                "top",
                                                "--seed",
                                                "5",
                                                "--max-depth",
                                                "9",
                                                "--knn",
                                                "11",
                                                "--alpha",
                                                "0.5",
                                                "--k",
                                                "0.25",
                                                "--beta",
                                                "1.5",
                                                "--significance",
                                                "0.01",
                                                "--rings",
                                                "3",
                                                "--sectors",
                                                "4",
                                                "--device",
                                                "uuid:00",
                                                "--quiet",
                                                "--verbose",
                                                "--validate",
                                                "--environment",
                                                "sky.hdr",
                                                "--thin-glass",
                                                "solid",
                                                "--set",
                                                "glass:ior=1.3",
                                                "--punctual-units",
                                                "photometric",
                                                "--set",
                                                "0:dispersion=2",
                                                "--aperture",
                                                "0.01",
                                                "--focus-distance",
                                                "2.5",
                                                "--reference",
                                                "r.exr",
                                                "--stop-at",
                                                "relmse_trimmed=3.5e-3"});
    EXPECT_EQ(options.reference, "r.exr");
    ASSERT_TRUE(options.stop_at);
    EXPECT_EQ(options.stop_at->metric->name, "relmse_trimmed");
    EXPECT_EQ(options.stop_at->value, 0.0035);
    EXPECT_EQ(options.scene.environment, "sky.hdr");
    EXPECT_EQ(options.scene.thin_glass, ThinGlass::solid);
    ASSERT_EQ(options.scene.set.size(), 2u);
    EXPECT_EQ(options.scene.set[0].text(), "glass:ior=1.3");
    EXPECT_EQ(options.scene.set[1].text(), "0:dispersion=2");
    EXPECT_EQ(options.scene.punctual_units, PunctualUnits::photometric);
    EXPECT_EQ(options.settings.aperture, 0.01);
    EXPECT_EQ(options.settings.focus_distance, 2.5);
    EXPECT_EQ(options.output, "o.exr");
    EXPECT_EQ(options.png, "p.png");
    EXPECT_EQ(options.display.exposure, -1.5);
    EXPECT_EQ(options.settings.estimator, "sppm");
    EXPECT_EQ(options.settings.iterations, 7u);
    EXPECT_EQ(options.settings.seconds, 120.0);
    EXPECT_EQ(options.settings.photons, 100u);
    EXPECT_EQ(options.settings.size, (Extent{32, 16}));
    EXPECT_EQ(options.settings.camera, "top");
    EXPECT_EQ(options.settings.seed, 5u);
    EXPECT_EQ(options.settings.max_depth, 9u);
    EXPECT_EQ(options.settings.knn, 11u);
    EXPECT_EQ(options.settings.alpha, 0.5);
    EXPECT_EQ(options.settings.k, 0.25);
    EXPECT_EQ(options.settings.beta, 1.5);
    EXPECT_EQ(options.settings.significance, 0.01);
    EXPECT_EQ(options.settings.rings, 3u);
    EXPECT_EQ(options.settings.sectors, 4u);
    EXPECT_EQ(options.device.select, "uuid:00");
    EXPECT_EQ(options.stats, "s.json");
    EXPECT_TRUE(options.quiet && options.verbose && options.device.validate);
}

TEST(Options, TimeHasUnits) {
    const std::vector<std::pair<std::string, double>> times = {
        {"90", 90.0}, {"90s", 90.0}, {"2m", 120.0}, {"1.5h", 5400.0}, {"500ms", 0.5}, {"1e2", 100.0}, {".5s", 0.5}};
    for (const auto& [text, seconds] : times) {
        EXPECT_DOUBLE_EQ(parse_render({"--time", text}).settings.seconds.value_or(-1.0), seconds) << text;
    }
}

TEST(Options, TimeAloneLiftsTheBoundOnIterations) {
    EXPECT_EQ(parse_render({"--time", "5"}).settings.iterations, 1073741823u);
    EXPECT_EQ(parse_render({"--time", "5", "--iterations", "3"}).settings.iterations, 3u);
}

TEST(Options, TheLargestIntegersFit) {
    EXPECT_EQ(parse_render({"--seed", "4294967295"}).settings.seed, 4294967295u);
    EXPECT_EQ(parse_render({"--seed", "007"}).settings.seed, 7u) << "leading zeros are decimal";
}

TEST(Options, ThePictureIsNamedAfterTheSceneAndLiesHere) {
    EXPECT_EQ(std::get<RenderOptions>(parse({"/far/away/box.v2.glb"})).output, "box.v2.exr");
}

TEST(Options, TheFirstWordChoosesTheCommand) {
    const auto compare = std::get<CompareOptions>(parse({"compare", "a.exr", "b.exr", "--json"}));
    EXPECT_EQ(compare.image, "a.exr");
    EXPECT_EQ(compare.reference, "b.exr");
    EXPECT_TRUE(compare.json);
    const auto check = std::get<CheckOptions>(
        parse({"check", "--max", "flip=0.05", "--max", "relmse=1e-3", "a.exr", "b.exr", "--max-pixels", "0.1%",
               "--pixel-bound", "0.02", "--level", "5%", "--junit", "j.xml", "--report", "d", "--exposure", "auto"}));
    EXPECT_EQ(check.image, "a.exr");
    EXPECT_EQ(check.reference, "b.exr");
    ASSERT_EQ(check.settings.bounds.size(), 2u);
    EXPECT_EQ(check.settings.bounds[1].name, "relmse");
    EXPECT_EQ(check.settings.bounds[1].most, 1e-3);
    EXPECT_DOUBLE_EQ(check.settings.max_pixels.value_or(0.0), 0.001);
    EXPECT_EQ(check.settings.pixel_bound, 0.02);
    EXPECT_DOUBLE_EQ(check.settings.level.value_or(0.0), 0.05);
    EXPECT_EQ(check.junit, "j.xml");
    EXPECT_EQ(check.report, "d");
    EXPECT_FALSE(check.display.exposure);
    EXPECT_FALSE(check.update || check.json);
    EXPECT_FALSE(std::get<CheckOptions>(parse({"check", "a", "b"})).settings.level);
    const auto info =
        std::get<InfoOptions>(parse({"info", "--json", "a.glb", "--environment", "b.exr", "--thin-glass", "solid"}));
    EXPECT_EQ(info.scene.file, "a.glb");
    EXPECT_EQ(info.scene.environment, "b.exr");
    EXPECT_EQ(info.scene.thin_glass, ThinGlass::solid);
    EXPECT_TRUE(info.json);
    EXPECT_FALSE(info.memory);
    const auto memory = std::get<InfoOptions>(parse({"info", "a.glb", "--memory", "--size", "30x20", "--aovs"}));
    EXPECT_TRUE(memory.memory);
    EXPECT_EQ(memory.settings.size->pixels(), 600u);
    EXPECT_TRUE(memory.settings.aovs);
    EXPECT_FALSE(std::get<DevicesOptions>(parse({"devices"})).json);
    EXPECT_TRUE(std::get<DoctorOptions>(parse({"doctor", "--json"})).json);
    EXPECT_EQ(std::get<RenderOptions>(parse({"./compare"})).scene.file, "./compare");
    EXPECT_EQ(std::get<RenderOptions>(parse({"--quiet", "info"})).scene.file, "info");
}

TEST(Options, AReferenceHasItsOwn) {
    const auto standard = std::get<ReferenceOptions>(parse({"reference", "a.gltf", "-o", "r.exr"}));
    EXPECT_EQ(standard.scene.file, "a.gltf");
    EXPECT_EQ(standard.output, "r.exr");
    EXPECT_EQ(standard.settings.samples, 1024u);
    EXPECT_EQ(standard.settings.trust, 0.05);
    EXPECT_FALSE(standard.settings.render.seconds);
    EXPECT_FALSE(standard.half || standard.json || standard.quiet);

    const auto timed = std::get<ReferenceOptions>(parse({"reference", "a.gltf", "-o", "r.exr", "--time", "10m"}));
    EXPECT_EQ(timed.settings.render.seconds, 600.0);
    EXPECT_EQ(timed.settings.samples, unbounded_samples);
    EXPECT_EQ(timed.settings.render.iterations, unbounded_iterations);

    const auto all = std::get<ReferenceOptions>(
        parse({"reference", "a.gltf",       "-o",      "r.exr",     "--time",      "2s",      "--samples",
               "256",       "--iterations", "40",      "--photons", "99",          "--trust", "0.1",
               "--size",    "20x10",        "--seed",  "7",         "--max-depth", "9",       "--half",
               "--json",    "--quiet",      "--stats", "s.json",    "--aperture",  "0.1",     "--focus-distance",
               "2"}));
    EXPECT_EQ(all.settings.samples, 256u);
    EXPECT_EQ(all.settings.render.iterations, 40u);
    EXPECT_EQ(all.settings.render.photons, 99u);
    EXPECT_EQ(all.settings.trust, 0.1);
    EXPECT_EQ(all.settings.render.size, (Extent{20, 10}));
    EXPECT_EQ(all.settings.render.seed, 7u);
    EXPECT_EQ(all.settings.render.max_depth, 9u);
    EXPECT_EQ(all.settings.render.aperture, 0.1);
    EXPECT_EQ(all.settings.render.focus_distance, 2.0);
    EXPECT_EQ(all.stats, "s.json");
    EXPECT_TRUE(all.half && all.json && all.quiet);
}

TEST(Options, HelpNamesEveryOptionAndEstimator) {
    const std::string help = std::get<TextOptions>(parse({"--help"})).text;
    for (const char* name : {"SCENE",         "-o",           "--estimator",    "--iterations",
                             "--time",        "--photons",    "--size",         "--camera",
                             "--seed",        "--max-depth",  "--knn",          "--alpha",
                             "--k ",          "--beta",       "--significance", "--device",
                             "--stats",       "--quiet",      "--verbose",      "--png",
                             "--exposure",    "--rings",      "--sectors",      "--validate",
                             "--version",     "cppm",         "sppm:",          "sppm-kz",
                             "race",          "reference",    "compare",        "check",
                             "--tone-map",    "info",         "devices",        "73",
                             "--environment", "--thin-glass", "--aperture",     "--focus-distance",
                             "--reference",   "--stop-at",    "smape_trimmed",  "clock"}) {
        EXPECT_NE(help.find(name), std::string::npos) << name << " is not in\n" << help;
    }
    EXPECT_NE(std::get<TextOptions>(parse({"compare", "--help"})).text.find("REFERENCE"), std::string::npos);
    EXPECT_EQ(std::get<RenderOptions>(parse({"--quiet", "--", "-odd.gltf"})).scene.file, "-odd.gltf");
    EXPECT_EQ(std::get<TextOptions>(parse({"--version"})).text.substr(0, 7), "vkcppm ");
}

RaceOptions parse_race(std::vector<std::string> words) {
    words.insert(words.begin(), {"race", "s.gltf", "-o", "out"});
    return std::get<RaceOptions>(parse(words));
}

TEST(Options, ARaceIsOfThreeForAMinute) {
    const RaceOptions options = parse_race({});
    EXPECT_EQ(options.scene.file, "s.gltf");
    EXPECT_EQ(options.folder, "out");
    EXPECT_EQ(options.race.seeds, 1u);
    EXPECT_FALSE(options.reference);
    ASSERT_EQ(options.race.entrants.size(), 3u);
    EXPECT_EQ(options.race.entrants[0].name, "cppm");
    EXPECT_EQ(options.race.entrants[1].settings.estimator, "sppm");
    for (const Entrant& entrant : options.race.entrants) {
        EXPECT_EQ(entrant.settings.seconds, 60.0);
        EXPECT_EQ(entrant.settings.iterations, unbounded_iterations);
        EXPECT_FALSE(entrant.settings.photons);
    }
}

TEST(Options, EntrantsHaveParametersOfTheirOwn) {
    const RaceOptions options = parse_race(
        {"--estimators", "cppm:beta=1.5:k=0.7,sppm:alpha=0.5,ftest:rings=3:sectors=8:significance=1e-2:knn=20,cppm",
         "--k",          "0.6",
         "--photons",    "77",
         "--iterations", "9",
         "--seeds",      "4",
         "--seed",       "5",
         "--size",       "8x4",
         "--reference",  "r.exr",
         "--exposure",   "2",
         "--device",     "0",
         "--quiet"});
    const std::vector<Entrant>& entrants = options.race.entrants;
    ASSERT_EQ(entrants.size(), 4u);
    EXPECT_EQ(entrants[0].name, "cppm:beta=1.5:k=0.7");
    EXPECT_EQ(entrants[0].settings.estimator, "cppm");
    EXPECT_EQ(entrants[0].settings.beta, 1.5);
    EXPECT_EQ(entrants[0].settings.k, 0.7);
    EXPECT_EQ(entrants[1].settings.estimator, "sppm");
    EXPECT_EQ(entrants[1].settings.alpha, 0.5);
    EXPECT_EQ(entrants[1].settings.k, 0.6) << "of the command line where it has none of its own";
    EXPECT_EQ(entrants[2].settings.rings, 3u);
    EXPECT_EQ(entrants[2].settings.sectors, 8u);
    EXPECT_EQ(entrants[2].settings.significance, 0.01);
    EXPECT_EQ(entrants[2].settings.knn, 20u);
    EXPECT_EQ(entrants[3].settings.beta, 1.2);
    for (const Entrant& entrant : entrants) {
        EXPECT_EQ(entrant.settings.photons, 77u);
        EXPECT_EQ(entrant.settings.iterations, 9u);
        EXPECT_FALSE(entrant.settings.seconds);
        EXPECT_EQ(entrant.settings.seed, 5u);
        EXPECT_EQ(entrant.settings.size, (Extent{8, 4}));
    }
    EXPECT_EQ(options.race.seeds, 4u);
    EXPECT_EQ(options.reference, "r.exr");
    EXPECT_EQ(options.display.exposure, 2.0);
    EXPECT_EQ(options.device.select, "0");
    EXPECT_TRUE(options.quiet);
    EXPECT_FALSE(options.make_reference);
    EXPECT_EQ(parse_race({"--make-reference", "10m"}).make_reference, 600.0);
}

TEST(Options, ARaceRemembersItsCommandForAShell) {
    EXPECT_EQ(parse_race({"--camera", "it's top", "--size", "8x4", "--estimators", "cppm:k=0.5"}).command,
              "vkcppm race s.gltf -o out --camera 'it'\\''s top' --size 8x4 --estimators cppm:k=0.5");
}

struct BadLine {
    std::vector<std::string> words;
    std::vector<std::string> told;  // parts of the message
};

TEST(Options, RefuseEveryBadLineWithOptionValueAndRange) {
    const std::vector<BadLine> lines = {
        {{}, {"SCENE"}},
        {{"s", "t"}, {"t"}},
        {{"race", "s"}, {"-o"}},
        {{"race", "s", "-o", "d", "--reference", "r.exr", "--make-reference", "1m"},
         {"--make-reference", "--reference"}},
        {{"race", "s", "-o", "d", "--seeds", "0"}, {"--seeds", "0"}},
        {{"race", "s", "-o", "d", "--estimators", "cppm,nonsense"}, {"nonsense", "cppm-lf"}},
        {{"race", "s", "-o", "d", "--estimators",
          "cppm,"
          ",sppm"},
         {"none of", "cppm"}},
        {{"race", "s", "-o", "d", "--estimators", "cppm:gamma=1"}, {"--estimators", "cppm:gamma=1", "beta", "gamma"}},
        {{"race", "s", "-o", "d", "--estimators", "cppm:seed=1"}, {"--estimators", "seed", "knn, alpha"}},
        {{"race", "s", "-o", "d", "--estimators", "cppm:beta"}, {"--estimators", "cppm:beta", "PARAMETER=VALUE"}},
        {{"race", "s", "-o", "d", "--estimators", "sppm,cppm:beta=x"},
         {"--estimators: 'cppm:beta=x'", "'x'", "finite"}},
        {{"race", "s", "-o", "d", "--estimators", "cppm:k=0.5:k=0.6"}, {"'cppm:k=0.5:k=0.6': --k is given 2 times"}},
        {{"race", "s", "-o", "d", "--estimator", "cppm"}, {"--estimator"}},
        {{"s", "--bogus"}, {"there is no option --bogus ("}},
        {{"s", "--bogus=1"}, {"there is no option --bogus=1 ("}},
        {{"s", "-x"}, {"there is no option -x ("}},
        {{"-x"}, {"there is no option -x ("}},
        {{"s", "--iter", "5"}, {"there is no option --iter: is it --iterations? ("}},
        {{"s", "--photon", "5"}, {"there is no option --photon: is it --photons? ("}},
        {{"s", "--pgn", "p.png"}, {"there is no option --pgn ("}},
        {{"plan", "s", "-o", "j", "--time", "9"}, {"there is no option --time ("}},
        {{""}, {"SCENE is empty ("}},
        {{"s", "--root", ""}, {"--root is empty ("}},
        {{"s", "--estiamtor=sppm"}, {"there is no option --estiamtor=sppm: is it --estimator? ("}},
        {{"render", "s"}, {"'s' has no place: SCENE is 'render' ("}},
        {{"compare", "a", "b", "c"}, {"'c' has no place: IMAGE is 'a' ("}},
        {{"s", "--photons"}, {"--photons needs N ("}},
        {{"s", "-o"}, {"-o needs OUT.exr ("}},
        {{"s", "--photons", ""}, {"--photons", "''", "whole number, such as"}},
        {{"s", "--photons", "-1"}, {"--photons", "'-1'", "whole number, such as"}},
        {{"s", "--photons=-1"}, {"--photons", "'-1'"}},
        {{"s", "--photons", "4294967296"}, {"--photons", "'4294967296'", "below 2^32"}},
        {{"s", "--photons", "99999999999999999999999"}, {"--photons", "'99999999999999999999999'"}},
        {{"s", "--photons", "1.5"}, {"--photons", "'1.5'"}},
        {{"s", "--photons", "1e3"}, {"--photons", "'1e3'"}},
        {{"s", "--photons", "0x10"}, {"--photons", "'0x10'"}},
        {{"s", "--photons", " 1"}, {"--photons", "' 1'"}},
        {{"s", "--photons", "many"}, {"--photons", "'many'"}},
        {{"s", "--thin-glass", "thick"}, {"--thin-glass", "'thick'", "thin or solid"}},
        {{"info", "s", "--thin-glass", ""}, {"--thin-glass", "''", "thin or solid"}},
        {{"info", "s", "--aperture", "1"}, {"--aperture"}},
        {{"s", "--aperture", "wide"}, {"--aperture", "'wide'", "finite number"}},
        {{"s", "--focus-distance", "inf"}, {"--focus-distance", "'inf'", "finite number"}},
        {{"s", "--environment"}, {"--environment"}},
        {{"s", "--photons", "1", "--photons", "2"}, {"--photons is given 2 times: '1', '2' ("}},
        {{"s", "--iterations", "-5"}, {"--iterations", "'-5'"}},
        {{"s", "--seed", "-1"}, {"--seed", "'-1'"}},
        {{"s", "--max-depth", "x"}, {"--max-depth", "'x'"}},
        {{"s", "--knn", "x"}, {"--knn", "'x'"}},
        {{"s", "--rings", "x"}, {"--rings", "'x'"}},
        {{"s", "--sectors", "x"}, {"--sectors", "'x'"}},
        {{"s", "--alpha", "nan"}, {"--alpha", "'nan'", "finite"}},
        {{"s", "--alpha", "inf"}, {"--alpha", "'inf'", "finite"}},
        {{"s", "--alpha", "1e999"}, {"--alpha", "'1e999'"}},
        {{"s", "--k", "0,5"}, {"--k", "'0,5'"}},
        {{"s", "--beta", "x"}, {"--beta", "'x'"}},
        {{"s", "--significance", "5%"}, {"--significance", "'5%'"}},
        {{"s", "--time", "0"}, {"--time", "'0'", "greater than 0", "500ms"}},
        {{"s", "--time", "-3s"}, {"--time", "'-3s'"}},
        {{"s", "--time", "nan"}, {"--time", "'nan'"}},
        {{"s", "--time", "inf"}, {"--time", "'inf'"}},
        {{"s", "--time", "1e308h"}, {"--time", "'1e308h'"}},
        {{"s", "--time", "5 s"}, {"--time", "'5 s'"}},
        {{"s", "--time", "5d"}, {"--time", "'5d'"}},
        {{"s", "--time", "s"}, {"--time", "'s'"}},
        {{"s", "--size", "64"}, {"--size", "'64'", "WIDTHxHEIGHT"}},
        {{"s", "--size", "64x"}, {"--size", "'64x'"}},
        {{"s", "--size", "x64"}, {"--size", "'x64'"}},
        {{"s", "--size", "64x64x64"}, {"--size", "'64x64x64'"}},
        {{"s", "--size", "-64x64"}, {"--size", "'-64x64'"}},
        {{"s", "--size", "64X64"}, {"--size", "'64X64'"}},
        {{"s", "--size", "4294967296x1"}, {"--size", "'4294967296x1'"}},
        {{"s", "--exposure", "x", "--png", "p"}, {"--exposure", "'x'", "auto or a number"}},
        {{"s", "--exposure", "1"}, {"--exposure", "--png"}},
        {{"s", "--exposure", "129", "--png", "p"}, {"--exposure", "'129'", "auto", "128"}},
        {{"s", "--tone-map", "aces"}, {"--tone-map", "--png"}},
        {{"s", "--tone-map", "filmic", "--png", "p"}, {"--tone-map", "'filmic'", "none, reinhard, aces or agx"}},
        {{"s", "--png-depth", "12", "--png", "p"}, {"--png-depth", "'12'", "8 or 16"}},
        {{"s", "--png-depth", "16"}, {"--png-depth", "--png"}},
        {{"s", "--stop-at", "relmse=1"}, {"--stop-at", "--reference"}},
        {{"s", "--reference", "r", "--stop-at", "relmse"}, {"--stop-at", "'relmse'", "METRIC=VALUE"}},
        {{"s", "--reference", "r", "--stop-at", "0.1"}, {"--stop-at", "'0.1'", "METRIC=VALUE"}},
        {{"s", "--reference", "r", "--stop-at", "=1"}, {"--stop-at", "''", "relmse_trimmed"}},
        {{"s", "--reference", "r", "--stop-at", "flip=1"}, {"--stop-at", "'flip'", "relmse_trimmed", "smape"}},
        {{"s", "--reference", "r", "--stop-at", "psnr=30"}, {"--stop-at", "'psnr'", "srgb_mse"}},
        {{"s", "--reference", "r", "--stop-at", "mse="}, {"--stop-at", "'mse='", "greater than 0"}},
        {{"s", "--reference", "r", "--stop-at", "mse=0"}, {"--stop-at", "'mse=0'", "greater than 0"}},
        {{"s", "--reference", "r", "--stop-at", "mse=-1"}, {"--stop-at", "'mse=-1'", "greater than 0"}},
        {{"s", "--reference", "r", "--stop-at", "mse=inf"}, {"--stop-at", "'mse=inf'", "finite"}},
        {{"s", "--reference", "r", "--stop-at", "mse=nan"}, {"--stop-at", "'mse=nan'", "finite"}},
        {{"s", "--reference", "r", "--stop-at", "mse=1 "}, {"--stop-at", "'mse=1 '"}},
        {{"s", "--reference", "r", "--stop-at", "mse=1", "--stop-at", "mse=2"}, {"--stop-at"}},
        {{"compare"}, {"IMAGE"}},
        {{"compare", "a"}, {"REFERENCE"}},
        {{"compare", "a", "b", "c"}, {"c"}},
        {{"compare", "a", "b", "--quiet"}, {"--quiet"}},
        {{"check", "a"}, {"REFERENCE"}},
        {{"check", "a", "b", "--max", "relmse"}, {"--max", "'relmse'", "METRIC=VALUE", "flip"}},
        {{"check", "a", "b", "--max", "psnr=30"}, {"--max", "'psnr'", "srgb_mse", "ldr_flip"}},
        {{"check", "a", "b", "--max", "flip=-1"}, {"--max", "'flip=-1'", "0 or more"}},
        {{"check", "a", "b", "--max", "flip=nan"}, {"--max", "'flip=nan'", "finite"}},
        {{"check", "a", "b", "--max-pixels", "many"}, {"--max-pixels", "'many'", "0.1%"}},
        {{"check", "a", "b", "--max-pixels", "101%"}, {"--max-pixels", "1.01", "above 1"}},
        {{"check", "a", "b", "--pixel-bound", "5%"}, {"--pixel-bound", "--max-pixels"}},
        {{"check", "a", "b", "--level", "0"}, {"--level 0", "between 0 and 1"}},
        {{"check", "a", "b", "--level", "1"}, {"--level 1", "between 0 and 1"}},
        {{"check", "a", "b", "--update", "--json"}, {"--update excludes --json"}},
        {{"check", "a", "b", "--exposure", "1"}, {"--exposure", "--report"}},
        {{"info"}, {"SCENE"}},
        {{"devices", "x"}, {"x"}},
    };
    for (const BadLine& line : lines) {
        std::string shown;
        for (const std::string& word : line.words) shown += " " + word;
        const auto error = test::thrown_by([&] { parse(line.words); });
        ASSERT_TRUE(error) << "taken:" << shown;
        EXPECT_EQ(int(error->code()), 2) << shown;
        for (const std::string& part : line.told) {
            EXPECT_NE(std::string(error->what()).find(part), std::string::npos)
                << shown << ": '" << part << "' is not in: " << error->what();
        }
        EXPECT_EQ(std::string(error->what()).find('\n'), std::string::npos) << error->what();
    }
}

}  // namespace
}  // namespace vkcppm
