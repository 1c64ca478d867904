#pragma once
// What --help says, for readers of manual pages and for the shells. Made by the build, not by the program.

#include <filesystem>
#include <string>

namespace vkcppm {

/// The manual page vkcppm(1), in roff.
std::string manual_page();

// Scripts that complete command lines.
std::string bash_completion();
std::string zsh_completion();
std::string fish_completion();

/// Writes them into a folder that is there, as vkcppm.1, vkcppm.bash, _vkcppm and vkcppm.fish.
void write_manual(const std::filesystem::path& folder);

}  // namespace vkcppm
