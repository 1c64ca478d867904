#pragma once
// Where a command will write.

#include <filesystem>
#include <optional>
#include <vector>

namespace vkcppm {

struct Output {
    const char* option;                         // that names it
    std::optional<std::filesystem::path> file;  // absent: not asked for
};

/// Refuses, before any time is spent, outputs that would overwrite an input or one another (usage) or cannot be written
/// (cannot_write), by throwing Error. Inputs that are absent are skipped.
void check_outputs(const std::vector<std::optional<std::filesystem::path>>& inputs, const std::vector<Output>& outputs);

}  // namespace vkcppm
