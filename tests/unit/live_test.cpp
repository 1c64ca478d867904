// --live against a viewer that was written from the protocol: every pixel of every size arrives, and no viewer that
// is not there, hangs up or comes later is more than a warning.

#include "app/live.h"

#include <string>

#include <gtest/gtest.h>

#include "app/option_values.h"
#include "support/files/viewer.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

Image numbered(std::uint32_t width, std::uint32_t height, float first) {
    Image image{{width, height}, {}};
    for (std::size_t i = 0; i < image.extent.pixels(); ++i) {
        image.rgb.push_back({first + float(i), first - 0.5f * float(i), 1e-3f * float(i)});
    }
    return image;
}

TEST(Live, EveryPixelArrives) {
    for (const Extent size : {Extent{1, 1}, Extent{128, 128}, Extent{129, 127}, Extent{300, 260}}) {
        test::Viewer viewer;
        const Image last = numbered(size.width, size.height, 7.0f);
        {
            LiveView view({"127.0.0.1", viewer.port()}, "a picture");
            view.show(numbered(size.width, size.height, 1.0f));
            view.show(last);
        }
        viewer.stop();
        EXPECT_EQ(viewer.fault, "");
        EXPECT_EQ(viewer.name, "a picture");
        EXPECT_EQ(viewer.created, 1);
        ASSERT_EQ(viewer.image.extent, size);
        EXPECT_EQ(viewer.image.rgb, last.rgb);
    }
}

TEST(Live, AViewerMayComeLateAndGo) {
    std::string port;
    {
        test::Viewer gone;
        port = gone.port();
    }
    testing::internal::CaptureStderr();
    LiveView nobody({"127.0.0.1", port}, "a");
    nobody.show(numbered(2, 2, 0.0f));
    nobody.show(numbered(2, 2, 0.0f));
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_EQ(told, "warning: --live 127.0.0.1:" + port +
                        ": Connection refused; the render goes on, and the viewer is tried again\n");

    test::Viewer viewer(1);  // takes the first message and hangs up
    LiveView view({"localhost", viewer.port()}, "a");
    testing::internal::CaptureStderr();
    for (int i = 0; i < 50; ++i) view.show(numbered(600, 500, float(i)));
    EXPECT_NE(testing::internal::GetCapturedStderr().find("the render goes on"), std::string::npos);
    viewer.stop();
    EXPECT_GE(viewer.created, 1);
}

TEST(Live, AddressesOfAllKinds) {
    const auto text = [](const std::string& words) { return parse_live("--live", words).text(); };
    EXPECT_EQ(text("localhost:1234"), "localhost:1234");
    EXPECT_EQ(text("farm.example"), "farm.example:14158") << "tev's own port";
    EXPECT_EQ(text("[::1]:99"), "[::1]:99");
    EXPECT_EQ(text("[fe80::2]"), "[fe80::2]:14158");
    for (const char* bad :
         {"", ":", ":80", "a:", "a:b", "a:0", "a:65536", "::1", "[::1", "[::1]x", "a:80:90", "a:-1"}) {
        const auto error = test::thrown_by([&] { text(bad); });
        ASSERT_TRUE(error) << bad;
        EXPECT_EQ(error->code(), ExitCode::usage);
    }
}

}  // namespace
}  // namespace vkcppm
