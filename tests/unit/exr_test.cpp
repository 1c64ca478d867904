#include "io/exr.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using Imath::Box2i;
using Imath::V2i;

/// Every pixel and channel differs from every other, so that a swap or a flip shows.
Image numbered(std::uint32_t width, std::uint32_t height) {
    Image image{{width, height}, {}};
    for (std::size_t i = 0; i < image.extent.pixels(); ++i) {
        const float value = float(i) * 0.37f;
        image.rgb.push_back({value, -value - 0.25f, 1e-6f * value});
    }
    return image;
}

/// A channel of one value.
struct Plane {
    const char* name;
    Imf::PixelType type;
    float value;
};

/// Writes such channels by OpenEXR alone.
void write_planes(const fs::path& file, const Box2i& display, const Box2i& data, const std::vector<Plane>& planes,
                  bool tiled = false) {
    Imf::Header header(display, data);
    const std::size_t pixels = std::size_t(data.max.x - data.min.x + 1) * std::size_t(data.max.y - data.min.y + 1);
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<half>> halves;
    floats.reserve(planes.size());
    halves.reserve(planes.size());
    Imf::FrameBuffer frame;
    const std::size_t columns = std::size_t(data.max.x - data.min.x + 1);
    for (const Plane& plane : planes) {
        header.channels().insert(plane.name, Imf::Channel(plane.type));
        if (plane.type == Imf::HALF) {
            halves.emplace_back(pixels, half(plane.value));
            frame.insert(plane.name,
                         Imf::Slice::Make(Imf::HALF, halves.back().data(), data, sizeof(half), sizeof(half) * columns));
        } else {
            floats.emplace_back(pixels, plane.value);
            frame.insert(plane.name, Imf::Slice::Make(Imf::FLOAT, floats.back().data(), data, sizeof(float),
                                                      sizeof(float) * columns));
        }
    }
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
        Imf::TiledOutputFile output(file.c_str(), header);
        output.setFrameBuffer(frame);
        output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
    } else {
        Imf::OutputFile output(file.c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(data.max.y - data.min.y + 1);
    }
}

const std::vector<Plane> half_rgb = {{"R", Imf::HALF, 0.5f}, {"G", Imf::HALF, 2.0f}, {"B", Imf::HALF, 0.125f}};

Box2i box(int left, int top, int right, int bottom) { return {V2i(left, top), V2i(right, bottom)}; }

TEST(Exr, KeepsEveryBit) {
    const test::TemporaryFolder folder;
    using Limits = std::numeric_limits<float>;
    Image image = numbered(19, 35);  // more than two ZIP blocks of 16 lines
    image.rgb[0] = {Limits::max(), Limits::denorm_min(), -0.0f};
    image.rgb[1] = {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()};
    write_exr(folder / "a.exr", image);
    const Image read = read_exr(folder / "a.exr");
    ASSERT_EQ(read.extent, image.extent);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(read.rgb[i][c]), std::bit_cast<std::uint32_t>(image.rgb[i][c]))
                << "pixel " << i << " channel " << c << ": " << read.rgb[i][c] << " for " << image.rgb[i][c];
        }
    }
    EXPECT_EQ(test::names_in(folder.path()), std::set<std::string>{"a.exr"});
}

TEST(Exr, IsLinearFloatRec709WithTheFirstRowOnTop) {
    const test::TemporaryFolder folder;
    const Image image = numbered(5, 3);
    write_exr(folder / "a.exr", image);
    Imf::InputFile input((folder / "a.exr").c_str());
    const Imf::Header& header = input.header();
    EXPECT_EQ(header.dataWindow(), box(0, 0, 4, 2));
    EXPECT_EQ(header.displayWindow(), box(0, 0, 4, 2));
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.lineOrder(), Imf::INCREASING_Y);
    ASSERT_TRUE(Imf::hasChromaticities(header));
    const Imf::Chromaticities& primaries = Imf::chromaticities(header);
    EXPECT_EQ(primaries.red, Imath::V2f(0.64f, 0.33f));
    EXPECT_EQ(primaries.green, Imath::V2f(0.30f, 0.60f));
    EXPECT_EQ(primaries.blue, Imath::V2f(0.15f, 0.06f));
    EXPECT_EQ(primaries.white, Imath::V2f(0.3127f, 0.3290f));
    std::string channels;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        channels += it.name();
        EXPECT_EQ(it.channel().type, Imf::FLOAT) << it.name();
    }
    EXPECT_EQ(channels, "BGR");

    std::vector<float> green(15);
    Imf::FrameBuffer frame;
    frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(green.data()), sizeof(float), 5 * sizeof(float)));
    input.setFrameBuffer(frame);
    input.readPixels(0, 0);
    for (std::uint32_t x = 0; x < 5; ++x) EXPECT_EQ(green[x], image.at(x, 0).g) << "column " << x << " of the top row";
}

TEST(Exr, WritesTheSameBytesEachTime) {
    const test::TemporaryFolder folder;
    const Image image = numbered(64, 64);
    const ExrAttributes attributes = {{"vkcppm.seed", "1"}, {"vkcppm.estimator", "cppm"}};
    write_exr(folder / "a.exr", image, attributes);
    write_exr(folder / "b.exr", image, attributes);
    EXPECT_EQ(test::read_bytes(folder / "a.exr"), test::read_bytes(folder / "b.exr"));
}

TEST(Exr, KeepsTextAttributes) {
    const test::TemporaryFolder folder;
    const std::string long_name = "vkcppm." + std::string(100, 'n');
    const ExrAttributes attributes = {
        {"vkcppm.version", "0.1.0"}, {"vkcppm.device", ""}, {"vkcppm.camera", "Kamera Süd\n2"}, {long_name, "x"}};
    write_exr(folder / "a.exr", numbered(2, 2), attributes);
    ExrAttributes sorted = attributes;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(read_exr_attributes(folder / "a.exr"), sorted);
}

TEST(Exr, TakesFurtherChannels) {
    const test::TemporaryFolder folder;
    const Image image = numbered(3, 2);
    ExrChannels channels = to_channels(image);
    channels.values["radius"] = {1, 2, 3, 4, 5, 6};
    write_exr(folder / "a.exr", channels);
    EXPECT_EQ(read_exr(folder / "a.exr"), image);
    Imf::InputFile input((folder / "a.exr").c_str());
    std::vector<float> radius(6);
    Imf::FrameBuffer frame;
    frame.insert("radius",
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(radius.data()), sizeof(float), 3 * sizeof(float)));
    input.setFrameBuffer(frame);
    input.readPixels(0, 1);
    EXPECT_EQ(radius, channels.values["radius"]);
}

TEST(Exr, RoundsToHalfFloatsWhereThatIsAskedFor) {
    const test::TemporaryFolder folder;
    const Image image = numbered(7, 5);
    ExrChannels channels = to_channels(image);
    channels.values["Trust"].assign(35, 1.0f);
    write_exr(folder / "a.exr", channels, {{"vkcppm.seed", "1"}}, ExrDepth::half);
    Imf::InputFile input((folder / "a.exr").c_str());
    for (auto it = input.header().channels().begin(); it != input.header().channels().end(); ++it) {
        EXPECT_EQ(it.channel().type, Imf::HALF) << it.name();
    }
    const Image read = read_exr(folder / "a.exr");
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(read.rgb[i][c], float(Imath::half(image.rgb[i][c]))) << i << ", " << c;
    }
}

TEST(Exr, WhatIsBeyondHalfFloatsBecomesTheLargest) {
    const test::TemporaryFolder folder;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    ExrChannels channels{{4, 1}, {}};
    channels.values["R"] = {65504.0f, 65505.0f, 1e30f, infinity};
    channels.values["G"] = {-65504.0f, -1e6f, -infinity, 0.0f};
    channels.values["B"] = {1.0f, 2.0f, 3.0f, 4.0f};
    EXPECT_EQ(beyond_halves(channels), 3u);
    write_exr(folder / "a.exr", channels, {}, ExrDepth::half);
    const ExrChannels read = read_exr_channels(folder / "a.exr", "");
    EXPECT_EQ(read.values.at("R"), (std::vector{65504.0f, 65504.0f, 65504.0f, infinity}));
    EXPECT_EQ(read.values.at("G"), (std::vector{-65504.0f, -65504.0f, -infinity, 0.0f}));
    EXPECT_EQ(read.values.at("B"), channels.values["B"]);
}

TEST(Exr, ReadsHalfMixedAndTiledFilesOfAnyChannels) {
    const test::TemporaryFolder folder;
    const std::vector<Plane> mixed = {{"A", Imf::HALF, 1.0f},
                                      {"B", Imf::FLOAT, 0.125f},
                                      {"Z", Imf::FLOAT, 9.0f},
                                      {"R", Imf::HALF, 0.5f},
                                      {"G", Imf::FLOAT, 2.0f}};
    const Box2i window = box(0, 0, 20, 10);
    write_planes(folder / "half.exr", window, window, half_rgb);
    write_planes(folder / "mixed.exr", window, window, mixed);
    write_planes(folder / "tiled.exr", window, window, half_rgb, true);
    for (const char* name : {"half.exr", "mixed.exr", "tiled.exr"}) {
        const Image image = read_exr(folder / name);
        EXPECT_EQ(image.extent, (Extent{21, 11})) << name;
        EXPECT_EQ(image.rgb, std::vector<glm::vec3>(231, glm::vec3(0.5f, 2.0f, 0.125f))) << name;
    }
}

TEST(Exr, ShowsTheDisplayWindow) {
    const test::TemporaryFolder folder;
    const Box2i display = box(10, -5, 19, 2);  // 10 x 8
    for (const Box2i& data : {box(12, -3, 15, 0), box(5, -9, 30, 8), box(-4, -5, 12, 2), box(18, 1, 40, 40),
                              box(100, 100, 103, 101), box(10, 20, 19, 22)}) {
        write_planes(folder / "a.exr", display, data, half_rgb);
        const Image image = read_exr(folder / "a.exr");
        ASSERT_EQ(image.extent, (Extent{10, 8}));
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 10; ++x) {
                const glm::vec3 expected =
                    data.intersects(V2i(10 + x, y - 5)) ? glm::vec3(0.5f, 2.0f, 0.125f) : glm::vec3(0.0f);
                EXPECT_EQ(image.at(std::uint32_t(x), std::uint32_t(y)), expected)
                    << "pixel " << x << ", " << y << " of the data window " << data.min << " to " << data.max;
            }
        }
    }
}

TEST(Exr, PlacesTheDataWindowWhereItBelongs) {
    const test::TemporaryFolder folder;
    const Image image = numbered(6, 4);
    // The same pixels as a crop at (3, 2) of a display of 12 x 9.
    Imf::Header header(box(0, 0, 11, 8), box(3, 2, 8, 5));
    Imf::FrameBuffer frame;
    for (int c = 0; const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, &image.rgb[0][c++], header.dataWindow(), sizeof(glm::vec3),
                                            6 * sizeof(glm::vec3)));
    }
    {
        Imf::OutputFile output((folder / "a.exr").c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(4);
    }
    const Image read = read_exr(folder / "a.exr");
    ASSERT_EQ(read.extent, (Extent{12, 9}));
    for (std::uint32_t y = 0; y < 4; ++y) {
        for (std::uint32_t x = 0; x < 6; ++x) EXPECT_EQ(read.at(x + 3, y + 2), image.at(x, y)) << x << ", " << y;
    }
}

void expect_refusal(const fs::path& file, ExitCode code, const std::string& reason) {
    const auto error = test::thrown_by([&] { read_exr(file); });
    ASSERT_TRUE(error) << file << " was read";
    EXPECT_EQ(int(error->code()), int(code)) << error->what();
    EXPECT_NE(std::string(error->what()).find(file.string()), std::string::npos) << error->what();
    EXPECT_NE(std::string(error->what()).find(reason), std::string::npos) << error->what();
}

TEST(Exr, RefusesWhatIsNoPicture) {
    const test::TemporaryFolder folder;
    expect_refusal(folder / "missing.exr", ExitCode::no_input, "no such file");
    expect_refusal(folder.path(), ExitCode::no_input, "it is a folder");
    test::write_bytes(folder / "empty.exr", "");
    expect_refusal(folder / "empty.exr", ExitCode::bad_input, "cannot read");
    test::write_bytes(folder / "text.exr", "this is no picture, however long its text may be\n");
    expect_refusal(folder / "text.exr", ExitCode::bad_input, "cannot read");
    const auto error = test::thrown_by([&] { read_exr_attributes(folder / "text.exr"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::bad_input);
}

TEST(Exr, NamesAMissingChannel) {
    const test::TemporaryFolder folder;
    write_planes(folder / "a.exr", box(0, 0, 3, 3), box(0, 0, 3, 3), {{"R", Imf::HALF, 1.0f}, {"B", Imf::HALF, 1.0f}});
    expect_refusal(folder / "a.exr", ExitCode::bad_input, "no channel G in its first part, but 'B'");
}

/// Of whatever it reads as: (0.4, 0.5, 0.6) and white, in these primaries (x, y).
std::array<glm::vec3, 2> read_in(const Imf::Chromaticities& primaries) {
    const test::TemporaryFolder folder;
    std::array<std::array<float, 2>, 3> planes = {{{0.4f, 1.0f}, {0.5f, 1.0f}, {0.6f, 1.0f}}};
    Imf::Header header(2, 1);
    Imf::addChromaticities(header, primaries);
    Imf::FrameBuffer frame;
    for (int c = 0; const char* name : {"R", "G", "B"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, planes[c++].data(), header.dataWindow()));
    }
    {
        Imf::OutputFile output((folder / "a.exr").c_str(), header);
        output.setFrameBuffer(frame);
        output.writePixels(1);
    }
    const Image image = read_exr(folder / "a.exr");
    return {image.at(0, 0), image.at(1, 0)};
}

void expect_colour(const glm::vec3& got, const glm::vec3& want, float tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], tolerance) << "channel " << c;
}

// Matrices as published: ITU-R BT.2087-0 (the inverse of its Table 2), and ACES AP1 to Rec. 709 of the ACES system,
// which adapts by Bradford's cones from D60.
TEST(Exr, BringsOtherPrimariesToRec709) {
    using Imath::V2f;
    const V2f d65(0.3127f, 0.3290f), aces_white(0.32168f, 0.33767f);
    const auto rec2020 = read_in({V2f(0.708f, 0.292f), V2f(0.170f, 0.797f), V2f(0.131f, 0.046f), d65});
    expect_colour(rec2020[0],
                  {1.6605f * 0.4f - 0.5876f * 0.5f - 0.0728f * 0.6f, -0.1246f * 0.4f + 1.1329f * 0.5f - 0.0083f * 0.6f,
                   -0.0182f * 0.4f - 0.1006f * 0.5f + 1.1187f * 0.6f},
                  2e-4f);
    expect_colour(rec2020[1], glm::vec3(1.0f), 1e-5f);
    const auto ap1 = read_in({V2f(0.713f, 0.293f), V2f(0.165f, 0.830f), V2f(0.128f, 0.044f), aces_white});
    expect_colour(
        ap1[0],
        {1.70505f * 0.4f - 0.62179f * 0.5f - 0.08326f * 0.6f, -0.13026f * 0.4f + 1.14080f * 0.5f - 0.01055f * 0.6f,
         -0.02400f * 0.4f - 0.12897f * 0.5f + 1.15297f * 0.6f},
        2e-4f);
    expect_colour(ap1[1], glm::vec3(1.0f), 1e-5f);
    const auto own = read_in({V2f(0.64f, 0.33f), V2f(0.30f, 0.60f), V2f(0.15f, 0.06f), d65});
    EXPECT_EQ(own[0], glm::vec3(0.4f, 0.5f, 0.6f)) << "to the bit";
    EXPECT_THROW(read_in({V2f(0, 0), V2f(0, 0), V2f(0, 0), V2f(0, 0)}), Error);
}

TEST(Exr, ReadsGreyAndTheOneLayerThatThereIs) {
    const test::TemporaryFolder folder;
    write_planes(folder / "grey.exr", box(0, 0, 3, 3), box(0, 0, 3, 3), {{"Y", Imf::HALF, 2.0f}});
    EXPECT_EQ(read_exr(folder / "grey.exr").at(1, 1), glm::vec3(2.0f));
    write_planes(folder / "layer.exr", box(0, 0, 3, 3), box(0, 0, 3, 3),
                 {{"View.Combined.R", Imf::FLOAT, 1.0f},
                  {"View.Combined.G", Imf::FLOAT, 2.0f},
                  {"View.Combined.B", Imf::HALF, 3.0f},
                  {"View.Depth.Z", Imf::FLOAT, 9.0f}});
    EXPECT_EQ(read_exr(folder / "layer.exr").at(2, 3), glm::vec3(1.0f, 2.0f, 3.0f));
    write_planes(folder / "passes.exr", box(0, 0, 3, 3), box(0, 0, 3, 3),
                 {{"View.AO.R", Imf::FLOAT, 7.0f},
                  {"View.AO.G", Imf::FLOAT, 7.0f},
                  {"View.AO.B", Imf::FLOAT, 7.0f},
                  {"View.Combined.R", Imf::FLOAT, 1.0f},
                  {"View.Combined.G", Imf::FLOAT, 2.0f},
                  {"View.Combined.B", Imf::FLOAT, 3.0f}});
    EXPECT_EQ(read_exr(folder / "passes.exr").at(2, 3), glm::vec3(1.0f, 2.0f, 3.0f));
    write_planes(folder / "two.exr", box(0, 0, 3, 3), box(0, 0, 3, 3),
                 {{"a.R", Imf::HALF, 1.0f},
                  {"a.G", Imf::HALF, 1.0f},
                  {"a.B", Imf::HALF, 1.0f},
                  {"b.R", Imf::HALF, 1.0f},
                  {"b.G", Imf::HALF, 1.0f},
                  {"b.B", Imf::HALF, 1.0f}});
    expect_refusal(folder / "two.exr", ExitCode::bad_input, "2 layers of R, G and B ('a.', 'b.', ...)");
    write_planes(folder / "chroma.exr", box(0, 0, 3, 3), box(0, 0, 3, 3),
                 {{"Y", Imf::HALF, 1.0f}, {"RY", Imf::HALF, 1.0f}, {"BY", Imf::HALF, 1.0f}});
    expect_refusal(folder / "chroma.exr", ExitCode::bad_input, "no channel R");
}

TEST(Exr, RefusesAHugeWindowBeforeAllocatingIt) {
    const test::TemporaryFolder folder;
    write_planes(folder / "a.exr", box(0, 0, 999'999'999, 999'999'999), box(0, 0, 1, 1), half_rgb);
    expect_refusal(folder / "a.exr", ExitCode::bad_input, "1000000000x1000000000");
}

TEST(Exr, RefusesEveryTruncation) {
    const test::TemporaryFolder folder;
    write_exr(folder / "a.exr", numbered(17, 33), {{"vkcppm.seed", "1"}});
    const std::string bytes = test::read_bytes(folder / "a.exr");
    ASSERT_GT(bytes.size(), 1000u);
    for (std::size_t size = 0; size < bytes.size(); size += 13) {
        test::write_bytes(folder / "b.exr", bytes.substr(0, size));
        const auto error = test::thrown_by([&] { read_exr(folder / "b.exr"); });
        ASSERT_TRUE(error) << size << " of " << bytes.size() << " bytes were taken for a picture";
        EXPECT_EQ(error->code(), ExitCode::bad_input) << error->what();
    }
}

TEST(Exr, TellsWhereItCannotWrite) {
    const test::TemporaryFolder folder;
    const auto error = test::thrown_by([&] { write_exr(folder / "missing" / "a.exr", numbered(2, 2)); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::cannot_write);
    EXPECT_NE(std::string(error->what()).find("missing/a.exr"), std::string::npos) << error->what();
}

TEST(Exr, ChannelsAreFoundByTheBeginningOfTheirNames) {
    const test::TemporaryFolder folder;
    ExrChannels channels = to_channels(numbered(5, 4));
    for (std::size_t i = 0; i < 20; ++i) {
        channels.values["StdErr"].push_back(float(i));
        channels.values["StdErr.8"].push_back(float(i) / 4.0f);
    }
    write_exr(folder / "a.exr", channels);
    const ExrChannels read = read_exr_channels(folder / "a.exr", "StdErr");
    EXPECT_EQ(read.extent, (Extent{5, 4}));
    ASSERT_EQ(read.values.size(), 2u);
    EXPECT_EQ(read.values.at("StdErr"), channels.values["StdErr"]);
    EXPECT_EQ(read.values.at("StdErr.8"), channels.values["StdErr.8"]);
    EXPECT_TRUE(read_exr_channels(folder / "a.exr", "Z").values.empty());
    // Of the display window, of which the data window covers a part.
    write_planes(folder / "b.exr", Box2i(V2i(0, 0), V2i(3, 2)), Box2i(V2i(2, 1), V2i(6, 1)), {{"Z", Imf::HALF, 2.0f}});
    EXPECT_EQ(read_exr_channels(folder / "b.exr", "Z").values.at("Z"),
              (std::vector<float>{0, 0, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0}));
    const auto missing = test::thrown_by([&] { read_exr_channels(folder / "none.exr", "Z"); });
    ASSERT_TRUE(missing);
    EXPECT_EQ(missing->code(), ExitCode::no_input);
}

}  // namespace
}  // namespace vkcppm
