#pragma once
// The program behind main().

namespace vkcppm {

/// Does what the command line asks; returns the exit code, after one line on standard error where it is not 0.
int run(int argc, const char* const* argv);

}  // namespace vkcppm
