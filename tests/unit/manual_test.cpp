// The manual page and the completions of shells, which the build makes of what --help says.

#include "app/manual.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/options.h"
#include "support/files/files.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"

namespace vkcppm {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(Manual, NamesEveryCommandAndOption) {
    const std::string page = manual_page(), bash = bash_completion(), zsh = zsh_completion(), fish = fish_completion();
    const std::vector<CommandText> commands = command_texts();
    ASSERT_EQ(commands.size(), 12u);
    for (const CommandText& command : commands) {
        for (const std::string* text : {&page, &bash, &zsh, &fish}) EXPECT_TRUE(contains(*text, command.name));
        for (const OptionText& option : command.options) {
            if (option.positional) continue;
            for (const std::string& name : option.names) {
                std::string roff = "\\fB";
                for (const char c : name) roff += c == '-' ? std::string("\\-") : std::string(1, c);
                EXPECT_TRUE(contains(page, roff + "\\fR")) << name;
                EXPECT_TRUE(contains(bash, name)) << name;
                EXPECT_TRUE(contains(zsh, "'" + name)) << name;
                const bool is_long = name.starts_with("--");
                EXPECT_TRUE(contains(fish, (is_long ? " -l " : " -s ") + name.substr(is_long ? 2 : 1))) << name;
            }
        }
    }
}

TEST(Manual, NoLineOfHelpIsARequestOfRoff) {
    const std::string page = manual_page();
    for (std::size_t at = 0; (at = page.find("\n.", at)) != page.npos; ++at) {
        const std::string request = page.substr(at + 2, 2);
        EXPECT_TRUE(request == "TH" || request == "SH" || request == "TP" || request == "br" || request == "nf" ||
                    request == "fi")
            << page.substr(at, 40);
    }
    EXPECT_EQ(page.find("\n'"), page.npos);
}

/// What bash offers where the cursor is behind the last of the words.
std::string completed(const std::vector<std::string>& words) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "vkcppm.bash", bash_completion());
    std::string script = ". ./vkcppm.bash; COMP_WORDS=(";
    for (const std::string& word : words) script += "'" + word + "' ";
    script += "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; _vkcppm; echo ${COMPREPLY[@]}";
    const auto result = test::run_process({"/bin/bash", "-c", script}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
}

TEST(Manual, BashCompletesCommandsOptionsAndValues) {
    EXPECT_EQ(completed({"vkcppm", "re"}), "render-shard reference\n");
    EXPECT_EQ(completed({"vkcppm", "s.gltf", "--ph"}), "--photons\n");
    EXPECT_EQ(completed({"vkcppm", "s.gltf", "--estimator", "sppm-"}), "sppm-kz\n");
    EXPECT_EQ(completed({"vkcppm", "race", "s.gltf", "--thin-glass", ""}), "thin solid\n");
    EXPECT_EQ(completed({"vkcppm", "race", "s.gltf", "--estimators"}), "--estimators\n");
    EXPECT_EQ(completed({"vkcppm", "compare", "--"}), "--help --json\n");
    EXPECT_EQ(completed({"vkcppm", "s.gltf", "--png", "a"}), "\n") << "names of files are bash's own";
}

}  // namespace
}  // namespace vkcppm
