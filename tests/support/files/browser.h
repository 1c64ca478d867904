#pragma once
// Pages in a browser: Chromium without a window, where there is one.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkcppm::test {

/// The browser among the folders of PATH.
std::optional<std::string> chromium();

/// `folder`/index.html after its script ran, with `hash` behind its address, such as "#view=1"; without the data that
/// it was drawn from. Fails the running test where the browser does or the page says that it failed.
std::string drawn_page(const std::string& browser, const std::filesystem::path& folder, const std::string& hash);

/// Every part of `text` that the first group of `pattern` takes.
std::vector<std::string> all(const std::string& text, const std::string& pattern);

/// What stands between `begin` and the next `end`. Fails the running test where `begin` is not there.
std::string between(const std::string& text, const std::string& begin, const std::string& end);

}  // namespace vkcppm::test
