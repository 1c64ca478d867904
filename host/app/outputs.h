#pragma once
// Where a command will write.

#include <filesystem>
#include <optional>
#include <vector>

namespace vkcppm {

struct Output {
    const char* option;                         // that names it
    std::optional<std::filesystem::path> file;  // absent: not asked for
    const char* ending;                         // of what it writes, such as ".exr"; empty: a format of our own
};

/// Whether two names are of one file, be it there or not, however they are spelled or linked.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Makes a folder for outputs, and those above it, where it is not there. Throws Error(cannot_write).
void make_folder(const std::filesystem::path& folder);

/// Refuses outputs that would overwrite an input or one another, however they are spelled or linked, or whose name ends
/// like another format (usage), or that cannot be written (cannot_write), by throwing Error. Called before any time is
/// spent, and again when a scene is loaded, with all that it has named. Inputs that are absent are skipped. prints: the
/// command itself writes to standard output, which is then no place for a file.
void check_outputs(const std::vector<std::optional<std::filesystem::path>>& inputs, const std::vector<Output>& outputs,
                   bool prints);

}  // namespace vkcppm
