#pragma once
// How far the render is, on standard error.

#include <cstdio>
#include <optional>
#include <string>

#include "render/render.h"

namespace vkcppm {

/// "12 s", "3 min 20 s", "2 h 5 min". seconds >= 0.
std::string duration_text(double seconds);

/// Iterations done, percentage, an estimate of the time left and the latest error. time_limit: seconds of
/// Settings::seconds; where it is set, the render ends by its iterations or by its time, whichever comes first.
std::string progress_text(const Progress& progress, std::optional<double> time_limit);

/// On a terminal one line that is rewritten ten times a second at most; elsewhere a line every ten seconds at most.
class ProgressLine {
public:
    ProgressLine(std::FILE* stream, bool terminal, std::optional<double> time_limit);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();  // ends a line that was left open on a terminal

    /// The first call writes, a later one only where the interval has passed since the last line.
    void update(const Progress& progress);

    /// The same for other commands than a render: `text` after so many seconds.
    void update(double wall_seconds, const std::string& text);

    /// The last line: what was done in which time, and how near it came.
    void finish(const Progress& progress);
    void finish_with(const std::string& text);

private:
    void write(const std::string& text);

    std::FILE* stream_;
    bool terminal_;
    std::optional<double> time_limit_;
    std::optional<double> last_;  // Progress::wall_seconds of the last line
    bool open_ = false;
};

}  // namespace vkcppm
