#include "support/files/browser.h"

#include <cstdlib>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "support/files/process.h"

namespace vkcppm::test {

std::optional<std::string> chromium() {
    std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
            if (std::filesystem::exists(std::filesystem::path(folder) / name))
                return (std::filesystem::path(folder) / name).string();
        }
    }
    return std::nullopt;
}

std::vector<std::string> all(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.push_back((*it)[1]);
    return found;
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t at = text.find(begin);
    if (at == std::string::npos) {
        ADD_FAILURE() << "'" << begin << "' is not on the page";
        return "";
    }
    return text.substr(at + begin.size(), text.find(end, at + begin.size()) - at - begin.size());
}

std::string drawn_page(const std::string& browser, const std::filesystem::path& folder, const std::string& hash) {
    const ProcessResult result =
        run_process({browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1280,900", "--user-data-dir=" + (folder / "profile").string(),
                     "--virtual-time-budget=5000", "--dump-dom", "file://" + (folder / "index.html").string() + hash},
                    folder);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t data = result.out.find("<script type=\"application/json\"");
    EXPECT_NE(data, std::string::npos) << result.err;
    const std::string page = result.out.substr(0, data);
    const std::string alert = between(page, "<div id=\"alert\"", "</div>");
    EXPECT_NE(alert.find("hidden"), std::string::npos) << alert;
    return page;
}

}  // namespace vkcppm::test
