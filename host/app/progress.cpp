#include "app/progress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <sys/ioctl.h>

#include "app/options.h"

namespace vkcppm {
namespace {

constexpr double terminal_interval = 0.1;  // s
constexpr double plain_interval = 10.0;    // s

/// ", relmse_trimmed about 0.0034": what a render thinks of itself.
std::string estimate_text(const Progress& progress) {
    if (!progress.estimate) return "";
    const ExpectedRelmse& relmse = progress.estimate->relmse_trimmed;
    return fmt::format(", relmse_trimmed about {:.2g}", relmse.error.value);
}

/// ", relmse 0.0123", and after how many iterations where there have been more since.
std::string error_text(const Progress& progress) {
    if (!progress.error) return "";
    const LatestError& error = *progress.error;
    std::string text = fmt::format(", {} {:.3g}", error.metric->name, error.value);
    return error.iterations == progress.iterations_done ? text : text + fmt::format(" after {}", error.iterations);
}

/// As much of it as a row of the terminal holds: of a longer one every update would leave rows behind.
std::string in_a_row(const std::string& text, std::FILE* terminal) {
    winsize size{};
    if (::ioctl(::fileno(terminal), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return text;
    return text.substr(0, size.ws_col - 1u);
}

}  // namespace

std::string duration_text(double seconds) {
    const double whole = std::round(seconds);
    if (whole < 60.0) {
        return fmt::format("{:.0f} s", whole);
    }
    if (whole < 3600.0) {
        return fmt::format("{:.0f} min {:.0f} s", std::floor(whole / 60.0), std::fmod(whole, 60.0));
    }
    const double minutes = std::floor(whole / 60.0);
    return fmt::format("{:.0f} h {:.0f} min", std::floor(minutes / 60.0), std::fmod(minutes, 60.0));
}

std::string progress_text(const Progress& progress, std::optional<double> time_limit) {
    const bool counted = progress.iterations_total < unbounded_iterations;
    const double of_iterations = double(progress.iterations_done) / double(progress.iterations_total);
    const double of_time = time_limit ? progress.wall_seconds / *time_limit : 0.0;
    const double done = std::min(std::max(of_iterations, of_time), 1.0);
    // The bound on iterations says nothing where the time decides, or an error.
    std::string text = of_time > of_iterations || !counted
                           ? fmt::format("{} iterations", progress.iterations_done)
                           : fmt::format("{}/{} iterations", progress.iterations_done, progress.iterations_total);
    if (counted || time_limit) {
        text += fmt::format(" ({:.0f} %)", std::floor(100.0 * done));
        if (done > 0.0) {
            text += fmt::format(", {} left", duration_text(progress.wall_seconds * (1.0 - done) / done));
        }
    }
    return text + error_text(progress) + estimate_text(progress);
}

ProgressLine::ProgressLine(std::FILE* stream, bool terminal, std::optional<double> time_limit)
    : stream_(stream), terminal_(terminal), time_limit_(time_limit) {}

ProgressLine::~ProgressLine() {
    if (open_) std::fputs("\n", stream_);
}

void ProgressLine::update(const Progress& progress) {
    update(progress.wall_seconds, progress_text(progress, time_limit_));
}

void ProgressLine::update(double wall_seconds, const std::string& text) {
    const double interval = terminal_ ? terminal_interval : plain_interval;
    if (last_ && wall_seconds - *last_ < interval) return;
    last_ = wall_seconds;
    write(terminal_ ? in_a_row(text, stream_) : text);
    open_ = terminal_;
}

void ProgressLine::finish(const Progress& progress) {
    finish_with(fmt::format("{} iterations in {:.1f} s{}{}", progress.iterations_done, progress.wall_seconds,
                            error_text(progress), estimate_text(progress)));
}

void ProgressLine::finish_with(const std::string& text) {
    write(text);
    open_ = terminal_;
}

void ProgressLine::write(const std::string& text) {
    // Return to the first column and clear what the shorter new text would leave of the old.
    const std::string line = terminal_ ? "\r" + text + "\x1b[K" : text + "\n";
    std::fputs(line.c_str(), stream_);
    std::fflush(stream_);
}

}  // namespace vkcppm
