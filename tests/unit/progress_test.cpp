#include "app/progress.h"

#include <cstdio>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/console.h"

namespace vkcppm {
namespace {

/// What a ProgressLine writes while `use` works with it.
template <typename Use> std::string written(bool terminal, std::optional<double> time_limit, Use&& use) {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* stream = ::open_memstream(&text, &size);
    {
        ProgressLine line(stream, terminal, time_limit);
        use(line);
    }
    std::fclose(stream);
    const std::string result(text, size);
    std::free(text);
    return result;
}

TEST(Progress, DurationsAreRoundedToWhatMatters) {
    EXPECT_EQ(duration_text(0.2), "0 s");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(59.6), "1 min 0 s");
    EXPECT_EQ(duration_text(200.0), "3 min 20 s");
    EXPECT_EQ(duration_text(3599.7), "1 h 0 min");
    EXPECT_EQ(duration_text(7500.0), "2 h 5 min");
}

TEST(Progress, EstimatesTheTimeLeftFromTheIterations) {
    EXPECT_EQ(progress_text({16, 64, 30.0}, std::nullopt), "16/64 iterations (25 %), 1 min 30 s left");
    EXPECT_EQ(progress_text({64, 64, 30.0}, std::nullopt), "64/64 iterations (100 %), 0 s left");
    EXPECT_EQ(progress_text({0, 64, 0.0}, std::nullopt), "0/64 iterations (0 %)");
}

TEST(Progress, EndsByTimeOrByIterationsWhicheverIsSooner) {
    EXPECT_EQ(progress_text({16, 1073741823, 30.0}, 90.0), "16 iterations (33 %), 1 min 0 s left");
    EXPECT_EQ(progress_text({16, 64, 3.0}, 90.0), "16/64 iterations (25 %), 9 s left");
    EXPECT_EQ(progress_text({16, 1073741823, 95.0}, 90.0), "16 iterations (100 %), 0 s left");
}

TEST(Progress, TellsWhatARenderThinksOfItsOwnErrorAndNoEndWhereThatDecides) {
    ErrorEstimate estimate;
    estimate.relmse_trimmed.error = {0.00234, 0.0001};
    EXPECT_EQ(progress_text({16, 1073741823, 30.0}, std::nullopt), "16 iterations");
    EXPECT_EQ(progress_text({40, 1073741823, 30.0, {}, estimate}, std::nullopt),
              "40 iterations, relmse_trimmed about 0.0023");
    EXPECT_EQ(progress_text({32, 64, 30.0, {}, estimate}, std::nullopt),
              "32/64 iterations (50 %), 30 s left, relmse_trimmed about 0.0023");
}

TEST(Progress, TellsTheLatestErrorAndHowOldItIs) {
    const LatestError error{&find_metric("", "relmse"), 0.012345, 16};
    EXPECT_EQ(progress_text({16, 64, 30.0, error}, std::nullopt),
              "16/64 iterations (25 %), 1 min 30 s left, relmse 0.0123");
    EXPECT_EQ(progress_text({32, 64, 30.0, error}, std::nullopt),
              "32/64 iterations (50 %), 30 s left, relmse 0.0123 after 16");
    EXPECT_EQ(written(false, std::nullopt,
                      [&](ProgressLine& line) {
                          line.finish({16, 64, 4.0, error});
                      }),
              "16 iterations in 4.0 s, relmse 0.0123\n");
}

TEST(Progress, IsALineEveryTenSecondsWhereNobodyWatches) {
    const std::string text = written(false, std::nullopt, [](ProgressLine& line) {
        for (std::uint64_t i = 1; i <= 25; ++i) {
            line.update({i, 25, double(i)});
        }
        line.finish({25, 25, 25.0});
    });
    EXPECT_EQ(text,
              "1/25 iterations (4 %), 24 s left\n"
              "11/25 iterations (44 %), 14 s left\n"
              "21/25 iterations (84 %), 4 s left\n"
              "25 iterations in 25.0 s\n");
}

TEST(Progress, RewritesItsLineOnATerminalAndEndsIt) {
    const std::string text = written(true, std::nullopt, [](ProgressLine& line) {
        line.update({1, 4, 1.0});
        line.update({2, 4, 1.05});  // too soon
        line.update({3, 4, 3.0});
        line.finish({4, 4, 4.0});
    });
    EXPECT_EQ(text,
              "\r1/4 iterations (25 %), 3 s left\x1b[K"
              "\r3/4 iterations (75 %), 1 s left\x1b[K"
              "\r4 iterations in 4.0 s\x1b[K\n");
}

/// What `use` writes to standard error where that is a terminal of so many columns.
template <typename Use> std::string on_a_terminal(unsigned short columns, Use&& use) {
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return "there is no terminal";
    const int end = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
    const winsize size{24, columns, 0, 0};
    EXPECT_EQ(::ioctl(end, TIOCSWINSZ, &size), 0);
    const int standard_error = ::dup(STDERR_FILENO);
    ::dup2(end, STDERR_FILENO);
    use();
    ::dup2(standard_error, STDERR_FILENO);
    std::string text(1000, '\0');
    text.resize(std::size_t(::read(terminal, text.data(), text.size())));
    for (const int descriptor : {standard_error, end, terminal}) ::close(descriptor);
    return text;
}

TEST(Progress, KeepsToARowOfATerminalWhichAMessageTakes) {
    const std::string text = on_a_terminal(20, [] {
        ProgressLine line(stderr, true, std::nullopt);
        line.update({1, 4, 1.0});
        print_message("warning: the viewer is gone");
        line.finish({4, 4, 4.0});
    });
    EXPECT_EQ(text,
              "\r1/4 iterations (25 \x1b[K"
              "\r\x1b[Kwarning: the viewer is gone\r\n"
              "\r4 iterations in 4.0 s\x1b[K\r\n");
}

TEST(Progress, EndsAnOpenLineWhereTheRenderThrows) {
    EXPECT_EQ(written(true, std::nullopt,
                      [](ProgressLine& line) {
                          line.update({1, 4, 1.0});
                      }),
              "\r1/4 iterations (25 %), 3 s left\x1b[K\n");
    EXPECT_EQ(written(true, std::nullopt, [](ProgressLine&) {}), "");
}

}  // namespace
}  // namespace vkcppm
