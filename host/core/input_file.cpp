#include "core/input_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>

#include "core/error.h"

namespace vkcppm {
namespace fs = std::filesystem;

std::optional<std::string> why_unreadable(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) return "no such file";
    if (error) return error.message();
    if (fs::is_directory(status)) return "it is a folder";
    if (!fs::is_regular_file(status)) return "it is not a regular file";
    if (::access(file.c_str(), R_OK) != 0) return std::strerror(errno);
    return std::nullopt;
}

void require_file(const fs::path& file) {
    if (const auto why = why_unreadable(file)) throw Error(ExitCode::no_input, file.string() + ": " + *why);
}

}  // namespace vkcppm
