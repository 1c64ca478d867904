#pragma once
// Runs a program and keeps what it says.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "support/files/temporary_folder.h"

namespace vkcppm::test {

struct ProcessResult {
    int exit_code = -1;  // -1 where a signal ended it
    int signal = 0;
    bool timed_out = false;  // it did not end in time and was killed
    std::string out;
    std::string err;
};

/// A running program. Its outputs go to files, so it never waits for a reader.
class Process {
public:
    /// Starts words[0] in `folder`. Throws std::runtime_error where that fails.
    Process(const std::vector<std::string>& words, const std::filesystem::path& folder);
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process();  // kills it where it still runs

    void send(int signal);

    /// Waits until standard error holds `text`; false where the program ended, or five minutes passed, before.
    bool wait_for_message(std::string_view text);

    /// Waits for the end, five minutes at most.
    ProcessResult wait();

private:
    bool ended();  // reaps it where it has

    TemporaryFolder outputs_;
    pid_t id_ = -1;
    int status_ = 0;
    bool reaped_ = false;
};

/// Starts words[0] in `folder` and waits for its end.
ProcessResult run_process(const std::vector<std::string>& words, const std::filesystem::path& folder);

}  // namespace vkcppm::test
