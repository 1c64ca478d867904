#include "render/settings.h"

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

}  // namespace
}  // namespace vkcppm
