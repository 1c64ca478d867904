#include "render/settings.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/render.h"
#include "support/scenes/shapes.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

Settings with_lens(double aperture, std::optional<double> focus_distance) {
    Settings settings;
    settings.aperture = aperture;
    settings.focus_distance = focus_distance;
    return settings;
}

TEST(Settings, ALensHasAnApertureAndAFocusDistanceOrNeither) {
    const Scene scene = test::bare_room(0.5f);
    EXPECT_FALSE(test::thrown_by([&] { resolve_settings(with_lens(0.0, {}), scene); }));
    const Settings resolved = resolve_settings(with_lens(0.05, 2.5), scene);
    EXPECT_EQ(resolved.aperture, 0.05);
    EXPECT_EQ(resolved.focus_distance, 2.5);

    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    struct Bad {
        Settings settings;
        std::vector<std::string> told;
    };
    const std::vector<Bad> all = {
        {with_lens(-0.1, 1.0), {"--aperture -0.1", "0..1000000000"}},
        {with_lens(nan, 1.0), {"--aperture nan"}},
        {with_lens(infinity, 1.0), {"--aperture inf"}},
        {with_lens(0.1, 0.0), {"--focus-distance 0", "1e-09..1000000000"}},
        {with_lens(0.1, -1.0), {"--focus-distance -1"}},
        {with_lens(0.1, nan), {"--focus-distance nan"}},
        {with_lens(0.1, infinity), {"--focus-distance inf"}},
        {with_lens(0.1, {}), {"--aperture 0.1 needs --focus-distance"}},
        {with_lens(0.0, 1.0), {"--focus-distance 1 needs --aperture"}},
    };
    for (const Bad& bad : all) {
        const auto error = test::thrown_by([&] { resolve_settings(bad.settings, scene); });
        ASSERT_TRUE(error) << bad.told.front();
        EXPECT_EQ(error->code(), ExitCode::usage);
        for (const std::string& part : bad.told) {
            const std::string message = error->what();
            EXPECT_NE(message.find(part), message.npos) << part << " is not in: " << message;
        }
    }
}

TEST(Settings, AnFNumberIsTheFocalLengthOverTheDiameter) {
    Scene scene = test::bare_room(0.5f);
    scene.cameras[0].yfov = 2.0 * std::atan(12.0 / 50.0);  // 24 mm high behind a lens of 50 mm
    Settings settings;
    settings.fstop = 2.0;
    settings.focus_distance = 3.0;
    settings.size = Extent{300, 200};
    EXPECT_NEAR(lens_diameter(resolve_settings(settings, scene), scene.cameras[0]), 0.025, 1e-12);
    settings.size = Extent{24, 36};  // upright: 36 mm high, so half the angle is that of 75 mm
    EXPECT_NEAR(lens_diameter(resolve_settings(settings, scene), scene.cameras[0]), 0.0375, 1e-12);
    const auto refusal = [&] {
        const auto error = test::thrown_by([&] { resolve_settings(settings, scene); });
        return error && error->code() == ExitCode::usage ? std::string(error->what()) : "no refusal";
    };
    settings.aperture = 0.1;
    EXPECT_EQ(refusal(), "--fstop and --aperture exclude one another");
    settings.aperture = 0.0;
    settings.focus_distance.reset();
    EXPECT_EQ(refusal(), "--fstop 2 needs --focus-distance");
    settings.focus_distance = 3.0;
    scene.cameras[0].ymag = 1.0;
    EXPECT_EQ(refusal(), "--fstop needs a perspective camera; --aperture tells the diameter");
}

TEST(Settings, ACameraIsKnownByItsNameItsNodeOrItsNumber) {
    Scene scene = test::bare_room(0.5f);
    scene.cameras.resize(3);
    scene.cameras[0].name = "lens";
    scene.cameras[0].node = "front";
    scene.cameras[1].name = "lens";
    scene.cameras[1].node = "back";
    scene.cameras[2].name = scene.cameras[2].node = "top";
    const auto chosen = [&](const std::string& name) {
        Settings settings;
        settings.camera = name;
        return resolve_settings(settings, scene).camera;
    };
    EXPECT_EQ(chosen(""), "0");
    EXPECT_EQ(chosen("lens"), "0");
    EXPECT_EQ(chosen("front"), "0");
    EXPECT_EQ(chosen("back"), "1");
    EXPECT_EQ(chosen("top"), "2");
    EXPECT_EQ(chosen("1"), "1");
    scene.cameras[2].node = "lens";
    EXPECT_EQ(chosen("lens"), "0") << "a camera's own name comes before that of a node";
    const auto error = test::thrown_by([&] { chosen("side"); });
    ASSERT_TRUE(error);
    EXPECT_NE(std::string(error->what()).find("0 'lens' of 'front', 1 'lens' of 'back', 2 'top' of 'lens'"),
              std::string::npos)
        << error->what();
}

}  // namespace
}  // namespace vkcppm
