#include "io/environment.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/fnv1a.h"
#include "io/exr.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

std::uint64_t hash_of(const std::string& bytes, std::uint64_t start) {
    return fnv1a({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, start);
}

const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x80\x80\x80\x82";

TEST(Environment, ReadsExrAndRadianceByTheirFirstBytes) {
    const test::TemporaryFolder folder;
    const Image sky{{2, 2}, {{1, 2, 3}, {0, 0, 0}, {65504, 1e30, 1e-30}, {4, 5, 6}}};
    write_exr(folder / "sky.picture", sky);
    test::write_bytes(folder / "field.picture", hdr);
    std::uint64_t hash = 17;
    std::vector<std::string> warnings;
    EXPECT_EQ(read_environment(folder / "sky.picture", hash, warnings), sky);
    EXPECT_EQ(hash, hash_of(test::read_bytes(folder / "sky.picture"), 17));
    hash = 18;
    EXPECT_EQ(read_environment(folder / "field.picture", hash, warnings), (Image{{2, 1}, {{1, 0.5, 0.25}, {2, 2, 2}}}));
    EXPECT_EQ(hash, hash_of(hdr, 18));
    EXPECT_EQ(warnings, std::vector<std::string>());
}

void expect_refused(const std::filesystem::path& file, ExitCode code, const std::vector<std::string>& told) {
    std::uint64_t hash = 17;
    std::vector<std::string> warnings;
    const auto error = test::thrown_by([&] { read_environment(file, hash, warnings); });
    ASSERT_TRUE(error) << file;
    const std::string message = error->what();
    EXPECT_EQ(error->code(), code) << message;
    EXPECT_NE(message.find(file.filename().string()), message.npos) << message;
    for (const std::string& part : told) {
        EXPECT_NE(message.find(part), message.npos) << "'" << part << "' is not in: " << message;
    }
    EXPECT_EQ(hash, 17u);
}

TEST(Environment, RefusesPixelsThatAreNoRadiance) {
    using Limits = std::numeric_limits<float>;
    const test::TemporaryFolder folder;
    for (const float bad : {-Limits::infinity(), Limits::quiet_NaN()}) {
        for (int channel = 0; channel < 3; ++channel) {
            Image sky{{3, 2}, std::vector<glm::vec3>(6, glm::vec3(Limits::max()))};
            sky.rgb[5][channel] = bad;
            write_exr(folder / "sky.exr", sky);
            expect_refused(folder / "sky.exr", ExitCode::bad_input, {"pixel (2, 1)", "must be finite"});
        }
    }
}

TEST(Environment, TakesWhatIsNegativeForBlack) {
    const test::TemporaryFolder folder;
    Image sky{{3, 2}, std::vector<glm::vec3>(6, glm::vec3(2.0f))};
    sky.rgb[1] = {1, -1e-6f, 3};
    sky.rgb[5] = {-4, -0.0f, -1e-30f};
    write_exr(folder / "sky.exr", sky);
    std::uint64_t hash = 0;
    std::vector<std::string> warnings;
    const Image read = read_environment(folder / "sky.exr", hash, warnings);
    sky.rgb[1].g = 0;
    sky.rgb[5] = {0, 0, 0};
    EXPECT_EQ(read, sky);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], (folder / "sky.exr").string() +
                               ": pixel (1, 0) is (1, -1e-06, 3) (and 1 more): negative radiance is taken as 0");
}

TEST(Environment, TakesWhatIsInfiniteForTheBrightestOfHalfFloats) {
    const test::TemporaryFolder folder;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Image sky{{3, 2}, std::vector<glm::vec3>(6, glm::vec3(2.0f))};
    sky.rgb[2] = {infinity, 70000.0f, 3};
    sky.rgb[4] = {infinity, infinity, infinity};
    write_exr(folder / "sky.exr", sky);
    std::uint64_t hash = 0;
    std::vector<std::string> warnings;
    const Image read = read_environment(folder / "sky.exr", hash, warnings);
    sky.rgb[2].r = 65504.0f;
    sky.rgb[4] = glm::vec3(65504.0f);
    EXPECT_EQ(read, sky);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], (folder / "sky.exr").string() +
                               ": pixel (2, 0) is (inf, 70000, 3) (and 1 more): infinite "
                               "radiance is taken as 65504, the brightest of half floats");
}

TEST(Environment, TurnsAboutTheVerticalWithoutLosingLight) {
    // The middle of four columns is +x, the next +z, then -x: seen from above +x goes to -z, one column back.
    const Image sky{{4, 1}, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}};
    EXPECT_EQ(turned(sky, 0.0), sky);
    EXPECT_EQ(turned(sky, 90.0), (Image{{4, 1}, {{2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {1, 0, 0}}}));
    EXPECT_EQ(turned(sky, -270.0), turned(sky, 90.0));
    EXPECT_EQ(turned(sky, 720.0), sky);
    EXPECT_EQ(turned(sky, 45.0), (Image{{4, 1}, {{1.5, 0, 0}, {2.5, 0, 0}, {3.5, 0, 0}, {2.5, 0, 0}}}));
}

TEST(Environment, RefusesWhatItCannotTake) {
    const test::TemporaryFolder folder;
    expect_refused(folder / "missing.exr", ExitCode::no_input, {"no such file"});
    expect_refused(folder.path(), ExitCode::no_input, {});
    test::write_bytes(folder / "empty.hdr", "");
    expect_refused(folder / "empty.hdr", ExitCode::bad_input, {"neither"});
    test::write_bytes(folder / "sky.png", "\x89PNG\r\n");
    expect_refused(folder / "sky.png", ExitCode::bad_input, {"neither an OpenEXR nor a Radiance picture"});
    test::write_bytes(folder / "cut.hdr", hdr.substr(0, hdr.size() - 1));
    expect_refused(folder / "cut.hdr", ExitCode::bad_input, {"cut short"});
    write_exr(folder / "cut.exr", Image{{2, 2}, std::vector<glm::vec3>(4, glm::vec3(1.0f))});
    const std::string bytes = test::read_bytes(folder / "cut.exr");
    test::write_bytes(folder / "cut.exr", bytes.substr(0, bytes.size() - 8));
    expect_refused(folder / "cut.exr", ExitCode::bad_input, {});
}

TEST(Environment, HasALimitOfPixels) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "large.hdr", "#?RADIANCE\n\n-Y 4096 +X 8192\n");
    expect_refused(folder / "large.hdr", ExitCode::bad_input, {"8192x4096", "8388608", "scale it down"});
    write_exr(folder / "large.exr", Image{{4097, 2048}, std::vector<glm::vec3>(4097 * 2048, glm::vec3(1.0f))});
    expect_refused(folder / "large.exr", ExitCode::bad_input, {"4097x2048", "the limit is 8388608 in all"});
    test::write_bytes(folder / "largest.hdr", "#?RADIANCE\n\n-Y 2048 +X 4096\n");
    expect_refused(folder / "largest.hdr", ExitCode::bad_input, {"row 0 is cut short"});
}

}  // namespace
}  // namespace vkcppm
