#pragma once
// The one exception of the program: what went wrong in one line, and the exit code it becomes.

#include <stdexcept>
#include <string>

namespace vkcppm {

/// Exit codes of the program (sysexits.h numbers where one fits).
enum class ExitCode : int {
    ok = 0,
    differs = 1,
    usage = 2,
    bad_input = 65,
    no_input = 66,
    no_device = 69,
    internal = 70,
    out_of_device_memory = 71,
    cannot_write = 73,
    device_lost = 75,
    interrupted = 130,
};

/// Bad input or a missing resource. `what()` is one line that names the object, the value, the limit and the file.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

}  // namespace vkcppm
