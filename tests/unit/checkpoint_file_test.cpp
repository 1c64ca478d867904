// Checkpoints on disk: what comes back, and every way in which a file can be none.

#include <cstring>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "app/checkpoint_file.h"
#include "core/fnv1a.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

constexpr std::size_t pixels = 4;

Identity identity() { return {{"version", "0.1.0"}, {"estimator", "cppm"}}; }

Checkpoint checkpoint() {
    Checkpoint checkpoint;
    Report& report = checkpoint.report;
    report.device = "a device";
    report.driver = "a driver";
    report.iterations = 17;
    report.emitted_paths = 1u << 20;
    report.stored_photons = 5'000'000'000;
    report.rays = 6;
    report.invalid = 3;
    report.wall_seconds = 1.25;
    report.cpu_seconds = 2.5;
    report.passes = {{"eye", 17, 0.1}, {"photon", 18, 0.2}};
    CurvePoint point{16, 0.75, {}};
    point.error.relmse = {0.5, 0.25};
    point.error.psnr = std::numeric_limits<double>::infinity();
    checkpoint.curve = {point, point};
    for (int i = 0; i < 300; ++i) checkpoint.state.push_back(std::byte(i));
    return checkpoint;
}

class CheckpointFile : public testing::Test {
protected:
    void SetUp() override {
        write_checkpoint(file_, identity(), checkpoint());
        good_ = test::read_bytes(file_);
    }
    Checkpoint read() const { return read_checkpoint(file_, identity(), pixels); }

    /// The error of a file of these bytes, one line that names the file.
    std::string refused(const std::string& bytes, ExitCode code = ExitCode::bad_input, std::size_t of_pixels = pixels) {
        test::write_bytes(file_, bytes);
        const auto error = test::thrown_by([&] { read_checkpoint(file_, identity(), of_pixels); });
        if (!error) return "it was taken";
        EXPECT_EQ(error->code(), code) << error->what();
        const std::string line = error->what();
        EXPECT_NE(line.find(file_.string()), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        return line;
    }
    /// `bytes` with a checksum that fits.
    static std::string signed_again(std::string bytes) {
        const std::string_view body(bytes.data(), bytes.size() - 8);
        const std::uint64_t hash = fnv1a_of(std::span<const char>(body));
        std::memcpy(bytes.data() + body.size(), &hash, sizeof(hash));
        return bytes;
    }
    static std::string with_word(std::string bytes, std::size_t at, std::uint64_t word) {
        std::memcpy(bytes.data() + at, &word, sizeof(word));
        return signed_again(bytes);
    }

    test::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.ckpt";
    std::string good_;
};

TEST_F(CheckpointFile, GivesBackWhatWasWritten) {
    const Checkpoint expected = checkpoint(), got = read();
    const Report &a = expected.report, &b = got.report;
    EXPECT_EQ(b.device, a.device);
    EXPECT_EQ(b.driver, a.driver);
    EXPECT_EQ(b.iterations, a.iterations);
    EXPECT_EQ(b.emitted_paths, a.emitted_paths);
    EXPECT_EQ(b.stored_photons, a.stored_photons);
    EXPECT_EQ(b.rays, a.rays);
    EXPECT_EQ(b.invalid, a.invalid);
    EXPECT_EQ(b.wall_seconds, a.wall_seconds);
    EXPECT_EQ(b.cpu_seconds, a.cpu_seconds);
    ASSERT_EQ(b.passes.size(), 2u);
    EXPECT_EQ(b.passes[1].name, "photon");
    EXPECT_EQ(b.passes[1].calls, 18u);
    EXPECT_EQ(b.passes[1].device_seconds, 0.2);
    ASSERT_EQ(got.curve.size(), 2u);
    EXPECT_EQ(got.curve[1].iterations, 16u);
    EXPECT_EQ(got.curve[1].seconds, 0.75);
    EXPECT_EQ(got.curve[1].error.relmse.trimmed, 0.25);
    EXPECT_EQ(got.curve[1].error.psnr, std::numeric_limits<double>::infinity());
    EXPECT_EQ(got.state, expected.state);
    EXPECT_EQ(test::names_in(folder_.path()), (std::set<std::string>{"a.ckpt"}));
}

TEST_F(CheckpointFile, EveryTruncationIsRefused) {
    for (std::size_t size = 0; size < good_.size(); ++size) {
        const std::string line = refused(good_.substr(0, size));
        ASSERT_TRUE(line.find("is no checkpoint") != std::string::npos || line.find("is damaged") != std::string::npos)
            << size << " of " << good_.size() << " bytes: " << line;
    }
    EXPECT_NE(refused(good_ + "x").find("is damaged"), std::string::npos);
}

TEST_F(CheckpointFile, EveryFlippedBitIsRefused) {
    for (std::size_t bit = 0; bit < 8 * good_.size(); bit += 3) {
        std::string bad = good_;
        bad[bit / 8] ^= char(1 << bit % 8);
        ASSERT_NE(refused(bad), "it was taken") << "bit " << bit;
    }
}

// Lengths that lie, under a checksum that fits: none may take memory.
TEST_F(CheckpointFile, EveryWordThatCouldBeALengthMayLie) {
    const std::size_t header_ends = good_.size() - 8 - checkpoint().state.size();
    for (std::size_t at = 8; at + 8 <= header_ends; ++at) {
        for (const std::uint64_t word : {std::uint64_t(1) << 40, ~std::uint64_t(0), std::uint64_t(1) << 63}) {
            test::write_bytes(file_, with_word(good_, at, word));
            // Some of them are no lengths but numbers, which may be anything, or names, which differ.
            const auto error = test::thrown_by([&] { read(); });
            if (error) {
                EXPECT_NE(std::string(error->what()).find("a.ckpt"), std::string::npos) << error->what();
            }
        }
    }
    EXPECT_NE(refused(with_word(good_, 16, std::uint64_t(1) << 62)).find("is damaged"), std::string::npos);
    EXPECT_NE(refused(with_word(good_, 24, std::uint64_t(1) << 62)).find("is damaged"), std::string::npos);
    EXPECT_NE(refused(with_word(good_, 32, 1000)).find("1000 entries"), std::string::npos) << "number of names";
}

TEST_F(CheckpointFile, AForeignFileFormatAndStateAreToldApart) {
    EXPECT_NE(refused("").find("is no checkpoint"), std::string::npos);
    EXPECT_NE(refused(std::string(1000, 'x')).find("is no checkpoint"), std::string::npos);
    EXPECT_NE(refused(with_word(good_, 8, 5)).find("of format 5, this program reads format 4"), std::string::npos);
    std::string large = good_.substr(0, good_.size() - 8) + std::string(20'000, '\0') + std::string(8, '\0');
    EXPECT_NE(refused(with_word(large, 24, 20'300)).find("20300 bytes, the limit of its picture is"),
              std::string::npos);
    const auto missing = test::thrown_by([&] { read_checkpoint(folder_ / "b", identity(), pixels); });
    ASSERT_TRUE(missing);
    EXPECT_EQ(missing->code(), ExitCode::no_input);
    const auto folder = test::thrown_by([&] { read_checkpoint(folder_.path(), identity(), pixels); });
    ASSERT_TRUE(folder);
    EXPECT_EQ(folder->code(), ExitCode::no_input);
}

TEST_F(CheckpointFile, OfAnotherRenderTellsEveryDifference) {
    const Identity asked = {{"version", "0.2.0"}, {"estimator", "cppm"}, {"seed", "7"}};
    const auto error = test::thrown_by([&] { read_checkpoint(file_, asked, pixels); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
    EXPECT_EQ(std::string(error->what()), file_.string() +
                                              " is of another render: version: 0.1.0 in the checkpoint, 0.2.0 "
                                              "asked; seed: absent in the checkpoint, 7 asked");
    const auto fewer = test::thrown_by([&] { read_checkpoint(file_, {{"version", "0.1.0"}}, pixels); });
    ASSERT_TRUE(fewer);
    EXPECT_NE(std::string(fewer->what()).find("estimator: cppm in the checkpoint, absent asked"), std::string::npos)
        << fewer->what();
}

}  // namespace
}  // namespace vkcppm
