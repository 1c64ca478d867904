#pragma once
// What the program says: results on standard output, everything else on standard error.

#include <span>
#include <string>
#include <string_view>

namespace vkcppm {

/// Writes `text` to standard output and flushes it. Throws Error(cannot_write) where that fails.
void print_result(std::string_view text);

/// Writes `message` as one line to standard error, control characters replaced by spaces: names in it may come from
/// a hostile file. A standard error that takes nothing is ignored, since nobody is left to tell.
void print_message(std::string_view message);

/// Writes each as a message that begins with "warning: ".
void print_warnings(std::span<const std::string> warnings);

}  // namespace vkcppm
