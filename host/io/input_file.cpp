#include "io/input_file.h"

#include "core/error.h"

namespace vkcppm {
namespace fs = std::filesystem;

void require_file(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_regular_file(status)) return;
    const char* why = fs::is_directory(status) ? "it is a folder" : "not a regular file";
    throw Error(ExitCode::no_input, file.string() + ": " + (fs::exists(status) ? why : "no such file"));
}

}  // namespace vkcppm
