#include "app/console.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <unistd.h>

#include "core/error.h"

namespace vkcppm {

void print_result(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
        throw Error(ExitCode::cannot_write, std::string("cannot write to standard output: ") + std::strerror(errno));
    }
}

void print_message(std::string_view message) {
    std::string line(message);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    line += '\n';
    // On a terminal it takes the row of a progress line, which begins anew below.
    if (::isatty(STDERR_FILENO) == 1) line.insert(0, "\r\x1b[K");
    std::fputs(line.c_str(), stderr);
}

void print_warnings(std::span<const std::string> warnings) {
    for (const std::string& warning : warnings) print_message("warning: " + warning);
}

}  // namespace vkcppm
